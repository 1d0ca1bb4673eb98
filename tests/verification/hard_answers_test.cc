// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Scenes whose answers were once wrong, with bounds that said otherwise: steep friction, meshes of the user's own,
// jumps. Events are in events_test.cc, soft bodies in soft_bodies_test.cc.
#include "../support/answers.h"
#include "../support/expect_within.h"
#include "random_scenes.h"

#include <crawler/accuracy/error_estimate.h>
#include <crawler/run/result_table.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

using namespace crawler;
using test::answer_to;
using test::expect_within;

namespace
{
  /// An observer whose being there is all that counts.
  class Blind : public Observer
  {
  public:
    void
    observe(const Snapshot &) override
    {
    }
  };
} // namespace

/// a > 0, three cells: the body does not invert.
TEST(HardAnswers, ACoarseMeshDoesNotInvertABody)
{
  const auto answer = [](const unsigned int n_cells, const double chi, const double end_time) {
    auto settings = test::wave(3.38, chi, -1., end_time, 0.0134);
    settings.insert(settings.end(),
                    {{"Discretization/Number of cells", std::to_string(n_cells)},
                     {"Discretization/Degree", "3"},
                     {"Time/Integrator", "radau 9"}});
    return answer_to(settings);
  };
  const SimulationResult coarse = answer(3, 0.302, 0.346);
  EXPECT_EQ(coarse.time.reason, "under_resolved") << coarse.time.message;
  EXPECT_FALSE(coarse.inversion);
  EXPECT_EQ(answer(24, 0.302, 0.346).time.status, Status::finished);
  // One that does is believed.
  EXPECT_EQ(answer_to({{"Body/Anchoring exponent", "0"},
                       {"Active stress/Optimal wave/Perturbation parameter", "0.6"},
                       {"Active stress/Optimal wave/Choose wave by", "wave speed"},
                       {"Active stress/Optimal wave/Wave speed", "-1"},
                       {"Discretization/Number of cells", "12"},
                       {"Discretization/Degree", "6"}})
              .time.status,
            Status::inverted);
}

/// On coarse meshes of steep friction the stretch jumps between cells, and is wrong at the ends of the body, alike on
/// all of them: in the answer and where observers look at the run, and the efficiencies follow from it. True ones on 26
/// cells and more at 1e-7.
TEST(HardAnswers, ExtremesOfSteepFriction)
{
  struct
  {
    const char *p, *k, *chi, *c, *end_time;
    double smallest, efficiency;
  } const scenes[] = {{"5.6348", "0.06209", "0.3808", "1.3", "1.5945", 0.664438, 0.282267},
                      {"6.4216", "0.04749", "0.3974", "-1.0589", "1.0264", 0.624705, 0.146382},
                      {"3.2155", "0.05816", "0.4075", "-0.7661", "0.9133", 0.370797, 0.358654}};
  for (const auto &scene : scenes)
  {
    const test::Settings settings  = {{"Body/Anchoring exponent", scene.p},
                                      {"Body/Elastic modulus", scene.k},
                                      {"Active stress/Optimal wave/Perturbation parameter", scene.chi},
                                      {"Active stress/Optimal wave/Choose wave by", "wave speed"},
                                      {"Active stress/Optimal wave/Wave speed", scene.c},
                                      {"Time/End time", scene.end_time},
                                      {"Accuracy", "1e-2"}};
    const Computed answer          = test::computed(settings);
    const SimulationResult &result = answer.result;
    EXPECT_NEAR(result.min_stretch.value, scene.smallest, error_bound(result, "min_stretch.value").value()) << scene.p;
    EXPECT_NEAR(result.gait_efficiency.value(), scene.efficiency, error_bound(result, "gait.efficiency").value())
      << scene.p;
    const Parameters parameters = test::parameters_with(settings);
    std::vector<std::unique_ptr<Observer>> observers;
    observers.push_back(std::make_unique<Blind>());
    const Scene own                = parameters.create_scene();
    const SimulationResult watched = Simulation(MPI_COMM_WORLD, own, parameters.time, answer.choice.numerics)
                                       .run({}, {.energy_balance = true}, observers);
    EXPECT_NEAR(watched.min_stretch.value, scene.smallest, watched.min_stretch.jump) << scene.p;
  }
}

