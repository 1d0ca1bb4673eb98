// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Scenes whose answers were once wrong, with bounds that said otherwise: steep friction, meshes of the user's own,
// jumps. Events are in events_test.cc, soft bodies in soft_bodies_test.cc.
#include "../support/answers.h"
#include "../support/expect_within.h"
#include "../support/test.h"

#include <crawler/accuracy/error_estimate.h>
#include <crawler/run/result_table.h>

using namespace crawler;
using test::answer_to;
using test::expect_within;

/// a > 0, three cells: the body does not invert.
TEST(HardAnswers, ACoarseMeshDoesNotInvertABody)
{
  const auto answer = [](const unsigned int n_cells, const double chi, const double end_time) {
    return answer_to(test::with(
      test::wave(3.38, chi, -1., end_time, 0.0134), "cells = {}; degree = 3; integrator = radau 9", n_cells));
  };
  const SimulationResult coarse = answer(3, 0.302, 0.346);
  EXPECT_EQ(coarse.time.reason, "under_resolved") << coarse.time.message;
  EXPECT_FALSE(coarse.inversion);
  EXPECT_EQ(answer(24, 0.302, 0.346).time.status, Status::finished);
  // One that does is believed.
  EXPECT_EQ(answer_to(test::set("p = 0; chi = 0.6; c = -1; cells = 12; degree = 6")).time.status, Status::inverted);
}

/// A rhythm of the body's own (prm/examples/feedback.prm), whose errors of the phase add up. True one at 1e-6.
TEST(HardAnswers, ARhythmOfItsOwnNeedsOneTry)
{
  for (const char *const accuracy : {"1e-3", "1e-4"})
  {
    const SimulationResult result =
      answer_to(test::set("k = 0.1; Body/Initial stretch = 1+0.01*exp(-((s-0.425)/0.05)^2); T = 10; Accuracy = {}; "
                          "strain feedback; Active stress = 0.05*tanh(10*(w_near-1)); Distance = -0.25; "
                          "Sensor length = 0.2",
                          accuracy));
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    EXPECT_EQ(result.process.refinements, 0u) << accuracy;
    EXPECT_NEAR(result.displacement, 0.27515297, result.error->total) << accuracy;
    EXPECT_LE(result.error->total, std::stod(accuracy) * result.displacement) << accuracy;
  }
}

/// On coarse meshes of steep friction the stretch jumps between cells, and is wrong at the ends of the body, alike on
/// all of them: in the answer and where observers look at the run, and the efficiencies follow from it. True ones on 26
/// cells and more at 1e-7.
TEST(HardAnswers, ExtremesOfSteepFriction)
{
  struct
  {
    const char *settings;
    double smallest, efficiency;
  } const scenes[] = {{"p = 5.6348; k = 0.06209; chi = 0.3808; c = 1.3; T = 1.5945", 0.664438, 0.282267},
                      {"p = 6.4216; k = 0.04749; chi = 0.3974; c = -1.0589; T = 1.0264", 0.624705, 0.146382},
                      {"p = 3.2155; k = 0.05816; chi = 0.4075; c = -0.7661; T = 0.9133", 0.370797, 0.358654}};
  for (const auto &[text, smallest, efficiency] : scenes)
  {
    const test::Settings settings  = test::with(test::set(text), {{"Accuracy", "1e-2"}});
    const Answer answer            = test::computed(settings);
    const SimulationResult &result = answer.result;
    EXPECT_NEAR(result.stretch.min.value, smallest, error_bound(result, "min_stretch.value").value()) << text;
    EXPECT_NEAR(result.gait_efficiency.value(), efficiency, error_bound(result, "gait.efficiency").value()) << text;
    const Parameters parameters    = test::parameters_with(settings);
    const Scene own                = parameters.create_scene();
    const SimulationResult watched = Simulation(MPI_COMM_WORLD, own, parameters.time, answer.choice.numerics)
                                       .run({}, {.energy_balance = true}, watched_by([](const Snapshot &) {}));
    EXPECT_NEAR(watched.stretch.min.value, smallest, watched.stretch.min.jump) << text;
  }
}

