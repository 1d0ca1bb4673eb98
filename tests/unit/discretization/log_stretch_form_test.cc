// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"

#include <crawler/discretization/log_stretch_form.h>
#include <crawler/discretization/mesh_transfer.h>
#include <crawler/discretization/position_form.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace crawler;

namespace
{
  const std::vector<double> exponents     = {-20, -3, -1.5, -1, 0, 0.5, 1, 2, 20};
  const std::vector<unsigned int> degrees = {1, 2, 4};
  constexpr double t                      = 0.3;

  std::size_t
  offset(const std::span<const double> part, const std::vector<double> &y)
  {
    return static_cast<std::size_t>(part.data() - y.data());
  }

  /// The log-stretch form on three cells, in a state with stretches between about 0.6 and 1.4.
  struct Case
  {
    Case(const double a, const unsigned int degree, const unsigned int n_cells = 3)
      : scene(test::parameters_with(test::wave(a, 0.3)).create_scene())
      , d(MPI_COMM_SELF, 1., n_cells, degree)
      , form(scene, d)
    {
      const PositionForm position(scene, d);
      const auto &element = d.element();
      std::vector<double> u(d.n_unknowns());
      for (unsigned int c = 0; c < n_cells; ++c)
        for (unsigned int i = 0; i < element.n; ++i)
        {
          const double s            = d.cell_left()[c] + d.cell_size()[c] * element.nodes[i];
          u[c * element.degree + i] = 0.06 * std::sin(5. * s) + 0.02 * s * s;
        }
      y = MeshTransfer(element).transfer(position, u, form);
      // Not 0: the friction of degree 1 has kinks there.
      for (std::size_t i = 0, n = d.n_unknowns(); i < n; ++i)
        y[y.size() - n + i] = (i % 3 == 1 ? -0.1 : 0.2) * (1. + 0.1 * static_cast<double>(i));
      y_dot.resize(form.n_owned());
      for (std::size_t i = 0; i < y_dot.size(); ++i)
        y_dot[i] = 0.1 * std::cos(0.9 * static_cast<double>(i)) - 0.03;
    }

    /// The change of the state in the motion with the velocity @p v: u' = v and (log w)' = v_s/w.
    std::vector<double>
    motion(const std::vector<double> &v) const
    {
      const auto &element  = d.element();
      const unsigned int q = element.degree;
      const auto log_w     = form.log_stretch(y);
      std::vector<double> rate(y.size(), 0.);
      std::copy(v.begin(), v.end(), rate.begin() + static_cast<std::ptrdiff_t>(offset(form.displacement(y), y)));
      for (unsigned int c = 0; c < d.n_cells(); ++c)
        for (unsigned int p = 0; p < q; ++p)
        {
          double v_s = 0.;
          for (unsigned int i = 0; i < element.n; ++i)
            v_s += element.stretch_derivatives[p * element.n + i] * v[c * q + i] / d.cell_size()[c];
          rate[offset(log_w, y) + c * q + p] = v_s / std::exp(log_w[c * q + p]);
        }
      return rate;
    }

    std::vector<double>
    residual(const std::vector<double> &direction, const double step, const double sigma)
    {
      std::vector<double> x = y, x_dot = y_dot, F(y.size());
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        x[i] += step * direction[i];
        x_dot[i] += sigma * step * direction[i];
      }
      EXPECT_TRUE(form.residual(t, x, x_dot, F));
      return F;
    }

    Scene scene;
    Discretization d;
    LogStretchForm form;
    std::vector<double> y, y_dot;
  };

  double
  largest(const std::vector<double> &x)
  {
    double result = 0.;
    for (const double value : x)
      result = std::max(result, std::abs(value));
    return result;
  }
} // namespace

/// Entry by entry, relative to the largest of each row.
TEST(LogStretchForm, JacobianMatchesDifferences)
{
  constexpr double sigma = 37., e = 1e-5;
  for (const double a : exponents)
    for (const unsigned int q : degrees)
    {
      Case test(a, q);
      const std::size_t n = test.form.n_owned();
      ASSERT_EQ(n, test.y.size());
      ASSERT_TRUE(test.form.setup_jacobian(t, test.y, test.y_dot, sigma));
      std::vector<double> largest_of_row(n, 0.), error_of_row(n, 0.);
      for (std::size_t j = 0; j < n; ++j)
      {
        std::vector<double> x(n, 0.), Jx(n);
        x[j] = 1.;
        test.form.jacobian_vmult(x, Jx);
        const auto plus = test.residual(x, e, sigma), minus = test.residual(x, -e, sigma),
                   plus_2 = test.residual(x, 2. * e, sigma), minus_2 = test.residual(x, -2. * e, sigma);
        for (std::size_t i = 0; i < n; ++i)
        {
          const double slope = (8. * (plus[i] - minus[i]) - (plus_2[i] - minus_2[i])) / (12. * e);
          largest_of_row[i]  = std::max(largest_of_row[i], std::abs(slope));
          error_of_row[i]    = std::max(error_of_row[i], std::abs(slope - Jx[i]));
        }
      }
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_LE(error_of_row[i], 1e-7 * largest_of_row[i]) << "a = " << a << ", degree " << q << ", row " << i;
    }
}

