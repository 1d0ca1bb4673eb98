// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The equations of the stretch form in the fused engine, and their linear systems.
#include "../../support/derivative.h"
#include "../../support/features.h"
#include "../../support/test.h"

#define CRAWLER_PACK pack2 // of what is compiled here
#include <crawler/lanes/lane_states.h>
#include <crawler/lanes/lane_stretch.h>
#include <crawler/lanes/lane_tables.h>

using namespace crawler;
using test::Feature;
using test::largest;

namespace
{
  constexpr double t = 0.3, real_shift = 23., complex_shift[2] = {11., 7.};
  constexpr int pairs = 1;

  using System = generic::StretchSystem<double, pairs>;

  Feature
  plain(const double a)
  {
    return {"a = " + test::text(a), test::wave(a, 0.3)};
  }

  /// @p n cells of two sizes.
  std::vector<double>
  cell_ends_of(const int n)
  {
    std::vector<double> ends = {0.};
    for (int j = 0; j < n; ++j)
      ends.push_back(ends.back() + (j % 3 == 1 ? 1.7 : 1.));
    for (double &s : ends)
      s /= ends[n];
    return ends;
  }

  /// A body, its form and its state, and the system of the engine for it.
  struct Case : LawHost
  {
    explicit Case(const Feature &feature, const int n_cells = 8, const bool other = false)
      : scene(test::parameters_with(feature.settings).create_scene())
      , d(MPI_COMM_SELF, cell_ends_of(n_cells), 1)
      , form(scene, d, other)
      , stretch_laws(scene, d.points({0.5}))
      , n(n_cells)
      , y(n + 1)
      , y_dot(n + 1)
      , m(n)
    {
      setup.n_cells                = static_cast<unsigned int>(n);
      setup.sizes                  = d.cell_size.data();
      setup.method.real_eigenvalue = real_shift;
      setup.method.eigenvalues     = complex_shift;
      setup.is_stretch             = true;
      setup.laws                   = lane_laws(scene);
      setup.stretch                = stretch_method(scene, other);
      setup.direction              = scene.ground.direction;
      const double power           = 1. + scene.friction_exponent();
      for (int j = 0; j < n; ++j)
      {
        const double w = 1. + 0.35 * std::cos(5. * (j + 0.5) / n + 0.4);
        y[j]           = setup.stretch.is_power ? std::pow(w, power) / power : w;
      }
      scene.active_stress->at(d.points({0.5}))->values(t, m);
      // The rates of the form.
      std::vector<double> v(n + 1);
      EXPECT_TRUE(form.velocity(t, y, v));
      const auto w = form.stretch(y);
      for (int j = 0; j < n; ++j)
        y_dot[j] = (v[j + 1] - v[j]) / d.cell_size[j] * (setup.stretch.is_power ? std::pow(w[j], power - 1.) : 1.);
      y_dot[n] = v[0];
    }
    Case(const Case &) = delete;

    double
    evaluate_cells(const double time,
                   const double *known_m,
                   const double *w,
                   const double *rate,
                   CellLaws<double> &at_cells) override
    {
      const auto n_cells = static_cast<std::size_t>(n);
      EXPECT_LT(stretch_laws.evaluate(time, {w, n_cells}, {rate, n_cells}, known_m), 0);
      at_cells = stretch_laws.at_cells();
      return 1.;
    }

    Scene scene;
    Discretization d;
    StretchForm form;
    StretchLaws stretch_laws;
    const int n;
    std::vector<double> y, y_dot, m;
    LaneSetup setup{};
  };

  /// The system in its memory.
  struct Alone : Case
  {
    explicit Alone(const Feature &feature, const int n_cells = 8, const bool other = false)
      : Case(feature, n_cells, other)
      , system(setup)
    {
      generic::LaneMemory sizes(nullptr);
      system.lay_out(sizes);
      memory.resize(sizes.size());
      generic::LaneMemory pieces(memory.data());
      system.lay_out(pieces);
      system.set_body(0, {.k = scene.body.elastic_modulus, .a = scene.friction_exponent(), .host = this});
    }

    std::vector<double>
    residual(const std::vector<double> &by, const std::vector<double> &by_dot, const double step)
    {
      std::vector<double> x = y, x_dot = y_dot, F(y.size());
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        x[i] += step * by[i];
        x_dot[i] += step * by_dot[i];
      }
      EXPECT_GT(system.residual(&t, x.data(), x_dot.data(), m.data(), F.data()), 0.);
      return F;
    }