/// Steep friction of a soft body: the displacement is known, but works of the stretch form would need far shorter
/// steps, so that they are unknown. The displacement is the same in other units.
TEST(HardAnswers, WorksOfSteepFrictionAreUnknown)
{
  struct
  {
    double length, time, force;
  } const units[] = {{1., 1., 1.}, {3.7, 0.21, 11.}};
  std::vector<double> displacements, bounds;
  int n_unknown = 0;
  for (const auto &[length, time, force] : units)
  {
    const test::Settings settings = test::set("p = -18; L = {}; k = {}; gamma = {}; T = {}; "
                                              "Accuracy = 1.6766914086537847e-4; travelling wave; Wave number = 1.5; "
                                              "Amplitude = {}; Frequency = {}",
                                              length,
                                              0.05057650377199341 * force,
                                              force * time / (length * length),
                                              time,
                                              0.042983258181491596 * force,
                                              1. / time);
    const SimulationResult result = answer_to(settings);
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    ASSERT_NE(result.energy_balance.has_value(), result.residuals.unknown_works.has_value());
    if (result.energy_balance)
      EXPECT_LT(result.energy_balance->residual(), 0.1);
    else
    {
      ++n_unknown;
      EXPECT_GT(*result.residuals.unknown_works, 0.1);
      EXPECT_FALSE(error_bound(result, "stress_power"));
    }
    displacements.push_back(result.displacement / length);
    bounds.push_back(result.error.value().total / length);
  }
  for (std::size_t i = 1; i < displacements.size(); ++i)
    EXPECT_NEAR(displacements[i], displacements[0], bounds[i] + bounds[0]);
  EXPECT_GT(n_unknown, 0);
}