/// Steep friction of a soft body: the displacement is known, but works of the stretch form would need far shorter
/// steps, so that they are unknown. The displacement is the same in other units.
TEST(HardAnswers, WorksOfSteepFrictionAreUnknown)
{
  struct
  {
    double length, time, force;
  } const units[] = {{1., 1., 1.}, {3.7, 0.21, 11.}, {0.01, 13., 0.3}};
  std::vector<double> displacements, bounds;
  int n_unknown = 0;
  for (const auto &[length, time, force] : units)
  {
    const test::Settings settings = {
      {"Body/Length", test::text(length)},
      {"Body/Elastic modulus", test::text(0.05057650377199341 * force)},
      {"Body/Friction coefficient", test::text(force * time / (length * length))},
      {"Body/Anchoring exponent", "-18"},
      {"Active stress/Generator", "travelling wave"},
      {"Active stress/Travelling wave/Amplitude", test::text(0.042983258181491596 * force)},
      {"Active stress/Travelling wave/Wave number", "1.5"},
      {"Active stress/Travelling wave/Frequency", test::text(1. / time)},
      {"Time/End time", test::text(time)},
      {"Accuracy", "1.6766914086537847e-4"}};
    const SimulationResult result = answer_to(settings);
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    ASSERT_NE(result.energy_balance.has_value(), result.residual_of_unknown_works.has_value());
    if (result.energy_balance)
      EXPECT_LT(result.energy_balance->residual(), 0.1);
    else
    {
      ++n_unknown;
      EXPECT_GT(*result.residual_of_unknown_works, 0.1);
      EXPECT_FALSE(error_bound(result, "stress_power"));
    }
    displacements.push_back(result.displacement / length);
    bounds.push_back(result.error.value().total / length);
  }
  for (std::size_t i = 1; i < displacements.size(); ++i)
    EXPECT_NEAR(displacements[i], displacements[0], bounds[i] + bounds[0]);
  EXPECT_GT(n_unknown, 0);
}

/// Fronts of steep friction: the errors of high degrees fall slowly with the cells, alike in a run and a finer one.
/// True values by the stretch form at Accuracy 2e-5.
TEST(HardAnswers, FrontsOfSteepFriction)
{
  struct
  {
    const char *p, *chi;
    double displacement;
  } const scenes[] = {{"10", "0.81", 0.34721147}, {"10.5", "0.77", 0.33055991}, {"12", "0.83", 0.34544428}};
  for (const auto &scene : scenes)
    for (const char *accuracy : {"3e-3", "1e-3"})
    {
      const SimulationResult result = answer_to({{"Body/Anchoring exponent", scene.p},
                                                 {"Active stress/Optimal wave/Perturbation parameter", scene.chi},
                                                 {"Active stress/Optimal wave/Choose wave by", "wave speed"},
                                                 {"Active stress/Optimal wave/Wave speed", "1"},
                                                 {"Time/End time", "1"},
                                                 {"Discretization/Formulation", "position"},
                                                 {"Accuracy", accuracy}});
      ASSERT_TRUE(result.error) << scene.p;
      EXPECT_NEAR(result.displacement, scene.displacement, result.error->total) << scene.p << ", " << accuracy;
    }
}

/// Steps whose error is too large and for which Newton's method is slow become shorter: one was tried again and again.
TEST(HardAnswers, StepsOfSlowNewtonBecomeShorter)
{
  const SimulationResult result = answer_to({{"Body/Elastic modulus", "9.15807736182125"},
                                             {"Body/Anchoring exponent", "2.0451504463318435"},
                                             {"Ground/Backward ratio", "2.7555937780750934"},
                                             {"Ground/Switching velocity", "0.1480423157647445"},
                                             {"Active stress/Generator", "travelling wave"},
                                             {"Active stress/Travelling wave/Amplitude", "0.054180670200742756"},
                                             {"Active stress/Travelling wave/Wave number", "1.5"},
                                             {"Active stress/Travelling wave/Frequency", "2"},
                                             {"Active stress/Travelling wave/Phase", "0.2821255128916549"},
                                             {"Time/End time", "1.465263056488503"},
                                             {"Accuracy", "1.0000000000000001e-07"}});
  ASSERT_TRUE(result.error) << result.time.message;
  EXPECT_NEAR(result.displacement, 0.0002795362975, result.error->total + 1e-12);
}

