// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Extreme stretches after the active stress starts or jumps suddenly, where polynomials overshoot (doc/numerics.md,
// "Extremes after sudden changes"): exact ones for a = 0, where v = w + m/k solves the heat equation with v = 1 at the
// ends, and those of finer and finer runs.
#include "../support/answers.h"
#include "../support/test.h"

#include <crawler/run/result_table.h>
#include <crawler/scene/breaks.h>

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
    EXPECT_LE(std::abs(result.min_stretch.value - smallest), error_bound(result, "min_stretch.value").value()) << what;
    EXPECT_LE(std::abs(result.max_stretch.value - largest), error_bound(result, "max_stretch.value").value()) << what;
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

  /// The heat equation v_t = (k/gamma) v_ss for a stress that is constant between its breaks in space and time, by a
  /// sine series about v = 1.
  class ExactStretch
  {
  public:
    explicit ExactStretch(const Scene &scene)
      : k_(scene.body.elastic_modulus)
      , diffusivity_(k_ / scene.body.friction_coefficient)
      , edges_(scene.breaks_in_space())
      , heights_(n_modes, 0.)
    {
      edges_.insert(edges_.begin(), 0.);
      edges_.push_back(1.);
      std::vector<double> middles;
      for (std::size_t i = 0; i + 1 < edges_.size(); ++i)
        middles.push_back(0.5 * (edges_[i] + edges_[i + 1]));
      std::vector<double> times = TimeSegments(*scene.active_stress, scene.end_time).breaks();
      times.insert(times.begin(), 0.);
      times.push_back(scene.end_time);
      const auto stress = scene.active_stress->at(middles);
      std::vector<double> m(middles.size(), 0.), before = m;
      for (std::size_t j = 0; j + 1 < times.size(); ++j)
      {
        stress->values(0.5 * (times[j] + times[j + 1]), m);
        begin(before, m);
        go_on(m, times[j + 1] - times[j]);
        before = m;
      }
    }

    double smallest = 1., largest = 1.;

  private:
    static constexpr unsigned int n_modes = 3000;

    void
    see(const double w)
    {
      smallest = std::min(smallest, w);
      largest  = std::max(largest, w);
    }

    double
    v(const double s, const double after) const
    {
      double sum = 1.;
      for (unsigned int n = 1; n <= n_modes && decay(n, after) > 1e-20; ++n)
        sum += heights_[n - 1] * decay(n, after) * std::sin(n * std::numbers::pi * s);
      return sum;
    }

    double
    decay(const unsigned int n, const double time) const
    {
      return std::exp(-diffusivity_ * std::pow(n * std::numbers::pi, 2) * time);
    }

    /// The stress jumps, and v with it; at its jumps in space v is then the mean of both sides.
    void
    begin(const std::vector<double> &before, const std::vector<double> &m)
    {
      constexpr double shortest = 1e-5; // the series shows v where it is smooth
      for (std::size_t i = 1; i + 1 < edges_.size(); ++i)
      {
        const double here = v(edges_[i], shortest) + 0.5 * (m[i - 1] - before[i - 1] + m[i] - before[i]) / k_;
        see(here - m[i - 1] / k_);
        see(here - m[i] / k_);
      }
      for (std::size_t i = 0; i < m.size(); ++i)
        for (unsigned int n = 1; n <= n_modes; ++n)
        {
          const double y = n * std::numbers::pi;
          heights_[n - 1] += 2. * (m[i] - before[i]) / k_ * (std::cos(y * edges_[i]) - std::cos(y * edges_[i + 1])) / y;
        }
    }

    void
    go_on(const std::vector<double> &m, const double duration)
    {
      constexpr unsigned int n_times = 40, n_places = 8;
      for (unsigned int j = 1; j <= n_times; ++j)
        for (std::size_t i = 0; i < m.size(); ++i)
          for (unsigned int l = 0; l <= n_places; ++l)
          {
            const double s = edges_[i] + (edges_[i + 1] - edges_[i]) * l / n_places;
            see(v(s, duration * j * j / (n_times * n_times)) - m[i] / k_);
          }
      for (unsigned int n = 1; n <= n_modes; ++n)
        heights_[n - 1] *= decay(n, duration);
    }

    const double k_, diffusivity_;
    std::vector<double> edges_, heights_;
  };
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

TEST(SuddenStretch, RobotsWithoutAnchoring)
{
  for (const unsigned int n : {2u, 4u, 8u})
  {
    const ExactStretch exact(test::parameters_with(robot(n, "1", "1e-2")).create_scene());
    for (const char *accuracy : {"1e-2", "1e-4"})
      expect_stretch(robot(n, "1", accuracy), exact.smallest, exact.largest, 0.2 * std::stod(accuracy) + 1e-3);
  }
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
