// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Extreme stretches after the active stress starts or jumps suddenly, where polynomials overshoot (doc/numerics.md,
// "Extremes after sudden changes"): exact ones for a = 0, where v = w + m/k solves the heat equation with v = 1 at the
// ends, and those of finer and finer runs.
#include "../support/answers.h"
#include "../support/test.h"

#include <crawler/run/result_table.h>

using namespace crawler;
using test::answer_to;

namespace
{
  /// Both extremes are within their bounds, and these are no wider than @p widest.
  void
  expect_stretch(const test::Settings &settings, const double smallest, const double largest, const double widest)
  {
    const SimulationResult result = answer_to(settings);
    const std::string what        = settings.back().second;
    ASSERT_EQ(result.time.status, Status::finished) << what << ": " << result.time.message;
    ASSERT_FALSE(result.errors.empty()) << what;
    EXPECT_LE(std::abs(result.stretch.min.value - smallest), error_bound(result, "min_stretch.value").value()) << what;
    EXPECT_LE(std::abs(result.stretch.max.value - largest), error_bound(result, "max_stretch.value").value()) << what;
    EXPECT_LE(error_bound(result, "min_stretch.value").value(), widest) << what;
    EXPECT_LE(error_bound(result, "max_stretch.value").value(), widest) << what;
  }

  test::Settings
  robot(const unsigned int n_segments, const std::string &p, const std::string &accuracy)
  {
    return test::set("p = {}; T = 1; segments; Amplitude = 0.3; Duty cycle = 0.5; Number of segments = {}; "
                     "Phase lag = {}; Accuracy = {}",
                     p,
                     n_segments,
                     1. / n_segments,
                     accuracy);
  }
} // namespace

/// The stress 0.3 at once: by the maximum principle the stretch is between 1 - m/k and 1.
TEST(SuddenStretch, ConstantStress)
{
  for (const char *accuracy : {"1e-3", "1e-5", "1e-7"})
    expect_stretch(test::set("p = 1; T = 2; expression; Active stress = 0.3; Accuracy = {}", accuracy), 0.7, 1., 2e-3);
}

/// A body that starts compressed or stretched meets its ends, where the stretch is 1 - m/k: between both it stays.
TEST(SuddenStretch, InitialStretch)
{
  for (const char *const accuracy : {"1e-4", "1e-6"})
    for (const auto &[p, initial] : {std::pair("2", "0.7"), {"-1", "2.5"}})
      expect_stretch(test::set("k = 0.05; p = {}; T = 1; Body/Initial stretch = {}; Accuracy = {}; expression; "
                               "Active stress = 0.001*sin(2*pi*t)*s",
                               p,
                               initial,
                               accuracy),
                     std::min(std::stod(initial), 0.98),
                     std::max(std::stod(initial), 1.02),
                     0.03);
}

/// A reflex by the stretch itself: the ends follow m + (k + kappa) (w - 1) = 0, also with m at once from t = 0 on.
TEST(SuddenStretch, LocalFeedback)
{
  for (const char *accuracy : {"1e-2", "1e-4"})
    for (const char *stress : {"(t>0.3 ? 0.03 : 0)+0.02*(w-1)", "0.03+0.02*(w-1)", "0.275+(w-1)"})
      for (const char *p : {"-1", "0", "2"})
        expect_stretch(
          test::set("Accuracy = {}; k = 0.1; p = {}; T = 1; strain feedback; Active stress = {}", accuracy, p, stress),
          0.75,
          1.,
          4e-3);
}

/// With other feedback nothing better than the polynomials is known: no bound in layers, but later.
TEST(SuddenStretch, HasNoBoundWithOtherFeedback)
{
  const auto bound_with = [](const char *stress) {
    const auto result = answer_to(test::set("Accuracy = 1e-4; k = 0.1; p = 0; T = 1; strain feedback; Distance = 0.1; "
                                            "Active stress = {}+0.02*(w_near-1)",
                                            stress));
    EXPECT_EQ(result.time.status, Status::finished);
    return error_bound(result, "min_stretch.value");
  };
  EXPECT_FALSE(bound_with("(t>0.3 ? 0.03 : 0)"));
  EXPECT_TRUE(bound_with("0.03*sin(2*pi*t)*sin(pi*s)"));
}