/// For -1 < a < 0 the last of a stretch is fed by what flows to it, and its time converges with order 1/2 to 1: 208 to
/// 3328 cells have t = 0.046804, 0.046631, 0.046609, 0.046580, 0.046565.
TEST(HardAnswers, TimesOfSlowInversions)
{
  for (const char *accuracy : {"1e-2", "1e-3", "4e-5", "1e-6"})
  {
    const SimulationResult result = answer_to({{"Body/Elastic modulus", "1.4089567553162061"},
                                               {"Body/Anchoring exponent", "1.1564781665068784"},
                                               {"Active stress/Generator", "travelling wave"},
                                               {"Active stress/Travelling wave/Amplitude", "1.4916126528567062"},
                                               {"Active stress/Travelling wave/Wave number", "1"},
                                               {"Active stress/Travelling wave/Frequency", "1"},
                                               {"Accuracy", accuracy}});
    ASSERT_EQ(result.time.status, Status::inverted) << accuracy;
    ASSERT_TRUE(result.inversion_error);
    EXPECT_NEAR(result.inversion->t, 0.046553, *result.inversion_error) << accuracy;
    EXPECT_LE(*result.inversion_error, 0.01) << accuracy;
    EXPECT_LE(result.time.time, result.inversion->t) << accuracy;
  }
}

/// Shortly before an end inverts the stretch beside it is tiny, and the position form fails; the body inverts all the
/// same, when m(0, t) = k.
TEST(HardAnswers, EndsOfSteepFrictionInvert)
{
  for (const char *accuracy : {"1e-2", "1e-4"})
  {
    const double k = 1.065687391169341, amplitude = 1.3692980755928033;
    const SimulationResult result = answer_to({{"Body/Elastic modulus", test::text(k)},
                                               {"Body/Anchoring exponent", "3.7742919342516785"},
                                               {"Active stress/Generator", "travelling wave"},
                                               {"Active stress/Travelling wave/Amplitude", test::text(amplitude)},
                                               {"Active stress/Travelling wave/Wave number", "1"},
                                               {"Active stress/Travelling wave/Frequency", "1"},
                                               {"Accuracy", accuracy}});
    ASSERT_EQ(result.time.reason, "inverted_at_end") << accuracy << ": " << result.time.message;
    EXPECT_NEAR(result.inversion->t, std::asin(k / amplitude) / (2. * M_PI), 1e-9);
    EXPECT_LE(result.time.time, result.inversion->t);
  }
}

/// Kinks that move through cells and steps, where the velocity changes its sign, have errors that two runs may share.
TEST(HardAnswers, FrictionThatSwitchesItsDirection)
{
  struct
  {
    const char *p, *k, *chi, *c, *end_time, *ratio, *speed, *accuracy;
    double exact;
  } const scenes[] = {{"2.415091944989272",
                       "7.178644708013535",
                       "0.27075758664442684",
                       "-0.7330326605464842",
                       "2.671621976749931",
                       "2.3431502664302823",
                       "0.003715704143340024",
                       "1e-3",
                       -0.0341699916},
                      {"2.4101482147847175",
                       "5.004464838563605",
                       "0.2634700921241963",
                       "-0.835259758152571",
                       "3.083289411874688",
                       "5.1386627396813065",
                       "0.01845967356880094",
                       "1e-4",
                       0.1963942115}};
  for (const auto &scene : scenes)
    expect_within(answer_to({{"Model", "nonlinear"},
                             {"Body/Anchoring exponent", scene.p},
                             {"Body/Elastic modulus", scene.k},
                             {"Active stress/Optimal wave/Perturbation parameter", scene.chi},
                             {"Active stress/Optimal wave/Choose wave by", "wave speed"},
                             {"Active stress/Optimal wave/Wave speed", scene.c},
                             {"Time/End time", scene.end_time},
                             {"Ground/Backward ratio", scene.ratio},
                             {"Ground/Switching velocity", scene.speed},
                             {"Accuracy", scene.accuracy}}),
                  scene.exact,
                  std::stod(scene.accuracy),
                  scene.p);
}

