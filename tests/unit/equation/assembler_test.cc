// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"

#include <crawler/equation/position_form.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace crawler;

namespace
{
  const std::vector<double> exponents = {-20, -3, -1.5, -1, 0, 0.5, 1, 2, 20};

  /// A state with stretches between about 0.6 and 1.4, and a velocity.
  struct State
  {
    explicit State(const Discretization &d)
    {
      const auto &element = d.element();
      u.resize(d.n_unknowns());
      v.resize(d.n_unknowns());
      for (unsigned int c = 0; c < d.n_cells(); ++c)
        for (unsigned int i = 0; i < element.n; ++i)
        {
          const double s            = d.cell_left()[c] + d.cell_size()[c] * element.nodes[i];
          u[c * element.degree + i] = 0.06 * std::sin(5. * s) + 0.02 * s * s;
          v[c * element.degree + i] = 0.3 * std::cos(4. * s) - 0.1;
        }
    }
    std::vector<double> u, v;
  };
} // namespace

TEST(PositionForm, JacobianMatchesDifferences)
{
  const double t = 0.3, sigma = 37.;
  for (const double a : exponents)
    for (const unsigned int q : {1u, 4u, 8u})
    {
      const Scene scene = test::parameters_with(test::wave(a, 0.3)).create_scene();
      const Discretization d(MPI_COMM_SELF, 1., 3, q);
      PositionForm assembler(scene, d);
      BlockTridiagonalMatrix<double> J(d);
      const State state(d);
      assembler.jacobian(t, state.u, state.v, sigma, J);

      // A smooth direction and a rough one; differences along x: u + e x, v + sigma e x.
      for (const double roughness : {1., 40.})
      {
        std::vector<double> x(d.n_unknowns()), Jx(x.size()), plus(x.size()), minus(x.size()), plus_2(x.size()),
          minus_2(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
          x[i] = std::sin(roughness * static_cast<double>(i) + 0.3);
        J.multiply(x, Jx);
        const double e     = 1e-5;
        const auto shifted = [&](const double sign, std::vector<double> &F) {
          std::vector<double> u = state.u, v = state.v;
          for (std::size_t i = 0; i < x.size(); ++i)
          {
            u[i] += sign * e * x[i];
            v[i] += sign * e * sigma * x[i];
          }
          ASSERT_TRUE(assembler.residual(t, u, v, F));
        };
        shifted(1., plus);
        shifted(-1., minus);
        shifted(2., plus_2);
        shifted(-2., minus_2);
        double error = 0., norm = 0.;
        for (std::size_t i = 0; i < x.size(); ++i)
        {
          const double slope = (8. * (plus[i] - minus[i]) - (plus_2[i] - minus_2[i])) / (12. * e);
          error              = std::max(error, std::abs(slope - Jx[i]));
          norm               = std::max(norm, std::abs(Jx[i]));
        }
        EXPECT_LT(error / norm, 1e-7) << "a = " << a << ", degree " << q << ", roughness " << roughness;
      }
    }
}

/// The velocity of a state balances the friction and satisfies the equation; both to round-off, for every a.
TEST(PositionForm, IdentitiesOfAState)
{
  const double t = 0.3;
  for (const double a : exponents)
  {
    const Scene scene = test::parameters_with(test::wave(a, 0.3)).create_scene();
    const Discretization d(MPI_COMM_SELF, 1., 5, 4);
    PositionForm assembler(scene, d);
    const State state(d);
    std::vector<double> v(d.n_unknowns()), F(d.n_unknowns());
    ASSERT_TRUE(assembler.velocity(t, state.u, v));
    ASSERT_TRUE(assembler.residual(t, state.u, v, F));
    double largest = 0.;
    for (const double value : F)
      largest = std::max(largest, std::abs(value));
    EXPECT_LT(largest, 1e-12) << a;
    const CellIntegrals sum = assembler.integrals(t, state.u, v);
    EXPECT_LT(std::abs(sum.net_friction), 1e-13 * sum.abs_friction) << a;
    // stress power = dissipation + d/dt elastic energy, the latter by differences along v
    const double e           = 1e-5;
    std::vector<double> plus = state.u, minus = state.u;
    for (std::size_t i = 0; i < v.size(); ++i)
    {
      plus[i] += e * v[i];
      minus[i] -= e * v[i];
    }
    const double rate =
      (assembler.integrals(t, plus, v).elastic_energy - assembler.integrals(t, minus, v).elastic_energy) / (2. * e);
    EXPECT_NEAR(sum.stress_power, sum.dissipation + rate, 1e-10 * (sum.absolute_power + sum.dissipation)) << a;
    EXPECT_GT(sum.dissipation, 0.);
    EXPECT_GE(sum.positive_power, sum.stress_power);
  }
}

TEST(PositionForm, ReportsAStretchThatIsNotPositive)
{
  const Scene scene = test::parameters_with(test::wave(-1., 0.3)).create_scene();
  const Discretization d(MPI_COMM_SELF, 1., 10, 2);
  PositionForm assembler(scene, d);
  std::vector<double> u(d.n_unknowns(), 0.), v(u), F(u);
  EXPECT_TRUE(assembler.residual(0., u, v, F));
  // Cell 6 (0.6 to 0.7) is folded over.
  for (std::size_t i = 14; i < u.size(); ++i)
    u[i] = -0.15;
  u[13] = -0.075;
  EXPECT_FALSE(assembler.residual(0., u, v, F));
  const StretchRange range = assembler.stretch_range(u);
  EXPECT_NEAR(range.min.value, -0.5, 1e-12);
  EXPECT_NEAR(range.max.value, 1., 1e-12);
}

/// The mesh indicator vanishes for a strain that the elements hold exactly, and follows the highest mode.
TEST(PositionForm, ResolutionSeesTheHighestMode)
{
  const Scene scene = test::parameters_with(test::wave(-1., 0.3)).create_scene();
  const Discretization d(MPI_COMM_SELF, 1., 2, 3);
  PositionForm assembler(scene, d);
  std::vector<double> u(d.n_unknowns());
  const auto set = [&](auto function) {
    for (unsigned int c = 0; c < 2; ++c)
      for (unsigned int i = 0; i < 4; ++i)
        u[c * 3 + i] = function(d.cell_left()[c] + d.cell_size()[c] * d.element().nodes[i]);
  };
  set([](const double s) { return 0.1 * s * s; }); // linear strain, no second mode
  EXPECT_LT(assembler.resolution(u).highest_mode, 1e-25);
  EXPECT_NEAR(assembler.resolution(u).strain, 0.04 / 3., 1e-12);
  set([](const double s) { return 0.1 * s * s * s; });
  EXPECT_GT(assembler.resolution(u).highest_mode, 1e-8);
}