TEST(LogStretchForm, SolutionInvertsTheProduct)
{
  for (const double a : exponents)
    for (const unsigned int q : degrees)
      for (const double sigma : {37., 1e6})
      {
        Case test(a, q);
        ASSERT_TRUE(test.form.setup_jacobian(t, test.y, test.y_dot, sigma));
        std::vector<double> x(test.y.size()), b(x), back(x);
        for (std::size_t i = 0; i < x.size(); ++i)
          x[i] = std::sin(40. * static_cast<double>(i) + 0.3);
        test.form.jacobian_vmult(x, b);
        test.form.solve_with_jacobian(b, back);
        test.form.solve_with_jacobian(b, b); // one vector for both
        EXPECT_EQ(b, back);
        for (std::size_t i = 0; i < x.size(); ++i)
          back[i] -= x[i];
        EXPECT_LE(largest(back), 1e-10) << "a = " << a << ", degree " << q << ", sigma " << sigma;
      }
}

/// The velocity of a state balances the friction and the powers, both to round-off, for every a.
TEST(LogStretchForm, IdentitiesOfAState)
{
  for (const double a : exponents)
    for (const unsigned int q : degrees)
    {
      Case test(a, q, 5);
      std::vector<double> v(test.d.n_owned());
      ASSERT_TRUE(test.form.velocity(t, test.y, v));
      const CellIntegrals sum = test.form.integrals(t, test.y, v);
      EXPECT_LE(std::abs(sum.net_friction), 1e-13 * sum.abs_friction) << "a = " << a << ", degree " << q;
      // stress power = dissipation + d/dt elastic energy, the latter by differences along the motion
      const std::vector<double> rates = test.motion(v);
      const double e                  = 1e-4 / largest(rates);
      const auto energy               = [&](const double step)
      {
        std::vector<double> y = test.y;
        for (std::size_t i = 0; i < y.size(); ++i)
          y[i] += step * rates[i];
        return test.form.integrals(t, y, v).elastic_energy;
      };
      const double rate = (8. * (energy(e) - energy(-e)) - (energy(2. * e) - energy(-2. * e))) / (12. * e);
      EXPECT_NEAR(sum.stress_power, sum.dissipation + rate, 1e-10 * (sum.absolute_power + sum.dissipation))
        << "a = " << a << ", degree " << q;
      EXPECT_GT(sum.dissipation, 0.);
      EXPECT_GE(sum.positive_power, sum.stress_power);
    }
}

/// Degree 1: at a node that moves from a full cell to an empty one the mobilities 1/g are averaged, otherwise g.
TEST(LogStretchForm, EmptyCellsCanBeRefilled)
{
  Case test(-1., 1, 2);
  const std::size_t first_log = offset(test.form.log_stretch(test.y), test.y);
  test.y[first_log]           = std::log(1e-6);
  test.y[first_log + 1]       = 0.;
  std::vector<double> v(test.d.n_owned());
  const auto dissipation = [&](const double middle)
  {
    v = {0., middle, 0.};
    return test.form.integrals(t, test.y, v).dissipation;
  };
  EXPECT_NEAR(dissipation(1.), 0.5 * 2. / (1e-6 + 1.), 1e-12);        // length goes to the left, to the empty cell
  EXPECT_NEAR(dissipation(-1.) / (0.5 * (1e6 + 1.) / 2.), 1., 1e-12); // the empty cell gives length away
}

/// Where the position form has only round-off left of the stretch, this form still has all its digits.
TEST(LogStretchForm, KeepsTheDigitsOfASmallStretch)
{
  Case test(-1., 2);
  const std::size_t first_log = offset(test.form.log_stretch(test.y), test.y);
  test.y[first_log + 2] = test.y[first_log + 3] = -50.;
  const StretchRange range                      = test.form.stretch_range(test.y);
  EXPECT_NEAR(range.min.value / std::exp(-50.), 1., 1e-12);
  EXPECT_GE(range.min.s, 1. / 3. - 1e-12);
  EXPECT_LE(range.min.s, 2. / 3. + 1e-12);
  std::vector<double> F(test.y.size());
  EXPECT_TRUE(test.form.residual(t, test.y, test.y_dot, F));
  for (const double value : F)
    EXPECT_TRUE(std::isfinite(value));
}
