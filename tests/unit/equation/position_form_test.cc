// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/derivative.h"
#include "../../support/features.h"
#include "../../support/test.h"

#include <crawler/equation/position_form.h>

using namespace crawler;
using test::Feature;
using test::largest;
using test::Settings;

namespace
{
  constexpr double t = 0.3;

  Settings
  feedback(const std::string &formula, const std::string &distance = "0.37", const std::string &sensor = "0")
  {
    return test::set(
      "strain feedback; Active stress = {}; Distance = {}; Sensor length = {}; Delay = 0.1", formula, distance, sensor);
  }

  /// Each new term alone, and all together.
  std::vector<Feature>
  features()
  {
    std::vector<Feature> list = test::laws();
    list.push_back({"ground", {{"Ground/Profile", "1+0.4*sin(3*x)"}}});
    const Feature all = test::all_of(list, feedback("0.3*sin(w)*(1+s)+0.2*w_t*w+0.3*w_near*w_delayed+0.1*sin(t)"));
    const std::vector<Feature> more = {
      {"Newtonian", {{"Ground/Friction law", "Newtonian"}}},
      {"stretch", feedback("0.3*sin(w)*(1+s)")},
      {"rate", feedback("0.2*w_t+0.1*tanh(w_t)*w")},
      {"nearby", feedback("0.3*w_near^2*w")},
      {"sensor", feedback("0.3*w_near^2*w", "-0.37", "0.28")},
      {"sensor at the place", feedback("0.2*tanh(5*(w_near-1))*w", "0", "0.4")},
      all,
      {"all with sensors", test::with(all.settings, {{"Active stress/Strain feedback/Sensor length", "0.5"}})}};
    list.insert(list.end(), more.begin(), more.end());
    return list;
  }

  /// Plain scenes, and those.
  std::vector<Feature>
  all_features()
  {
    std::vector<Feature> list = features();
    for (const double a : {-20., -3., -1.5, -1., 0., 0.5, 1., 2., 20.})
      list.push_back({"a = " + test::text(a), test::wave(a, 0.3)});
    return list;
  }

  /// The form on three cells, with a state of stretches between about 0.6 and 1.4.
  struct Case
  {
    Case(const Feature &feature, const unsigned int degree)
      : scene(test::parameters_with(feature.settings).create_scene())
      , d(MPI_COMM_SELF, 1., 3, degree)
      , form(std::make_unique<PositionForm>(scene, d))
      , y(form->n_owned())
      , y_dot(form->n_owned())
    {
      const auto &element  = d.element;
      const unsigned int q = degree;
      for (unsigned int c = 0; c < d.n_cells(); ++c)
        for (unsigned int i = 0; i < element.n; ++i)
        {
          const double s         = d.cell_left[c] + d.cell_size[c] * element.nodes[i];
          const std::size_t node = c * q + i;
          y[node]                = 0.06 * std::sin(5. * s) + 0.02 * s * s;
          y_dot[node]            = 0.3 * std::cos(4. * s) - 0.1;
        }
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
      EXPECT_TRUE(form->residual(t, x, x_dot, F));
      return F;
    }

    /// The derivative of the residual.
    std::vector<double>
    slope(const std::vector<double> &by, const std::vector<double> &by_dot)
    {
      return test::derivative([&](const double step) { return residual(by, by_dot, step); });
    }

    Scene scene;
    Discretization d;
    std::unique_ptr<PositionForm> form;
    std::vector<double> y, y_dot;
  };

  void
  expect_close(const std::vector<double> &x, const std::vector<double> &y, const std::string &what)
  {
    double error = 0.;
    for (std::size_t i = 0; i < x.size(); ++i)
      error = std::max(error, std::abs(x[i] - y[i]));
    EXPECT_LE(error, 1e-7 * largest(y)) << what;
  }
} // namespace

TEST(PositionForm, ProductsMatchDifferences)
{
  constexpr double sigma = 37.;
  for (const Feature &feature : all_features())
    for (const unsigned int q : {1u, 2u, 4u, 8u})
    {
      Case test(feature, q);
      ASSERT_EQ(test.scene.is_plain(), feature.name.starts_with("a = "));
      if (q == 8 && !test.scene.is_plain())
        continue; // differences know too little of rough rates there
      const std::string what = feature.name + ", degree " + std::to_string(q);
      const std::size_t n    = test.y.size();
      for (const double roughness : {1., 40.})
      {
        std::vector<double> x(n), x_dot(n), sigma_x(n), product(n);
        for (std::size_t i = 0; i < n; ++i)
        {
          x[i]       = 0.1 * std::sin(roughness * static_cast<double>(i) + 0.3);
          sigma_x[i] = sigma * x[i];
          x_dot[i]   = std::cos(roughness * static_cast<double>(i));
        }
        ASSERT_TRUE(test.form->setup_jacobian(t, test.y, test.y_dot, sigma));
        test.form->jacobian_vmult(x, product);
        expect_close(product, test.slope(x, sigma_x), what);
        test.form->setup_stage(1, t, test.y, test.y_dot);
        test.form->stage_vmult(1, x, x_dot, product);
        expect_close(product, test.slope(x, x_dot), what + ", stage");

        // The elimination is the inverse, unless a stretch at another place is in the equation.
        const StretchFeedback *stress = test.scene.active_stress->feedback();
        if (stress != nullptr && stress->facts.sees_near())
          continue;
        std::vector<double> back(n);
        test.form->jacobian_vmult(x, product);
        test.form->solve_with_jacobian(product, back);
        expect_close(back, x, what + ", solution");
      }
    }
}

