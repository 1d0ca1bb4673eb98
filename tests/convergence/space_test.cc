// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Required orders in space: 2q in the displacement, q + 1 in the L2 norm of the position; the stretch form is one of
// degree 1.
#include "../support/exact_solution.h"
#include "../support/observed_order.h"

#include <crawler/output/field_sampler.h>

#include <gtest/gtest.h>

#include <tuple>

using namespace crawler;

namespace
{
  constexpr double end_time = 0.3;

  /// Keeps the last state's L2 error.
  class L2Error : public Observer
  {
  public:
    explicit L2Error(double &error)
      : error_(error)
    {
    }

    void
    observe(const Snapshot &snapshot) override
    {
      const Discretization &d = snapshot.assembler.discretization();
      if (!sampler_)
        sampler_ = std::make_unique<FieldSampler>(snapshot.assembler, snapshot.units, points(d));
      const Fields &fields = sampler_->sample(snapshot.computed_time, snapshot.y, snapshot.v);
      double sum           = 0.;
      const auto &exact    = test::ExactSolution();
      for (unsigned int c = 0; c < d.n_local_cells(); ++c)
        for (unsigned int p = 0; p < fine_.n; ++p)
        {
          const std::size_t i = static_cast<std::size_t>(c) * fine_.n + p;
          const double error  = fields.displacement[i] - exact.u(sampler_->coordinates()[i], snapshot.step.time);
          sum += snapshot.units.length * d.cell_size()[c] * fine_.weights[p] * error * error;
        }
      error_ = std::sqrt(sum);
    }

  private:
    std::vector<FieldSampler::Point>
    points(const Discretization &discretization) const
    {
      std::vector<FieldSampler::Point> result;
      for (unsigned int c = 0; c < discretization.n_local_cells(); ++c)
        for (const double x : fine_.points)
          result.push_back({c, x});
      return result;
    }

    const ReferenceElement fine_{8};
    std::unique_ptr<FieldSampler> sampler_;
    double &error_;
  };

  class Space : public ::testing::TestWithParam<std::tuple<Formulation, unsigned int>>
  {
  };
} // namespace

TEST_P(Space, OrderOnAnExactSolution)
{
  const auto [formulation, q] = GetParam();
  // Meshes in the asymptotic range and errors above those of time and rounding.
  const std::vector<std::vector<unsigned int>> meshes = {
    {}, {32, 64, 128}, {8, 16, 32}, {6, 10, 16}, {6, 8, 10}, {3, 4, 5, 6}};
  const test::ExactSolution exact;
  std::vector<double> cells, displacement_errors, l2_errors;
  for (const unsigned int n : meshes[q])
  {
    auto settings = exact.settings(end_time);
    settings.insert(settings.end(),
                    {{"Discretization/Degree", std::to_string(q)},
                     {"Discretization/Number of cells", std::to_string(n)},
                     {"Time/Integrator", formulation == Formulation::stretch ? "radau 5" : "automatic"},
                     {"Time/Tolerance", "1e-13"},
                     {"Time/Initial step", "1e-6"}});
    const Parameters parameters = test::parameters_with(settings);
    const Scene scene           = parameters.create_scene();
    Simulation simulation(
      MPI_COMM_WORLD,
      scene,
      parameters.time,
      {.degree = q, .n_cells = n, .tolerance = 1e-13, .initial_step = 1e-6, .formulation = formulation});
    double l2 = 0.;
    std::vector<std::unique_ptr<Observer>> observers;
    observers.push_back(std::make_unique<L2Error>(l2));
    const SimulationResult result = simulation.run({}, {}, observers);
    ASSERT_EQ(result.time.status, Status::finished);
    cells.push_back(n);
    displacement_errors.push_back(std::abs(result.displacement - exact.displacement(end_time)));
    l2_errors.push_back(l2);
    fmt::print(
      "degree {}, {:3} cells: displacement error {:.3e}, L2 error {:.3e}\n", q, n, displacement_errors.back(), l2);
  }
  const double in_displacement = test::observed_order(cells, displacement_errors),
               in_l2           = test::observed_order(cells, l2_errors);
  fmt::print("degree {}: observed order {:.2f} in the displacement (2q = {}), {:.2f} in L2 (q+1 = {})\n",
             q,
             in_displacement,
             2 * q,
             in_l2,
             q + 1);
  EXPECT_GE(in_displacement, 2. * q - 0.3);
  EXPECT_GE(in_l2, q + 1. - 0.2);
}

INSTANTIATE_TEST_SUITE_P(
  Position, Space, ::testing::Combine(::testing::Values(Formulation::position), ::testing::Values(1u, 2u, 3u, 4u, 5u)));
INSTANTIATE_TEST_SUITE_P(Stretch, Space, ::testing::Values(std::tuple(Formulation::stretch, 1u)));
