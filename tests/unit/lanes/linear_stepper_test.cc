// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The linear level against closed forms. With L = gamma = 1 and a = 0, zeta_t = m_s + k zeta_ss, w - 1 = -m/k at the
// ends; for m = A(t) sin(pi j s), which vanishes there, u = U(t) cos(pi j s) with U' = pi j A - k (pi j)^2 U, U(0) = 0.
#include "../../support/observed_order.h"
#include "../../support/run_text.h"

#include <crawler/equation/general_position_form.h>
#include <crawler/lanes/linear_stepper.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace crawler;

namespace
{
  using std::numbers::pi;

  Parameters
  linear(const std::string &formula, const double end_time = 1., const double k = 1., test::Settings more = {})
  {
    test::Settings settings = {{"Model", "linear"},
                               {"Body/Anchoring exponent", "1"},
                               {"Body/Elastic modulus", test::text(k)},
                               {"Active stress/Generator", "expression"},
                               {"Active stress/Expression/Active stress", formula},
                               {"Time/End time", test::text(end_time)}};
    settings.insert(settings.end(), more.begin(), more.end());
    return test::parameters_with(settings);
  }

  /// U(t) for A(t) = amplitude sin(omega t).
  double
  driven(const double amplitude, const double omega, const double k, const double t, const int j = 1)
  {
    const double q = pi * j, r = k * q * q;
    return q * amplitude * (r * std::sin(omega * t) - omega * std::cos(omega * t) + omega * std::exp(-r * t)) /
           (r * r + omega * omega);
  }

  struct FixedRun
  {
    std::vector<double> u; ///< at the nodes of this rank, at the end
    unsigned int n_factorizations;
    TimeOutcome outcome;
  };

  /// n equal steps over [0, 1] on so fine a mesh that only the error in time is left.
  FixedRun
  with_fixed_steps(const std::string &formula, const unsigned int n_stages, const double n)
  {
    const Scene scene = linear(formula).create_scene();
    const Discretization mesh(MPI_COMM_WORLD, 1., 12, 8);
    const auto form = create_position_form(scene, mesh);
    LinearStepper stepper(*form, n_stages, /*adaptive=*/false);
    FixedRun run;
    run.u.assign(mesh.n_owned(), 0.);
    run.outcome          = stepper.solve(run.u, {}, 1e-6, 1. / n, {}, 0.);
    run.n_factorizations = stepper.n_factorizations();
    return run;
  }

  /// The largest difference of u and U cos(pi s) over all ranks.
  double
  error_of(const FixedRun &run, const double U)
  {
    const Discretization mesh(MPI_COMM_WORLD, 1., 12, 8);
    std::vector<double> s = mesh.points(mesh.element().nodes), owned(mesh.n_owned());
    double worst          = 0.;
    const unsigned int n = mesh.element().n, q = mesh.element().degree, skip = mesh.has_left_neighbour() ? 1 : 0;
    for (unsigned int c = 0; c < mesh.n_local_cells(); ++c)
      for (unsigned int i = 0; i < n; ++i)
        if (c * q + i >= skip)
          worst = std::max(worst, std::abs(run.u[c * q + i - skip] - U * std::cos(pi * s[c * n + i])));
    MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return worst;
  }
} // namespace

TEST(LinearStepper, OrdersInTime)
{
  for (const auto &[n_stages, numbers] :
       std::vector<std::pair<unsigned int, std::vector<double>>>{{3, {16., 32., 64., 128.}}, {5, {4., 8., 16.}}})
  {
    std::vector<double> errors;
    for (const double n : numbers)
      errors.push_back(error_of(with_fixed_steps("0.3*sin(7*t)*sin(pi*s)", n_stages, n), driven(0.3, 7., 1., 1.)));
    const double order = test::observed_order(numbers, errors);
    fmt::print("{} stages: errors {:.2e} to {:.2e}, order {:.2f}\n", n_stages, errors.front(), errors.back(), order);
    EXPECT_GT(order, 2. * n_stages - 1. - 0.35);
    EXPECT_LT(errors.back(), 1e-9);
  }
}

TEST(LinearStepper, FactorizesOnce)
{
  const FixedRun run = with_fixed_steps("0.3*sin(7*t)*sin(pi*s)", 5, 32.);
  EXPECT_EQ(run.outcome.status, Status::finished);
  EXPECT_EQ(run.outcome.steps, 32u);
  EXPECT_EQ(run.outcome.newton_iterations, 0u);
  EXPECT_EQ(run.n_factorizations, 1u);
}