/// Scenes whose errors were above their bounds, and why.
TEST(HardAnswers, DisplacementsAreWithinTheirBounds)
{
  struct
  {
    const char *why, *settings;
    double displacement;
    double accuracy; ///< that the bound must keep, if this is not 0
  } const scenes[] = {
    {"fronts: the errors of high degrees fall slowly with the cells, alike in a run and a finer one (true by the "
     "stretch form at Accuracy 2e-5)",
     "p = 10; chi = 0.81; c = 1; Discretization/Formulation = position; Accuracy = 3e-3",
     0.34721147,
     0.},
    {"fronts", "p = 10; chi = 0.81; c = 1; Discretization/Formulation = position; Accuracy = 1e-3", 0.34721147, 0.},
    {"fronts", "p = 12; chi = 0.83; c = 1; Discretization/Formulation = position; Accuracy = 3e-3", 0.34544428, 0.},
    {"fronts", "p = 12; chi = 0.83; c = 1; Discretization/Formulation = position; Accuracy = 1e-3", 0.34544428, 0.},
    {"steps whose error is too large and for which Newton's method is slow: one was tried again and again",
     "k = 9.15807736182125; p = 2.0451504463318435; Ground/Backward ratio = 2.7555937780750934; "
     "Ground/Switching velocity = 0.1480423157647445; T = 1.465263056488503; Accuracy = 1.0000000000000001e-07; "
     "travelling wave; Amplitude = 0.054180670200742756; Wave number = 1.5; Frequency = 2; Phase = 0.2821255128916549",
     0.0002795362975,
     0.},
    {"kinks of a compact pulse: the adjoint, whose own error counts, shows more than the finer run does",
     "k = 0.001; gamma = 0.003275; p = 3; T = 100; Body/Elastic modulus profile = 1.5, 1, 0.7, 1, 2; "
     "Accuracy = 1e-5; pulse; Amplitude = -0.0007; Shape = compact; Width = 0.1694; Speed = 0.01587; "
     "Direction = from head to tail",
     0.08263334242,
     0.},
    {"kinks that move through cells and steps, where the velocity changes its sign: errors that two runs may share",
     "p = 2.415091944989272; k = 7.178644708013535; chi = 0.27075758664442684; c = -0.7330326605464842; "
     "T = 2.671621976749931; Ground/Backward ratio = 2.3431502664302823; "
     "Ground/Switching velocity = 0.003715704143340024; Accuracy = 1e-3",
     -0.0341699916,
     1e-3},
    {"kinks that move",
     "p = 2.4101482147847175; k = 5.004464838563605; chi = 0.2634700921241963; c = -0.835259758152571; "
     "T = 3.083289411874688; Ground/Backward ratio = 5.1386627396813065; "
     "Ground/Switching velocity = 0.01845967356880094; Accuracy = 1e-4",
     0.1963942115,
     1e-4},
    {"pieces between breaks had as many cells on the finer graded mesh as on the first (true by an independent "
     "finite-volume solver, and by up to 640 cells)",
     "L = 0.6136054086999287; gamma = 0.1592904149792068; Body/Friction profile = 1-0.30860783885816123*(s/L-0.5); "
     "Body/Initial stretch = 1-0.07492570574363198*exp(-((s/L-0.4)/0.15)^2); k = 14.17652240514235; p = 2; "
     "Ground/Backward ratio = 2.9905409244564414; Ground/Switching velocity = 0.05147982240706705; "
     "T = 0.3262543175273825; Accuracy = 1e-6; strain feedback; Distance = 0.16708152325341044; "
     "Active stress = A*sin(2*pi*(2*s/L+nu*t)+3.493962525671522)*tanh(3*nu*t)+q*(w_near-1); "
     "Constants = A=0.1698995273476641, nu=2.8142028874483014, q=4.158517764511806",
     3.3184885738e-3,
     1e-6},
    {"two materials: cells end where they meet, so that the automatic numerics are as good as eight cells",
     "Accuracy = 1e-4; p = 2; Body/Elastic modulus profile = s < 0.5 ? 1 : 3; T = 5; expression; "
     "Active stress = 0.3*(1-exp(-5*t))",
     -0.00327110,
     1e-4},
    {"an adaptive mesh does not follow what is seen from elsewhere, nor did the finer one (true by 128 cells of degree "
     "8)",
     "k = 0.1; Accuracy = 1e-4; Discretization/Mesh = adaptive; T = 2; strain feedback; Distance = 0.25; "
     "Active stress = 0.06*sin(2*pi*t)*exp(-((L-s)/0.2)^2) + 0.08*(w_near-1)",
     0.00097161000385,
     1e-4},
    {"jumps that feedback shows again along the body (true by linear elements, extrapolated; the bound is a fifth of "
     "Accuracy)",
     "p = 2; k = 0.3; Accuracy = 1e-4; strain feedback; Distance = 0.13; "
     "Active stress = 0.12*(s<0.4)*sin(2*pi*t)^2 - 0.15*(w_near-1)",
     -0.0062432610,
     1e-4},
    {"jumps that feedback shows again after its delay (true by linear elements and the implicit midpoint rule)",
     "p = 3; k = 0.1; T = 2; Accuracy = 1e-5; strain feedback; Delay = 0.15; "
     "Active stress = 0.24*(mod(t,0.11)<0.055)*s*(1-s)*s - 0.08*(w_delayed-1) + 0.02*w_t",
     0.003617837777,
     1e-5},
    {"a stiff body that is nearly emptied (doc/theory.md, section 5)",
     "p = 2; k = 10; chi = 0.6; c = 1; Accuracy = 1e-4",
     0.26374413,
     1e-4},
    {"kinks of friction, and a displacement that is nearly 0, so that Accuracy is of 1e-4 of the deformation (true by "
     "runs at 1e-6, and by 200 cells)",
     "Accuracy = 1e-5; k = 0.628969760229485; p = 2.877515581644195; Ground/Backward ratio = 0.44833912717340346; "
     "Ground/Switching velocity = 0.05; T = 0.40211717607952263; travelling wave; Amplitude = 0.21753521426996525; "
     "Wave number = 1.5; Frequency = 2; Phase = 2.6380110418195337; Ramp duration = 0.3",
     -5.6504301e-5,
     2e-5},
    {"kinks that travel through graded cells: meshes of few cells have the same error (true by runs at 1e-6)",
     "Accuracy = 1e-3; k = 0.918; p = 1.58; T = 0.788; expression; "
     "Active stress = abs(0.249*sin(2*pi*(1.43*s-1.325*t+0.607)))+max(0,0.257*sin(2*pi*(1.628*s+1.481*t+0.367)))",
     2.66954669e-3,
     1e-3},
    {"kinks whose error is the same with 6, 9 and 12 cells (true by 233 cells)",
     "Accuracy = 1e-3; k = 7.227; p = 1.66; T = 0.822; expression; "
     "Active stress = abs(0.256*sin(2*pi*(1.713*s+0.701*t+0.731)))+max(0,0.094*sin(2*pi*(-1.666*s+1.526*t+0.165)))"
     "+0.081*(t>0.6724)",
     1.200396e-5,
     1e-3},
    {"a kink that travels, and a jump in time",
     "Accuracy = 1e-2; k = 4.44; p = 1.9; T = 1.348; expression; "
     "Active stress = abs(0.186*sin(2*pi*(1.8*s-1.128*t+0.07)))-0.273*(t>0.5549)",
     -1.361430e-4,
     1e-2},
    {"kinks of friction that move make the error fall slowly: while it falls, and is near, runs become finer (true at "
     "Accuracy 1e-8)",
     "Ground/Backward ratio = 2; Ground/Switching velocity = 0.05; p = 0.5; T = 2; Accuracy = 1e-6; travelling wave; "
     "Amplitude = 0.4; Wave number = 2; Frequency = 1",
     0.04890174478,
     1e-6},
    {"no step is longer than the time in which the active stress changes: where that makes the steps, or they are few, "
     "a smaller tolerance alone shows no error",
     "L = 0.114604896506434; gamma = 1.7448731723068271; k = 0.2039606232569097; p = -1.9108090755410068; "
     "T = 3.5269571389828647; c = -0.07625396056553113; chi = 0.17226841894742512; Accuracy = 1e-6; optimal wave; "
     "Sine coefficients = 0.07625396056553113, 0.005357343044794686, -0.013427550092778198; "
     "Cosine coefficients = 0.03577011024144475, -0.02015803257642371, 0.022810109172851617",
     0.013195775551215,
     1e-6},
    {"steps that are made by the active stress",
     "L = 2.010370657897845; gamma = 8.487361160843255; k = 7894.71289602517; p = -2; T = 0.21129570364542266; "
     "Accuracy = 1e-5; travelling wave; Amplitude = -430.1955131996885; Wave number = 0.3149221361822745; "
     "Phase = -2.7115899734288043; Direction = from head to tail; Frequency = 3.6358192962412854; "
     "Ramp duration = 0.22136830174299965",
     -0.00224160745982974,
     1e-5},
    {"steps that are few",
     "L = 0.4711831123086405; gamma = 0.20399889299382123; k = 1.4013038516292156; p = -1.0443750931231794; "
     "T = 0.7611671870336101; c = 0.21228718868900642; chi = 0.19470884806291824; Accuracy = 1e-8; optimal wave; "
     "Sine coefficients = 0.21228718868900642",
     -0.00368876593505436,
     1e-8},
    {"steps as long as the active stress admits have the error, not the cells of many waves",
     "T = 1; travelling wave; Amplitude = 0.3; Wave number = 150; Frequency = 1; Ramp duration = 0.5; Accuracy = 1e-2",
     0.00021554847,
     1e-2},
    {"steps as long as the active stress admits have the error, not the cells of many waves",
     "T = 1; travelling wave; Amplitude = 0.3; Wave number = 150; Frequency = 1; Ramp duration = 0.5; Accuracy = 1e-3",
     0.00021554847,
     1e-3}};
  for (const auto &[why, settings, displacement, accuracy] : scenes)
  {
    const SimulationResult result = answer_to(test::set(settings));
    if (accuracy > 0.)
      expect_within(result, displacement, accuracy, why);
    else
    {
      ASSERT_TRUE(result.error) << why << ": " << result.time.message;
      EXPECT_NEAR(result.displacement, displacement, result.error->total + 1e-12) << why;
    }
  }
  // The works of a sudden start are less accurate than the displacement, and their balance closes within their bounds.
  const SimulationResult sudden =
    answer_to(test::set("k = 3e5; Accuracy = 1e-8; travelling wave; Amplitude = 3e4; Profile = smoothed square"));
  EXPECT_EQ(sudden.time.status, Status::finished) << sudden.time.message;
  EXPECT_NEAR(sudden.displacement, 0.009250788171, 1e-10);
}