/// The complex systems of Radau methods, by their real and imaginary parts.
TEST(PositionForm, ComplexSolutionsInvertTheProduct)
{
  using Complex                     = PositionForm::Complex;
  const std::vector<Complex> shifts = {{11., 7.}};
  for (const Feature &feature : features())
  {
    Case test(feature, 3);
    const StretchFeedback *stress = test.scene.active_stress->feedback();
    if (stress != nullptr && stress->facts.sees_near())
      continue;
    const std::size_t n = test.y.size();
    std::vector<double> real(n), imaginary(n), first(n), second(n), scaled(n);
    for (std::size_t i = 0; i < n; ++i)
    {
      real[i]      = std::sin(static_cast<double>(i));
      imaginary[i] = std::cos(1.3 * static_cast<double>(i));
    }
    // (K + (a + i b) M)(r + i m) = K r + M (a r - b m) + i (K m + M (a m + b r))
    ASSERT_TRUE(test.form->setup_complex_jacobians(t, test.y, test.y_dot, shifts));
    test.form->setup_stage(0, t, test.y, test.y_dot);
    for (std::size_t i = 0; i < n; ++i)
      scaled[i] = 11. * real[i] - 7. * imaginary[i];
    test.form->stage_vmult(0, real, scaled, first);
    for (std::size_t i = 0; i < n; ++i)
      scaled[i] = 11. * imaginary[i] + 7. * real[i];
    test.form->stage_vmult(0, imaginary, scaled, second);
    std::vector<Complex> b(n), x(n);
    for (std::size_t i = 0; i < n; ++i)
      b[i] = {first[i], second[i]};
    test.form->solve_with_complex_jacobian(0, b, x);
    for (std::size_t i = 0; i < n; ++i)
      ASSERT_LT(std::abs(x[i] - Complex(real[i], imaginary[i])), 1e-9) << feature.name << ", row " << i;
  }
}

/// The velocity balances the forces, and the friction alone, to round-off; and stress power = dissipation + d/dt
/// elastic energy, the latter by differences along the velocity.
TEST(PositionForm, IdentitiesOfAState)
{
  for (const Feature &feature : all_features())
  {
    Case test(feature, 4);
    const double round_off = test.scene.is_plain() ? 1e-12 : 1e-11;
    std::vector<double> v(test.d.n_unknowns()), F(test.y.size());
    ASSERT_TRUE(test.form->velocity(t, test.y, v)) << feature.name;
    ASSERT_TRUE(test.form->residual(t, test.y, v, F));
    EXPECT_LT(largest(F), round_off) << feature.name;
    const CellIntegrals sums = test.form->integrals(t, test.y, v);
    EXPECT_LT(std::abs(sums.net_friction), (test.scene.is_plain() ? 1e-13 : 1e-11) * sums.abs_friction) << feature.name;
    const auto energy = [&](const double step) {
      std::vector<double> y = test.y;
      for (std::size_t i = 0; i < y.size(); ++i)
        y[i] += step * v[i];
      return std::vector<double>{test.form->integrals(t, y, v).elastic_energy};
    };
    EXPECT_NEAR(sums.stress_power,
                sums.dissipation + test::derivative(energy)[0],
                1e-10 * (sums.absolute_power + sums.dissipation))
      << feature.name;
    EXPECT_GT(sums.dissipation, 0.) << feature.name;
    EXPECT_GE(sums.positive_power, sums.stress_power) << feature.name;
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
        u[c * 3 + i] = function(d.cell_left[c] + d.cell_size[c] * d.element.nodes[i]);
  };
  set([](const double s) { return 0.1 * s * s; }); // linear strain, no second mode
  EXPECT_LT(assembler.resolution(u).highest_mode, 1e-25);
  EXPECT_NEAR(assembler.resolution(u).strain, 0.04 / 3., 1e-12);
  set([](const double s) { return 0.1 * s * s * s; });
  EXPECT_GT(assembler.resolution(u).highest_mode, 1e-8);
}