/// Steps are of equal size as long as the error allows it.
TEST(LinearStepper, AdaptiveStepsHaveFewSizes)
{
  const Scene scene = linear("0.3*sin(40*t)*exp(-(6*t-3)^2)*sin(pi*s)").create_scene();
  const Discretization mesh(MPI_COMM_WORLD, 1., 6, 6);
  const auto form = create_position_form(scene, mesh);
  LinearStepper stepper(*form, 5, /*adaptive=*/true);
  std::vector<double> u(mesh.n_owned(), 0.), times;
  stepper.monitor = [&](const Step &step, const auto) {
    if (step.is_output_time)
      times.push_back(step.time);
    return true;
  };
  const std::vector<double> output_times = {0.2, 0.4, 0.6, 0.8, 1.};
  const auto outcome                     = stepper.solve(u, output_times, 1e-10, 0.01, {}, 0.);
  EXPECT_EQ(outcome.status, Status::finished);
  EXPECT_EQ(times, output_times);
  fmt::print("{} steps, {} factorizations\n", outcome.steps, stepper.n_factorizations());
  EXPECT_LE(2 * stepper.n_factorizations(), outcome.steps);
}

/// Modes on the whole path: Accuracy is about u here.
TEST(LinearLevel, ClosedForm)
{
  for (const double k : {0.05, 1., 20.})
    for (const double accuracy : {1e-3, 1e-6, 1e-9})
    {
      const auto outcome =
        test::run_with(linear(test::text(0.3 * std::min(std::max(k, 0.3), 3.)) + "*sin(7*t)*sin(2*pi*s)",
                              1.3,
                              k,
                              {{"Accuracy", test::text(accuracy)}}));
      ASSERT_EQ(outcome.result.time.status, Status::finished);
      EXPECT_TRUE(outcome.choice.numerics.linear);
      const double U = driven(0.3 * std::min(std::max(k, 0.3), 3.), 7., k, 1.3, 2);
      EXPECT_NEAR(outcome.result.energy_balance->elastic_energy,
                  0.25 * k * 4. * pi * pi * U * U,
                  20. * accuracy * 0.25 * k * 4. * pi * pi * U * U + 1e-14);
      EXPECT_LT(std::abs(outcome.result.displacement), 1e-14);
      EXPECT_EQ(outcome.result.time.newton_iterations, 0u);
    }
}

/// A stress that does not change in time: u goes to -int m/k, the stretch to 1 - m/k.
TEST(LinearLevel, SteadyState)
{
  const auto result = test::run_with(linear("0.3*sin(pi*s)+0.1", 40., 1., {{"Accuracy", "1e-9"}})).result;
  EXPECT_NEAR(result.energy_balance->elastic_energy, 0.5 * (0.5 * 0.09 + 2. * 0.3 * 0.1 * 2. / pi + 0.01), 1e-10);
  EXPECT_NEAR(result.min_stretch.value, 0.6, 1e-6);
  EXPECT_LT(std::abs(result.displacement), 1e-13);
  EXPECT_LT(result.energy_balance->residual(), 2e-9);
  EXPECT_LT(result.net_friction, 1e-9);
}

/// The same equation as the nonlinear level at a = 0: all that is reported agrees.
TEST(LinearLevel, EqualsTheNonlinearLevel)
{
  auto settings = test::wave(0., 0.4, 1., 1.);
  settings.insert(settings.end(),
                  {{"Active stress/Generator", "expression"},
                   {"Active stress/Expression/Active stress", "0.3*sin(2*pi*(s+t))*exp(s)"},
                   {"Accuracy", "1e-8"}});
  const auto nonlinear = test::run_with(settings).result;
  settings.emplace_back("Model", "linear");
  const auto result = test::run_with(settings).result;
  ASSERT_EQ(nonlinear.time.status, Status::finished);
  ASSERT_EQ(result.time.status, Status::finished);
  EXPECT_NEAR(result.energy_balance->stress_work / nonlinear.energy_balance->stress_work, 1., 1e-7);
  EXPECT_NEAR(result.energy_balance->dissipation / nonlinear.energy_balance->dissipation, 1., 1e-7);
  EXPECT_NEAR(result.energy_balance->elastic_energy / nonlinear.energy_balance->elastic_energy, 1., 1e-7);
  EXPECT_NEAR(result.min_stretch.value, nonlinear.min_stretch.value, 1e-4);
  EXPECT_NEAR(result.displacement, nonlinear.displacement, 1e-13);
  EXPECT_LT(result.energy_balance->residual(), 1e-7);
}

/// Other units, several output times, and cycles that repeat.
TEST(LinearLevel, CyclesRepeat)
{
  const auto parameters = linear("0.3*sin(2*pi*t)*sin(pi*s)", 30., 1., {{"Accuracy", "1e-7"}});
  const Scene scene     = parameters.create_scene();
  const auto cycles =
    test::run_with(parameters,
                   {.energy_balance = true, .cycles = cycle_wish(parameters, scene, /*has_pictures=*/false)})
      .result;
  const auto full = test::run_with(parameters).result;
  ASSERT_TRUE(cycles.cycles);
  EXPECT_NEAR(cycles.energy_balance->stress_work / full.energy_balance->stress_work, 1., 1e-5);
  EXPECT_LT(cycles.time.steps, full.time.steps);
}