/// Kinks that travel need more cells, and steps so small that they do not pass over them, but no smaller ones with each
/// mesh: the search once ended with 9708 steps for the first scene, and the tries with 12 872 for the second. The
/// numbers of steps are a matter of chance, which the last digit of a coefficient decides: 547 or 1297 for the first.
TEST(HardAnswers, KinksThatTravelNeedCells)
{
  const auto expect_few_steps = [](const std::string &scene, const double displacement, const unsigned int steps) {
    const SimulationResult result = answer_to(test::set("Accuracy = 1e-4; expression; " + scene));
    expect_within(result, displacement, 1e-4, scene);
    EXPECT_LE(result.time.steps, steps) << scene;
  };
  expect_few_steps("k = 4.44; p = 1.9; T = 1.348; "
                   "Active stress = abs(0.186*sin(2*pi*(1.8*s-1.128*t+0.07)))-0.273*(t>0.5549)",
                   -1.3614367e-4,
                   2000);
  expect_few_steps("k = 7.227; p = 1.66; T = 0.822; Active stress = abs(0.256*sin(2*pi*(1.713*s+0.701*t+0.731)))"
                   "+max(0,0.094*sin(2*pi*(-1.666*s+1.526*t+0.165)))+0.081*(t>0.6724)",
                   1.2003947e-5,
                   2000);
}

