// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The optimal wave with a shape of any kind: against the Fourier series, against integrals in closed form, its rate,
// its leading order, and what it refuses.
#include "../../support/expect_near.h"
#include "../../support/stress.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"
#include "../../support/wave_energy.h"

#include <crawler/accuracy/model_choice.h>
#include <crawler/base/gauss_panels.h>
#include <crawler/scene/active_stress/shaped_wave.h>

using namespace crawler;
using test::Settings;
using test::stress_with;
using test::values;

namespace
{
  using std::numbers::pi;

  /// L = 2, gamma = 0.7, k = 3, chi = 0.3.
  Settings
  shaped(const std::string &entries, const double speed, const double end_time)
  {
    return test::set(
      "L = 2; k = 3; gamma = 0.7; p = 3; chi = 0.3; T = {}; c = {}; optimal wave; {}", end_time, speed, entries);
  }

  Settings
  by_formula(const std::string &formula, const double speed = 1.3, const double end_time = 5.)
  {
    return shaped("Shape = expression; Shape formula = " + formula, speed, end_time);
  }

  /// A table of @p f at n + 1 places from @p from to @p to.
  std::string
  table(const auto &f, const double from, const double to, const unsigned int n)
  {
    std::string text = "x,f\n";
    for (unsigned int i = 0; i <= n; ++i)
    {
      const double x = from + (to - from) * i / n;
      text += test::text(x) + "," + test::text(f(x)) + "\n";
    }
    return text;
  }
} // namespace

/// The general form of the theorem and its Fourier series are one: f = alpha V with V = sum a_n sin + b_n cos.
TEST(ShapedWave, SineIsTheFourierSeries)
{
  for (const double speed : {1.3, -0.9})
  {
    const auto fourier =
      stress_with(shaped("Sine coefficients = 1, 0, -0.2; Cosine coefficients = 0.5, 0.1, 0", speed, 5.));
    const auto general =
      stress_with(by_formula("sin(pi*x) - 0.2*sin(3*pi*x) + 0.5*cos(pi*x) + 0.1*cos(2*pi*x)", speed));
    const auto points = equal_parts(0., 2., 64);
    for (const double t : {0., 0.2, 1.7, 5.})
      EXPECT_LT(test::largest_difference(values(*fourier, points, t), values(*general, points, t)), 1e-12) << t;
    EXPECT_NEAR(general->period().value(), 2. / std::abs(speed), 1e-9);
    test::expect_rate(*general, 2., {0.3, 1.9, 4.4}, 1e-8);
    // What the leading order says of both.
    const auto &root = dynamic_cast<const OptimalWave &>(*fourier).wave();
    const auto order = dynamic_cast<const ShapedWave &>(*general).leading_order();
    EXPECT_NEAR(order.displacement, root.displacement, 1e-12);
    EXPECT_NEAR(order.min_stretch, root.min_stretch, 1e-3);
    EXPECT_NEAR(order.max_stretch, root.max_stretch, 1e-3);
    const WaveShape shape{{1., 0., -0.2}, {0.5, 0.1, 0.}};
    Body body;
    body.length               = 2.;
    body.elastic_modulus      = 3.;
    body.friction_coefficient = 0.7;
    EXPECT_NEAR(order.energy, 0.09 * test::wave_energy(body, shape, 5., speed), 1e-11);
  }
}

/// A Gaussian that passes once, whose integral is the error function.
TEST(ShapedWave, GaussianHasItsIntegral)
{
  const double L = 2., gamma = 0.7, k = 3., chi = 0.3, c = -0.8, w = 0.15, x_0 = -0.4;
  const auto V        = [&](const double x) { return std::exp(-(x - x_0) * (x - x_0) / (w * w)); };
  const auto integral = [&](const double from, const double to) // of V
  { return 0.5 * w * std::sqrt(pi) * (std::erf((to - x_0) / w) - std::erf((from - x_0) / w)); };
  const auto stress =
    stress_with(by_formula("exp(-((x + shift)/width)^2); Shape constants = shift=0.4, width=0.15", c, 3.));
  const auto points = equal_parts(0., L, 64);
  for (const double t : {0., 0.3, 0.9, 1.6, 3.})
  {
    const auto m = values(*stress, points, t);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double s = points[i], ct = c * t;
      EXPECT_NEAR(m[i],
                  chi * (gamma * (integral(ct, s + ct) - s / L * integral(ct, L + ct)) - k / c * (V(s + ct) - V(s))),
                  1e-12);
    }
  }
  EXPECT_EQ(stress->period(), std::nullopt);
  test::expect_rate(*stress, L, {0.3, 0.9, 1.6}, 1e-7);
}

