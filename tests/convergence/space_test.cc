// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Required orders in space: 2q in the displacement, q + 1 in the L2 norm of the position; the stretch form is one of
// degree 1.
#include "../support/observed_order.h"
#include "../support/run_text.h"
#include "../support/test.h"

#include <crawler/output/field_sampler.h>

using namespace crawler;

namespace
{
  constexpr double end_time = 0.3;

  /**
   * Exact solution of the whole equation for a = +1, gamma = k = L = 1: the strain
   *   e = E (sin 2 pi (s+t) - sin 2 pi s),
   * which belongs to the velocity v = E sin 2 pi (s+t) - d with d = (E^2/2)(1 - cos 2 pi t), since then <(1+e) v> = 0,
   * and to the active stress m = int_0^s (1+e) v ds - k e (doc/theory.md, kinematic level).
   */
  struct ExactSolution
  {
    double E = 0.2;

    /// Displacement of the centre of mass.
    double
    displacement(const double t) const
    {
      return -0.5 * E * E * (t - std::sin(2. * std::numbers::pi * t) / (2. * std::numbers::pi));
    }
    double
    u(const double s, const double t) const
    {
      constexpr double q = 2. * std::numbers::pi;
      return -E / q * (std::cos(q * (s + t)) - std::cos(q * s)) + displacement(t);
    }

    /// Settings of the scene, with the active stress as a formula.
    test::Settings
    settings() const
    {
      const std::string d = "(E^2/2*(1-cos(q*t)))";
      return {{"Body/Anchoring exponent", "0"},
              {"Active stress/Generator", "expression"},
              {"Active stress/Expression/Constants", "E=" + test::text(E) + ", q=" + test::text(2. * std::numbers::pi)},
              {"Active stress/Expression/Active stress",
               "E*(cos(q*t)-cos(q*(s+t)))/q - " + d + "*s + E^2*(s/2-(sin(2*q*(s+t))-sin(2*q*t))/(4*q)) - E*" + d +
                 "*(cos(q*t)-cos(q*(s+t)))/q - E^2*(s*cos(q*t)/2-(sin(2*q*s+q*t)-sin(q*t))/(4*q)) + E*" + d +
                 "*(1-cos(q*s))/q - E*(sin(q*(s+t))-sin(q*s))"},
              {"Time/End time", test::text(end_time)}};
    }
  };

  /// L2 error of a state.
  double
  l2_error(const Snapshot &snapshot)
  {
    const ReferenceElement fine(8);
    const Discretization &d = snapshot.assembler.discretization;
    std::vector<CellPlace> points;
    for (unsigned int c = 0; c < d.n_local_cells(); ++c)
      for (const double x : fine.points)
        points.push_back({c, x});
    FieldSampler sampler([&](const Discretization &) { return points; });
    const Fields &fields = sampler.sample(snapshot);
    double sum           = 0.;
    for (unsigned int c = 0; c < d.n_local_cells(); ++c)
      for (unsigned int p = 0; p < fine.n; ++p)
      {
        const std::size_t i = static_cast<std::size_t>(c) * fine.n + p;
        const double error  = fields.displacement[i] - ExactSolution().u(sampler.coordinates()[i], snapshot.step.time);
        sum += snapshot.units.length * d.cell_size[c] * fine.weights[p] * error * error;
      }
    return std::sqrt(sum);
  }

  class Space : public ::testing::TestWithParam<std::tuple<Formulation, unsigned int, std::string>>
  {
  };
} // namespace

TEST_P(Space, OrderOnAnExactSolution)
{
  const auto [formulation, q, engine] = GetParam();
  // Meshes in the asymptotic range and errors above those of time and rounding.
  const std::vector<std::vector<unsigned int>> meshes = {
    {}, {32, 64, 128}, {8, 16, 32}, {6, 10, 16}, {6, 8, 10}, {3, 4, 5, 6}, {2, 3, 4}};
  const ExactSolution exact;
  std::vector<double> cells, displacement_errors, l2_errors;
  for (const unsigned int n : meshes[q])
  {
    const std::string integrator = formulation == Formulation::stretch ? "radau 5"
                                   : engine == "petsc"                 ? "bdf"
                                                                       : "radau 9";
    const Parameters parameters  = test::parameters_with(test::with(exact.settings(), "integrator = {}", integrator));
    const Scene scene            = parameters.create_scene();
    Simulation simulation(
      MPI_COMM_WORLD,
      scene,
      parameters.time,
      {.degree = q, .n_cells = n, .tolerance = 1e-13, .initial_step = 1e-6, .formulation = formulation});
    double l2                     = 0.; // of the last state
    const auto observers          = watched_by([&](const Snapshot &snapshot) { l2 = l2_error(snapshot); });
    const SimulationResult result = simulation.run({}, {}, observers);
    ASSERT_EQ(result.time.status, Status::finished);
    ASSERT_EQ(result.process.engine, engine);
    cells.push_back(n);
    displacement_errors.push_back(std::abs(result.displacement - exact.displacement(end_time)));
    l2_errors.push_back(l2);
  }
  const std::string degree     = "degree " + std::to_string(q);
  const double in_displacement = test::observed_order(degree + " in the displacement", cells, displacement_errors),
               in_l2           = test::observed_order(degree + " in L2", cells, l2_errors);
  EXPECT_GE(in_displacement, 2. * q - 0.3);
  EXPECT_GE(in_l2, q + 1. - 0.2);
}

// Degree 6 needs the smaller errors in time of radau 9.
INSTANTIATE_TEST_SUITE_P(Petsc,
                         Space,
                         ::testing::Combine(::testing::Values(Formulation::position),
                                            ::testing::Values(1u, 2u, 3u, 4u, 5u),
                                            ::testing::Values("petsc")));
INSTANTIATE_TEST_SUITE_P(Fused,
                         Space,
                         ::testing::Combine(::testing::Values(Formulation::position),
                                            ::testing::Values(1u, 2u, 3u, 4u, 5u, 6u),
                                            ::testing::Values("fused")));
INSTANTIATE_TEST_SUITE_P(Stretch, Space, ::testing::Values(std::tuple(Formulation::stretch, 1u, "fused")));