/// For -1 < a < 0 the last of a stretch is fed by what flows to it, and its time converges with order 1/2 to 1: 208 to
/// 3328 cells have t = 0.046804, 0.046631, 0.046609, 0.046580, 0.046565.
TEST(HardAnswers, TimesOfSlowInversions)
{
  for (const char *accuracy : {"1e-2", "1e-3", "4e-5", "1e-6"})
  {
    const SimulationResult result =
      answer_to(test::set("k = 1.4089567553162061; p = 1.1564781665068784; Accuracy = {}; travelling wave; "
                          "Amplitude = 1.4916126528567062; Wave number = 1; Frequency = 1",
                          accuracy));
    ASSERT_EQ(result.time.status, Status::inverted) << accuracy;
    ASSERT_TRUE(result.inversion->error);
    EXPECT_NEAR(result.inversion->t, 0.046553, *result.inversion->error) << accuracy;
    EXPECT_LE(*result.inversion->error, 0.01) << accuracy;
    EXPECT_LE(result.time.time, result.inversion->t) << accuracy;
  }
}

/// Errors in space and time may cancel in two runs, but not in three.
TEST(HardAnswers, NumericsOfTheUser)
{
  unsigned int n_missed = 0, n = 0;
  for (unsigned int cells = 2; cells <= 6; ++cells)
    for (const char *tolerance : {"1e-3", "3e-4", "1e-4", "3e-5", "1e-5"})
    {
      const SimulationResult result = answer_to(test::with(
        test::wave(-1., 0.3), "cells = {}; degree = 4; tolerance = {}; integrator = radau 5", cells, tolerance));
      ASSERT_EQ(result.time.status, Status::finished);
      ++n;
      n_missed += std::abs(result.displacement - 4.764510e-2) > result.error->total + 1e-8;
      EXPECT_NEAR(result.error->space + result.error->time, result.error->total, 1e-12);
    }
  EXPECT_EQ(n_missed, 0u) << "of " << n;
}

/// At a = 14 friction underflows where the stretch is lost: that is an inversion, not a friction law that fails.
TEST(HardAnswers, LostStretchOfASteepPowerLawIsAnInversion)
{
  const test::Settings settings  = test::with(test::wave(14., 0.1, 1., 1., 1e-5), "Accuracy = 1e-4");
  const SimulationResult plain   = answer_to(settings),
                         general = answer_to(test::with(settings, "Body/Elastic modulus profile = 1+1e-9*s"));
  ASSERT_TRUE(plain.inversion && general.inversion) << general.time.reason << ": " << general.time.message;
  EXPECT_NEAR(general.inversion->t, plain.inversion->t, 2e-2 * plain.inversion->t);
}