/// Of a polynomial of degree 3 a cubic spline is exact, also with unequal knots.
TEST(ShapedWave, TableIsASpline)
{
  const test::TemporaryFolder folder;
  const std::string name = (folder.path / "shape.csv").string();
  const auto cubic       = [](const double x) { return 0.1 * x * x * x - 0.5 * x * x + 0.2; };
  std::string text       = "x,f\r\n";
  for (const double x : {-0.1, 0.3, 1., 1.1, 2.5, 4., 4.6})
    text += test::text(x) + ", " + test::text(cubic(x)) + "\r\n";
  write_file(name, text);
  const std::string from_table = "Shape = table; Shape file = " + name;
  const auto points            = equal_parts(0., 2., 40);
  {
    const auto by_table = stress_with(shaped(from_table, 1.3, 2.)),
               formula  = stress_with(by_formula("0.1*x^3 - 0.5*x^2 + 0.2", 1.3, 2.));
    for (const double t : {0., 0.7, 2.})
      EXPECT_LT(test::largest_difference(values(*by_table, points, t), values(*formula, points, t)), 1e-12);
    test::expect_rate(*by_table, 2., {0.3, 1.2}, 1e-8);
  }
  // Fourth order for others.
  const auto error = [&](const unsigned int n) {
    write_file(name, table([](const double x) { return std::sin(3. * x); }, 0., 4.6, n));
    const auto by_table = stress_with(shaped(from_table, 1.3, 2.)),
               formula  = stress_with(by_formula("sin(3*x)", 1.3, 2.));
    return test::largest_difference(values(*by_table, points, 1.1), values(*formula, points, 1.1));
  };
  const double coarse = error(40), fine = error(80);
  EXPECT_GT(coarse / fine, 12.);
  EXPECT_LT(fine, 1e-4);
}

/// V' may jump: the panels find the place to round-off, and the mesh is told of it.
TEST(ShapedWave, KinksAreFound)
{
  const auto stress = stress_with(by_formula("max(0, 1 - abs(x - 1.234)/0.5)", 1., 2.));
  test::expect_near(stress->breaks_in_space(), {0.734, 1.234, 1.734}, 1e-9);
  const auto V = [](const double x) { return std::max(0., 1. - std::abs(x - 1.234) / 0.5); };
  // At t = 2 the triangle has left the body, so that only -(k/c) ( 0 - V(s) ) is left of the elastic part.
  const auto points = equal_parts(0., 2., 40);
  const auto m      = values(*stress, points, 2.);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(m[i], 0.3 * 3. * V(points[i]), 1e-12);
}

/// A narrow peak between two coarse ones, and a shape that is needed over many lengths.
TEST(ShapedWave, PanelsAreRefinedWhereItIsNeeded)
{
  const auto function = [](const std::span<const double> x, const std::span<double> f) {
    for (std::size_t i = 0; i < x.size(); ++i)
      f[i] = std::cos(x[i]) + std::exp(-std::pow((x[i] - 0.31) / 0.01, 2));
  };
  const ShapeFunction shape(function, 0., 50., 1. / 16., "entry");
  const auto peak     = [](const double x) { return std::exp(-std::pow((x - 0.31) / 0.01, 2)); };
  const auto integral = [](const double x) {
    return std::sin(x) + 0.005 * std::sqrt(pi) * (std::erf((x - 0.31) / 0.01) - std::erf(-0.31 / 0.01));
  };
  std::vector<double> x;
  for (int i = 0; i <= 1000; ++i)
    x.push_back(i % 2 == 0 ? 0.05 * i : std::fmod(37.3 * i, 50.)); // every second in no order
  std::vector<double> values(x.size()), integrals(x.size());
  std::size_t panel = 0;
  shape.values_and_integrals(x, panel, values, integrals);
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    EXPECT_NEAR(values[i], std::cos(x[i]) + peak(x[i]), 1e-13);
    EXPECT_NEAR(integrals[i], integral(x[i]), 1e-13);
    EXPECT_NEAR(shape.derivative(x[i], panel), -std::sin(x[i]) - 2. * (x[i] - 0.31) / 1e-4 * peak(x[i]), 1e-9);
  }
}