/// Errors in space and time may cancel in two runs, but not in three.
TEST(HardAnswers, NumericsOfTheUser)
{
  unsigned int n_missed = 0, n = 0;
  for (unsigned int cells = 2; cells <= 6; ++cells)
    for (const char *tolerance : {"1e-3", "3e-4", "1e-4", "3e-5", "1e-5"})
    {
      auto settings = test::wave(-1., 0.3);
      settings.insert(settings.end(),
                      {{"Discretization/Number of cells", std::to_string(cells)},
                       {"Discretization/Degree", "4"},
                       {"Time/Tolerance", tolerance},
                       {"Time/Integrator", "radau 5"}});
      const SimulationResult result = answer_to(settings);
      ASSERT_EQ(result.time.status, Status::finished);
      ++n;
      n_missed += std::abs(result.displacement - 4.764510e-2) > result.error->total + 1e-8;
      EXPECT_NEAR(result.error->space + result.error->time, result.error->total, 1e-12);
    }
  EXPECT_EQ(n_missed, 0u) << "of " << n;
}

/// Tiny cells at the ends, for an initial stretch that does not fit them, turn round-off into a rigid motion: friction
/// that is linear in the velocity balances all the same.
TEST(HardAnswers, FrictionBalancesAfterAnInitialStretch)
{
  const SimulationResult result = answer_to({{"Body/Anchoring exponent", "21"},
                                             {"Body/Elastic modulus", "10"},
                                             {"Body/Initial stretch", "1+0.057*tanh(10*(s-0.6))"},
                                             {"Active stress/Generator", "none"},
                                             {"Accuracy", "4e-3"}});
  EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
  EXPECT_LT(result.net_friction, 1e-12);
}

/// At a = 14 friction underflows where the stretch is lost: that is an inversion, not a friction law that fails.
TEST(HardAnswers, LostStretchOfASteepPowerLawIsAnInversion)
{
  test::Settings settings = test::wave(14., 0.1, 1., 1., 1e-5);
  settings.emplace_back("Accuracy", "1e-4");
  const SimulationResult plain = answer_to(settings);
  settings.emplace_back("Body/Elastic modulus profile", "1+1e-9*s");
  const SimulationResult general = answer_to(settings);
  ASSERT_TRUE(plain.inversion && general.inversion) << general.time.reason << ": " << general.time.message;
  EXPECT_NEAR(general.inversion->t, plain.inversion->t, 2e-2 * plain.inversion->t);
}

/// The stress has hardly reached the body: no error is wanted to be smaller than round-off of the length.
/// The works of a sudden start are less accurate than the displacement, and their balance closes within their bounds.
TEST(HardAnswers, AStiffBodyMayStartSuddenly)
{
  const SimulationResult result = answer_to({{"Body/Elastic modulus", "3e5"},
                                             {"Active stress/Generator", "travelling wave"},
                                             {"Active stress/Travelling wave/Amplitude", "3e4"},
                                             {"Active stress/Travelling wave/Profile", "smoothed square"},
                                             {"Accuracy", "1e-8"}});
  EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
  EXPECT_NEAR(result.displacement, 0.009250788171, 1e-10);
}

/// Direction-dependent friction is not linear in the velocity, but it balances as well.
TEST(HardAnswers, FrictionOfTwoDirectionsBalances)
{
  const SimulationResult result = answer_to({{"Ground/Backward ratio", "0.4"},
                                             {"Ground/Switching velocity", "0.05"},
                                             {"Active stress/Generator", "segments"},
                                             {"Active stress/Segments/Amplitude", "0.02"},
                                             {"Active stress/Segments/Switching", "smooth"},
                                             {"Active stress/Segments/Front width", "0.25"},
                                             {"Body/Initial stretch", "1+0.05*s"},
                                             {"Body/Elastic modulus", "100"},
                                             {"Time/End time", "0.3"},
                                             {"Accuracy", "1e-6"}});
  EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
  EXPECT_LT(result.net_friction, 1e-6);
}