/// Tiny cells at the ends, for an initial stretch that does not fit them, turn round-off into a rigid motion: friction
/// that is linear in the velocity balances all the same, and so does that of two directions, which is not. In the tiny
/// step after a switch the velocity has an error that moves nothing.
TEST(HardAnswers, FrictionBalances)
{
  for (const auto &[scene, largest] :
       {std::pair("p = 21; k = 10; Body/Initial stretch = 1+0.057*tanh(10*(s-0.6)); Accuracy = 4e-3; none", 1e-12),
        {"Ground/Backward ratio = 0.4; Ground/Switching velocity = 0.05; Body/Initial stretch = 1+0.05*s; k = 100; "
         "T = 0.3; Accuracy = 1e-6; segments; Amplitude = 0.02; Switching = smooth; Front width = 0.25",
         1e-6},
        {"Ground/Backward ratio = 5; Ground/Switching velocity = 0.01; p = 1; k = 10; T = 1; Accuracy = 1e-4; "
         "segments; Number of segments = 2; Phase lag = 0.5; Amplitude = 0.1",
         1e-6}})
  {
    const SimulationResult result = answer_to(test::set("{}", scene));
    EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
    EXPECT_LT(result.residuals.net_friction, largest) << scene;
  }
  // Newton's method leaves a part of the friction that its tolerance admits; longer steps leave more.
  const test::Settings sudden = test::set(
    "Ground/Backward ratio = 5; Ground/Switching velocity = 0.02; p = 0.5; k = 7.78; T = 1.7; Accuracy = 1e-4; "
    "Body/Initial stretch = 1+0.05*exp(-((s-0.4)/0.1)^2); expression; "
    "Active stress = t<0.552 ? 0 : t<1.03 ? 0.062*sin(1.5*s) : 0.062*cos(2*s)*s");
  for (const char *const tolerance : {"automatic", "1e-3"})
  {
    const SimulationResult own = answer_to(test::with(sudden, {{"Time/Tolerance", tolerance}}));
    ASSERT_EQ(own.time.status, Status::finished) << own.time.message;
    EXPECT_NEAR(own.displacement, 0.003454548572, own.error->total) << tolerance; // with Accuracy 1e-7
  }
}

/// Kinks of a compact pulse: the works of a run and a finer one differ by half of their errors only.
TEST(HardAnswers, WorksOfACompactPulse)
{
  const auto answer = [](const char *accuracy) {
    return answer_to(test::set("k = 0.8733; gamma = 0.0364; p = 3.7; T = 1.059; Accuracy = {}; pulse; "
                               "Amplitude = 0.5224; Shape = compact; Width = 0.1107; Speed = 1.066",
                               accuracy));
  };
  const SimulationResult result = answer("2.58e-5"), finer = answer("1e-7");
  for (const char *work : {"stress_power", "paper_energy", "dissipation"})
    EXPECT_LE(std::abs(entry_of(work).number_in(result) - entry_of(work).number_in(finer)),
              0.8 * error_bound(result, work).value())
      << work;
}

/// The active stress is smooth, but not analytic, where its window ends: works converge more slowly than the
/// displacement, and the finer run hardly differed. The energy balance knows.
TEST(HardAnswers, WorksOfAWindow)
{
  const SimulationResult result =
    answer_to(test::set("Accuracy = 1e-6; p = 2; T = 4; travelling wave; Amplitude = 0.3; Wave number = 1.5; "
                        "Profile = smoothed square; Front width = 0.2; Window start = 0.1; Window end = 0.9; "
                        "Window edge = 0.1; Ramp duration = 0.5"));
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
    return answer_to(test::set("L = 1.46; gamma = 0.3; k = 0.0087; c = 1; chi = 0.06; T = 2.5; Accuracy = {}; "
                               "Body/Elastic modulus profile = {}",
                               accuracy,
                               file));
  };
  const SimulationResult exact = at("1e-10");
  ASSERT_EQ(exact.time.status, Status::finished) << exact.time.message;
  for (const char *accuracy : {"1e-4", "1e-5", "1e-6", "2.5e-7"})
    expect_within(at(accuracy), exact.displacement, std::stod(accuracy), accuracy);
}