TEST(ShapedWave, RefusesWhatMakesNoSense)
{
  using test::expect_complaint;
  const std::string section = "Active stress/Optimal wave/";
  expect_complaint(by_formula("sin(pi*x); Choose wave by = energy"),
                   {section + "Choose wave by: ", "Shape = expression", "wave speed is expected"});
  expect_complaint(by_formula("sin(pi*x)", 0.), {section + "Wave speed: ", "not 0 is expected"});
  expect_complaint(by_formula("sin(pi*x)", 1e5), {section + "Wave speed: ", "2.5e+05 body lengths", "at most 10000"});
  expect_complaint(by_formula("sin(pi*x"), {section + "Shape formula: ", "error in the formula"});
  expect_complaint(by_formula("sin(pi*s)"), {section + "Shape formula: ", "position 8"});
  expect_complaint(by_formula(""), {section + "Shape formula: ", "is empty"});
  expect_complaint(by_formula("sin(x + t)"), {section + "Shape formula: ", "depends on t", "a formula of x"});
  expect_complaint(by_formula("1/x"), {section + "Shape formula: ", "a finite number is expected from 0 to 8.5"});
  expect_complaint(by_formula("x > 1.1 ? 1 : 0"), {section + "Shape formula: ", "jumps at x = 1.1;", "continuous"});
  expect_complaint(by_formula("sin(q*x); Shape constants = q 3"), {section + "Shape constants: ", "found \"q 3\""});
  expect_complaint(shaped("Shape = spline", 1., 1.), {section + "Shape: ", "expected"});

  const test::TemporaryFolder folder;
  const std::string name  = (folder.path / "shape.csv").string();
  const Settings settings = shaped("Shape = table; Shape file = " + name, -1., 3.); // needs -3 to 2
  expect_complaint(settings, {section + "Shape file: ", "cannot read"});
  const std::vector<std::pair<std::string, std::string>> tables = {
    {"s,f\n0,1\n", "header x,f is expected"},
    {"x,f\n0,1\n1,2\n2,1\n", "3 rows after the header, but at least 4"},
    {"x,f\n-3,1\n1,1,1\n2,1\n", "row 3 of"},
    {"x,f\n-3,1\n1,1\n1,2\n2,1\n", "row 4 of"},
    {"x,f\n-3,1\n1,1\n0,2\n2,1\n", "x = 0 after x = 1, but increasing"},
    {"x,f\n-2,1\n-1,1\n0,2\n2,1\n", "x from -2 to 2, but the whole range from -3 to 2 is expected"}};
  for (const auto &[text, words] : tables)
  {
    write_file(name, text);
    expect_complaint(settings, {section + "Shape file: ", words});
  }
}

/// The series is for Fourier coefficients; Model = auto goes on without it.
TEST(ShapedWave, HasNoPerturbationSeries)
{
  Parameters parameters = test::parameters_with(test::with(by_formula("exp(sin(pi*x))"), "Model = perturbation"));
  test::expect_words(test::complaint_of([&]() { choose_model(parameters, parameters.create_scene()); }),
                     {"the Shape of the optimal wave is expression"});
  parameters.model = Model::automatic;
  EXPECT_NE(choose_model(parameters, parameters.create_scene()).model, Model::perturbation);
}