/// Pieces between breaks had as many cells on the "finer" graded mesh as on the first: an error of 17e-9 was reported
/// as 3e-9. The answer is that of an independent finite-volume solver and of uniform meshes of up to 640 cells.
TEST(LongHardAnswers, AFinerGradedMeshIsFiner)
{
  expect_within(answer_to({{"Active stress/Generator", "strain feedback"},
                           {"Active stress/Strain feedback/Distance", "0.16708152325341044"},
                           {"Active stress/Strain feedback/Active stress",
                            "A*sin(2*pi*(2*s/L+nu*t)+3.493962525671522)*tanh(3*nu*t)+q*(w_near-1)"},
                           {"Active stress/Strain feedback/Constants",
                            "A=0.1698995273476641, nu=2.8142028874483014, q=4.158517764511806"},
                           {"Body/Length", "0.6136054086999287"},
                           {"Body/Friction coefficient", "0.1592904149792068"},
                           {"Body/Friction profile", "1-0.30860783885816123*(s/L-0.5)"},
                           {"Body/Initial stretch", "1-0.07492570574363198*exp(-((s/L-0.4)/0.15)^2)"},
                           {"Body/Elastic modulus", "14.17652240514235"},
                           {"Body/Anchoring exponent", "2"},
                           {"Ground/Backward ratio", "2.9905409244564414"},
                           {"Ground/Switching velocity", "0.05147982240706705"},
                           {"Time/End time", "0.3262543175273825"},
                           {"Accuracy", "1e-6"}}),
                3.3184885738e-3,
                1e-6,
                "feedback by the stretch nearby");
}

/// The meshes of the stretch form do not meet this Accuracy; those of the position form do, whose answer at 1e-8 this
/// is.
/// Neither form meets this Accuracy: the answer is that of the form that comes nearer, the position form, by a factor
/// of 150. Reference: its own at 1e-8.
/// The active stress is smooth, but not analytic, where its window ends: works converge more slowly than the
/// displacement, and the finer run hardly differed. The energy balance knows.
TEST(HardAnswers, WorksOfAWindow)
{
  const SimulationResult result = answer_to({{"Accuracy", "1e-6"},
                                             {"Body/Anchoring exponent", "2"},
                                             {"Active stress/Generator", "travelling wave"},
                                             {"Active stress/Travelling wave/Amplitude", "0.3"},
                                             {"Active stress/Travelling wave/Wave number", "1.5"},
                                             {"Active stress/Travelling wave/Profile", "smoothed square"},
                                             {"Active stress/Travelling wave/Front width", "0.2"},
                                             {"Active stress/Travelling wave/Window start", "0.1"},
                                             {"Active stress/Travelling wave/Window end", "0.9"},
                                             {"Active stress/Travelling wave/Window edge", "0.1"},
                                             {"Active stress/Travelling wave/Ramp duration", "0.5"},
                                             {"Time/End time", "4"}});
  expect_within(result, 0.1291981595902, 1e-6, "window");
  EXPECT_LE(std::abs(result.energy_balance->stress_work - 0.1384564528), error_bound(result, "stress_power").value());
  EXPECT_LE(std::abs(result.energy_balance->dissipation - 0.1125056274), error_bound(result, "dissipation").value());
}