/// The true ones are those of a sine series of 3000 terms for v: at each switch m, and v with it, jumps, and at a jump
/// in space v is then the mean of both sides.
TEST(SuddenStretch, RobotsWithoutAnchoring)
{
  for (const auto &[n, smallest, largest] :
       {std::tuple(2u, 0.7, 1.15), {4u, 0.555250014, 1.159486787}, {8u, 0.547676768, 1.176299357}})
    for (const char *accuracy : {"1e-2", "1e-4"})
      expect_stretch(robot(n, "1", accuracy), smallest, largest, 0.2 * std::stod(accuracy) + 1e-3);
}

/// The true ones are of runs at 1e-7, which know them to 1.2e-5.
TEST(SuddenStretch, Robots)
{
  for (const char *accuracy : {"1e-2", "1e-4"})
  {
    expect_stretch(robot(4, "2", accuracy), 0.548922, 1.160234, 1.1e-3);
    expect_stretch(robot(8, "2", accuracy), 0.537604, 1.177814, 1.1e-3);
    expect_stretch(robot(8, "3", accuracy), 0.528836, 1.180012, 1.1e-3);
  }
}

/// Energies of a stress m that is there at once, for a = 0 and k = gamma = L = 1: w - 1 = m (f - 1) with f the sine
/// series of 1, whose terms decay. The displacement is 0 and says nothing of the numerics.
TEST(SuddenStretch, EnergiesOfTheLinearLevel)
{
  constexpr double m = 0.3, t = 0.05, pi = std::numbers::pi;
  double mean = 0., mean_square = 0.; // of f
  for (int n = 1; n < 100; n += 2)
  {
    const double decay = std::exp(-n * n * pi * pi * t), part = 8. / (n * n * pi * pi);
    mean += part * decay;
    mean_square += part * decay * decay;
  }
  const double work = m * m * (1. - mean), elastic = 0.5 * m * m * (1. - 2. * mean + mean_square);
  for (const char *accuracy : {"1e-2", "1e-4", "1e-5", "1e-8"})
  {
    const SimulationResult result =
      answer_to(test::set("Model = linear; p = 1; T = 0.05; Accuracy = {}; expression; Active stress = 0.3", accuracy));
    ASSERT_EQ(result.time.status, Status::finished) << accuracy << ": " << result.time.message;
    const EnergyBalance &energies = result.energy_balance.value();
    const double tolerance        = std::stod(accuracy) * work;
    EXPECT_NEAR(energies.stress_work, work, tolerance) << accuracy;
    EXPECT_NEAR(energies.elastic_energy, elastic, tolerance) << accuracy;
    EXPECT_NEAR(energies.dissipation, work - elastic, tolerance) << accuracy;
  }
}

/// Pulses that begin within a body that does not move: its deformation chooses the numerics, with few steps also for a
/// small Accuracy, whatever is left of it at the end. True works are those of the linear level at 1e-9.
TEST(SuddenStretch, DeformationsOfABodyAtRestNeedFewSteps)
{
  for (const char *const stress : {"0.016*exp(-((s-0.58-1.7*t)/0.3)^2)", "0.03*exp(-20*t)", "0.06*sin(6*s+13*t*t)"})
  {
    const test::Settings settings = test::set("p = 1; k = 0.08; T = 3; expression; Active stress = {}", stress);
    const SimulationResult exact  = answer_to(test::with(settings, {{"Model", "linear"}, {"Accuracy", "1e-9"}}));
    for (const char *const accuracy : {"1e-5", "1e-7"})
    {
      const SimulationResult result = answer_to(test::with(settings, {{"Accuracy", accuracy}}));
      ASSERT_EQ(result.time.status, Status::finished) << stress << ": " << result.time.message;
      EXPECT_LT(result.time.steps, 500u) << stress;
      EXPECT_NEAR(result.energy_balance->stress_work,
                  exact.energy_balance->stress_work,
                  error_bound(result, "stress_power").value())
        << stress;
      EXPECT_LT(error_bound(result, "stress_power").value(),
                100. * std::stod(accuracy) * exact.energy_balance->stress_work)
        << stress;
    }
  }
}