    /// The derivative of the residual.
    std::vector<double>
    slope(const std::vector<double> &by, const std::vector<double> &by_dot)
    {
      return test::derivative([&](const double step) { return residual(by, by_dot, step); });
    }

    System system;
    LaneStorage memory;
  };

  std::vector<Feature>
  all_features()
  {
    const std::vector<Feature> laws = test::laws();
    std::vector<Feature> list       = {{"profiles", test::with(laws[0].settings, laws[1].settings)},
                                       laws[3],
                                       {"feedback", test::feedback("0.3*sin(w)*(1+s)+0.1*sin(t)")},
                                       {"rate", test::feedback("0.2*w_t+0.1*tanh(w_t)*w")},
                                       test::all_of(laws, test::feedback("0.3*sin(w)*(1+s)+0.2*w_t*w+0.1*sin(t)"))};
    for (const double a : {-3., -1., -0.5, 0., 0.7, 2.})
      list.push_back(plain(a));
    return list;
  }

  std::vector<double>
  scattered(const std::size_t n, const double phase)
  {
    std::vector<double> result(n);
    for (std::size_t i = 0; i < n; ++i)
      result[i] = std::sin(12.9898 * static_cast<double>(i + 1) + phase);
    return result;
  }
} // namespace

/// The engine and the form say the same of a state, each with its own loops.
TEST(LaneStretch, TheVelocityOfTheFormIsTheSolution)
{
  for (const Feature &feature : all_features())
    for (const bool other : {false, true})
    {
      Alone test(feature, 8, other);
      EXPECT_GT(largest(test.y_dot), 0.1);
      EXPECT_LT(largest(test.residual(test.y, test.y, 0.)), 1e-10) << feature.name << (other ? ", other rule" : "");
    }
}

/// For x = (K + sigma M)^-1 b the derivative of F along (x, sigma x) is b: elimination and derivatives at once, for any
/// number of cells on both sides of the middle. The upwind rule is not tried: its derivatives leave out the third cell.
TEST(LaneStretch, SolutionsInvertTheDerivative)
{
  for (const Feature &feature : all_features())
    for (const bool other : {false, true})
      for (const int n : {2, 3, 4, 7, 8})
      {
        Alone test(feature, n, other);
        if (test.setup.stretch.node_rule == NodeRule::upwind)
          continue;
        const std::string which = feature.name + (other ? ", other rule" : "") + ", " + std::to_string(n) + " cells";
        test.system.factorize(&t, test.y.data(), test.y_dot.data(), test.m.data(), /*inverse_h=*/1.);
        const std::size_t size      = test.y.size();
        const std::vector<double> b = scattered(size, 0.3), re = scattered(size, 1.), im = scattered(size, 2.);
        std::vector<double> x = b, shifted(size);
        std::vector<generic::Complex<double>> z(size);
        for (std::size_t i = 0; i < size; ++i)
          z[i] = {re[i], im[i]};
        test.system.solve(x.data(), z.data());
        std::vector<double> alone = b;
        test.system.solve(alone.data());
        EXPECT_EQ(alone, x) << which;
        const auto expect = [&](const std::vector<double> &found, const std::vector<double> &expected) {
          for (std::size_t i = 0; i < size; ++i)
            EXPECT_NEAR(found[i], expected[i], 1e-8) << which << ", row " << i;
        };
        for (std::size_t i = 0; i < size; ++i)
          shifted[i] = real_shift * x[i];
        expect(test.slope(x, shifted), b);
        // (a + i c)(x + i y): the real and the imaginary part.
        for (std::size_t i = 0; i < size; ++i)
        {
          x[i]       = z[i].re;
          shifted[i] = complex_shift[0] * z[i].re - complex_shift[1] * z[i].im;
        }
        expect(test.slope(x, shifted), re);
        for (std::size_t i = 0; i < size; ++i)
        {
          x[i]       = z[i].im;
          shifted[i] = complex_shift[0] * z[i].im + complex_shift[1] * z[i].re;
        }
        expect(test.slope(x, shifted), im);
      }
}

/// The size of a vector in which one element is not a number is none, wherever that stands.
TEST(LaneStretch, WhatIsNotANumberStays)
{
  EXPECT_TRUE(std::isnan(generic::added</*largest=*/true>(std::numeric_limits<double>::quiet_NaN(), 1.)));
  EXPECT_TRUE(std::isnan(generic::added</*largest=*/true>(1., std::numeric_limits<double>::quiet_NaN())));
  EXPECT_EQ(generic::added</*largest=*/true>(1., 2.), 2.);
  EXPECT_EQ(generic::added</*largest=*/true>(2., 1.), 2.);
}