/// Cells end at the knots of a spline, where its third derivative jumps: else errors fall like a small power of the
/// size of a cell, and a slightly finer mesh has nearly the same.
TEST(HardAnswers, ProfileByASpline)
{
  const std::string file = testing::TempDir() + "modulus_profile.csv";
  std::ofstream(file)
    << "s,value\n0,1.06\n0.21,1.03\n0.42,0.96\n0.63,1.06\n0.84,0.9\n1.05,1.05\n1.26,0.94\n1.47,1.02\n";
  const auto at = [&](const char *accuracy) {
    return answer_to({{"Accuracy", accuracy},
                      {"Body/Length", "1.46"},
                      {"Body/Friction coefficient", "0.3"},
                      {"Body/Elastic modulus", "0.0087"},
                      {"Body/Elastic modulus profile", file},
                      {"Active stress/Optimal wave/Choose wave by", "wave speed"},
                      {"Active stress/Optimal wave/Wave speed", "1"},
                      {"Active stress/Optimal wave/Perturbation parameter", "0.06"},
                      {"Time/End time", "2.5"}});
  };
  const SimulationResult exact = at("1e-10");
  ASSERT_EQ(exact.time.status, Status::finished) << exact.time.message;
  for (const char *accuracy : {"1e-4", "1e-5", "1e-6", "2.5e-7"})
    expect_within(at(accuracy), exact.displacement, std::stod(accuracy), accuracy);
}

/// No step is longer than the time in which the active stress changes. Where it is that which makes the steps, and not
/// the tolerance, a smaller tolerance alone shows no error.
TEST(HardAnswers, StepsThatOnlyTheirLimitMakes)
{
  test::Settings settings = test::random_scene(336).settings;
  settings.emplace_back("Accuracy", "1e-6");
  expect_within(answer_to(settings), 0.013195775551215, 1e-6, "a wave");
}

/// Sixty strides that all have to be computed, since the ground varies or the body is too soft to settle: the first
/// three choose mesh and tolerance, and the bounds are about all sixty.
/// On three meshes their displacements agree by chance (reference: the position form at 1e-9).
/// Peaks of fronts are those of the finest mesh, not extrapolated: 2.43 on 400 cells, 2.31 on 800, 2.277 on 1600.
/// Thirteen steps on 304 cells have ten times the error in time that they have on 152.
/// A thousand strides and a single event in them; and three thousand, of which a grid over the duration shows 40 as
/// one.
/// A body that rests but for an event, whose start no step may pass over: all runs of an answer would have the same
/// error there. Its samples may be as small as those of a Gaussian far from its middle.
/// Two materials: cells end where they meet, so that the automatic numerics are as good as eight cells.
TEST(HardAnswers, ModulusThatJumpsInAFormula)
{
  expect_within(answer_to({{"Accuracy", "1e-4"},
                           {"Body/Anchoring exponent", "2"},
                           {"Body/Elastic modulus profile", "s < 0.5 ? 1 : 3"},
                           {"Active stress/Generator", "expression"},
                           {"Active stress/Expression/Active stress", "0.3*(1-exp(-5*t))"},
                           {"Time/End time", "5"}}),
                -0.00327110,
                1e-4,
                "modulus 1 and 3");
}

/// Friction of two directions, whose kinks move through the cells, and a displacement that is nearly 0 (true: runs at
/// 1e-6, and by 200 cells).
TEST(HardAnswers, KinksOfFrictionGetMoreCells)
{
  expect_within(answer_to({{"Accuracy", "1e-5"},
                           {"Body/Elastic modulus", "0.628969760229485"},
                           {"Body/Anchoring exponent", "2.877515581644195"},
                           {"Ground/Backward ratio", "0.44833912717340346"},
                           {"Ground/Switching velocity", "0.05"},
                           {"Active stress/Generator", "travelling wave"},
                           {"Active stress/Travelling wave/Amplitude", "0.21753521426996525"},
                           {"Active stress/Travelling wave/Wave number", "1.5"},
                           {"Active stress/Travelling wave/Frequency", "2"},
                           {"Active stress/Travelling wave/Phase", "2.6380110418195337"},
                           {"Active stress/Travelling wave/Ramp duration", "0.3"},
                           {"Time/End time", "0.40211717607952263"}}),
                -5.6504301e-5,
                2e-5, // of 1e-4 of the deformation, which is larger
                "ramped wave on ground of two directions");
}

/// The displacement on the coarsest mesh of a very soft body is far too large, and so is the error in time that is
/// admissible there.