/// The fronts of a stiff robot make layers with steep friction that no mesh of a few hundred cells resolves, and the
/// displacement hardly feels: few cells of high order are enough. True one on 512 cells at 1.3e-7; the stretch form at
/// 1e-4 has -0.186227 +- 1.2e-5.
TEST(HardAnswers, LayersThatDoNotMatter)
{
  const SimulationResult result =
    answer_to(test::set("L = 1.0249872646; gamma = 1.4265455394; k = 527.58411646; p = 14.486448312; "
                        "T = 2.5349192866; Accuracy = 1e-5; segments; Number of segments = 4; "
                        "Amplitude = 83.241538780; Frequency = 6.5684930546; Phase lag = 0.25; "
                        "Direction = from tail to head; Duty cycle = 0.76283932775; "
                        "Saturation = 78.830841576; Rate limit = 7515.2183465"));
  expect_within(result, -0.1862200015, 1e-5, "robot");
  EXPECT_EQ(result.process.formulation, Formulation::position);
  EXPECT_LE(result.process.mesh.n_cells, 128u);
}

/// Efficiencies have the errors of the displacement and of the extreme stretches as well. True ones at 1e-8 and 1e-5;
/// that of a body that is let go, whose displacement is 0, is 0.
TEST(HardAnswers, Efficiencies)
{
  const auto expect = [](const double efficiency, const char *scene) {
    const SimulationResult result = answer_to(test::set("{}", scene));
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    EXPECT_NEAR(result.gait_efficiency.value(), efficiency, error_bound(result, "gait.efficiency").value()) << scene;
  };
  expect(0.36099, "Accuracy = 1e-6; c = 1; chi = 0.6");
  expect(0.50624,
         "Accuracy = 1e-3; T = 2; travelling wave; Amplitude = 0.3; Wave number = 1; Frequency = 1; "
         "Profile = square; Ramp duration = 0.5");
  expect(0.,
         "Accuracy = 1e-3; T = 0.5; Active stress/Generator = none; Body/Initial stretch = 1+0.3*sin(2*pi*s/L)+0.1*s");
}

/// A stride's displacement is known to round-off at best, as that of the run is: with p = 1, and by symmetry, both are
/// 0.
TEST(HardAnswers, StridesThatLeadNowhere)
{
  const auto expect = [](const char *scene, const bool keeps_centre) {
    const SimulationResult result = answer_to(test::set("{}", scene));
    ASSERT_TRUE(result.gait) << scene;
    for (const char *const key : {"gait.displacement", "gait.speed"})
      EXPECT_GE(error_bound(result, key).value(), keeps_centre ? result.error->total : 1e-15) << scene << ", " << key;
  };
  expect("Accuracy = 1e-3; p = 1; T = 10; gamma = 0.23; travelling wave; Amplitude = 0.3; Wave number = 1; "
         "Frequency = 1",
         true);
  expect("Accuracy = 1e-3; p = 2; T = 5; expression; Active stress = 0.1*sin(2*pi*t)*sin(pi*s)", false);
}

/// Fronts of a sudden start that fast friction drives from the ends overshoot on any mesh, whose body does not invert:
/// 1 - m/k is 0.18 at least. One whose stress jumps by more than 2 k inside does.
TEST(HardAnswers, InversionsOfSuddenStarts)
{
  const SimulationResult steep =
    answer_to(test::set("p = -8; k = 1000; T = 1; Discretization/Mesh = adaptive; Accuracy = 1e-2; segments; "
                        "Number of segments = 8; Amplitude = 820; Frequency = 1; Phase lag = 0.125; "
                        "Switching = smooth; Front width = 0.03; Gap = 0.28"));
  EXPECT_EQ(steep.time.reason, "under_resolved") << steep.time.message;
  EXPECT_FALSE(steep.inversion);
  const SimulationResult jump =
    answer_to(test::set("p = 0; T = 1; Accuracy = 1e-3; expression; Active stress = 2.6*(s>0.3)*(s<0.7)"));
  EXPECT_EQ(jump.time.reason, "inverted_inside") << jump.time.message;
}
