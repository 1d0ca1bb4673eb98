// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/expect_near.h"
#include "../../support/stress.h"
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/strain_feedback.h>
#include <crawler/scene/active_stress/sum.h>
#include <crawler/scene/period.h>

using namespace crawler;
using crawler::test::expect_near;
using crawler::test::parameters_with;

namespace
{
  constexpr double L = 2., T = 3.;
  const std::string sum = "Active stress/Sum/";

  std::unique_ptr<const ActiveStress>
  expression(const std::string &formula)
  {
    ExpressionParameters parameters;
    parameters.active_stress = formula;
    return std::make_unique<Expression>(parameters, L, T);
  }

  SumTerm
  term(std::unique_ptr<const ActiveStress> stress,
       const bool multiplies     = false,
       const double factor       = 1.,
       const WindowEntries &in_s = {},
       const WindowEntries &in_t = {})
  {
    return {"test", std::move(stress), multiplies, factor, Window(in_s, 's', sum, L), Window(in_t, 't', sum, T)};
  }

  template <typename... Terms>
  Sum
  sum_of(Terms &&...terms)
  {
    std::vector<SumTerm> list;
    (list.push_back(std::move(terms)), ...);
    return {std::move(list), L, T};
  }

  const std::vector<double> points = {0., 0.3, 0.8, 1., 1.1, 1.45, 2.};
  const std::vector<double> times  = {0., 0.17, 0.9, 1.31, 2.2, 3.};

  std::vector<double>
  values(const ActiveStress &stress, const double t)
  {
    return test::values(stress, points, t);
  }

  std::vector<double>
  rates(const ActiveStress &stress, const double t)
  {
    return test::rates(stress, points, t);
  }
} // namespace

TEST(Sum, OfTwoExpressionsIsTheExpressionOfTheSum)
{
  const Sum both        = sum_of(term(expression("sin(3*s+2*t)")), term(expression("s*s*cos(t)"), false, -0.5));
  const auto by_hand    = expression("sin(3*s+2*t) - 0.5*s*s*cos(t)");
  const Sum with_factor = sum_of(term(expression("sin(3*s+2*t)")),
                                 term(expression("exp(-t)*(1+s)"), true, 2.),
                                 term(expression("s*s*cos(t)")),
                                 term(expression("cos(s-t)"), true));
  const auto product    = expression("(sin(3*s+2*t) + s*s*cos(t))*2*exp(-t)*(1+s)*cos(s-t)");
  for (const double t : times)
  {
    expect_near(values(both, t), values(*by_hand, t), 1e-15);
    expect_near(rates(both, t), rates(*by_hand, t), 1e-14);
    expect_near(values(with_factor, t), values(*product, t), 2e-14);
    expect_near(rates(with_factor, t), rates(*product, t), 5e-14);
  }
}

/// Windows by their closed form; neighbours whose edges overlap add up to 1.
TEST(Sum, WindowsCutTermsOutAndBlendThem)
{
  const Sum cut = sum_of(term(expression("1+s+t"), false, 1., {{0.5, 1.1}, 0.}, {{1., 2.5}, 0.}));
  for (const double t : times)
  {
    const auto m = values(cut, t);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const bool inside = points[i] >= 0.5 && points[i] < 1.1 && t >= 1. && t < 2.5;
      EXPECT_EQ(m[i], inside ? 1. + points[i] + t : 0.) << points[i] << " " << t;
    }
  }
  EXPECT_EQ(cut.breaks_in_space(), (std::vector<double>{0.5, 1.1}));
  EXPECT_EQ(cut.breaks_in_time(), (std::vector<double>{1., 2.5}));

  const auto whole = expression("sin(s)+t");
  for (const double edge : {0., 0.4})
  {
    const Sum blended = sum_of(term(expression("sin(s)+t"), false, 1., {{-1., 1. + edge / 2.}, edge}),
                               term(expression("sin(s)+t"), false, 1., {{1. - edge / 2., 3.}, edge}));
    const Sum faded   = sum_of(term(expression("sin(s)+t"), false, 1., {}, {{-1., 1.3 + edge / 2.}, edge}),
                             term(expression("sin(s)+t"), false, 1., {}, {{1.3 - edge / 2., 4.}, edge}));
    for (const double t : times)
    {
      expect_near(values(blended, t), values(*whole, t), 1e-14);
      expect_near(rates(blended, t), rates(*whole, t), 1e-14);
      expect_near(values(faded, t), values(*whole, t), 1e-14);
      expect_near(rates(faded, t), rates(*whole, t), 1e-13);
    }
    EXPECT_EQ(blended.breaks_in_space().size(), edge > 0. ? 0u : 2u);
  }
}

/// The product rule with edges in time, against differences.
TEST(Sum, RateIsTheDerivativeOfTheValues)
{
  const Sum all = sum_of(term(expression("sin(s+5*t)"), false, 0.7, {{0.2, 1.9}, 0.3}, {{0.1, 2.}, 0.8}),
                         term(expression("t*t*s"), false, 1.),
                         term(expression("1+0.3*cos(4*t-s)"), true, 1.5, {{-1., 1.7}, 0.5}, {{-1., 2.9}, 0.9}));
  test::expect_rate(all, L, {0.35, 0.6, 1.2, 1.7, 2.4}, 1e-7, /*h=*/1e-3);
}

TEST(Sum, HasThePeriodThatItsTermsHaveInCommon)
{
  EXPECT_DOUBLE_EQ(*common_period({1., 1.5}), 3.);
  EXPECT_DOUBLE_EQ(*common_period({1. / 3., 0.25, 0.5}), 1.);
  EXPECT_DOUBLE_EQ(*common_period({0.7}), 0.7);
  EXPECT_FALSE(common_period({1., std::numbers::sqrt2}));
  EXPECT_FALSE(common_period({1., 1. + 1e-7}));

  const auto period = [](const std::string &a, const std::string &b, const bool multiplies = false) {
    std::vector<SumTerm> terms;
    for (const auto &[formula, is_factor] : {std::pair(a, false), std::pair(b, multiplies)})
    {
      ExpressionParameters parameters;
      parameters.active_stress = formula;
      terms.push_back({"test",
                       std::make_unique<Expression>(parameters, L, 12.),
                       is_factor,
                       1.,
                       Window({}, 's', sum, L),
                       Window({}, 't', sum, 12.)});
    }
    return Sum(std::move(terms), L, 12.).period();
  };
  EXPECT_NEAR(*period("sin(2*pi*t+s)", "cos(2*pi*t/1.5-s)"), 3., 1e-9);
  EXPECT_FALSE(period("sin(2*pi*t+s)", "cos(2*pi*t/sqrt(2)-s)"));
  EXPECT_NEAR(*period("sin(2*pi*t)", "sin(2*pi*t)", true), 0.5, 1e-9); // the square
  EXPECT_NEAR(*period("sin(2*pi*t)", "1+s", true), 1., 1e-9);          // a steady term has none of its own
  EXPECT_FALSE(sum_of(term(expression("sin(2*pi*t/0.5)"), false, 1., {}, {{1., 2.}, 0.})).period());
}

/// A term that starts, one that ends, and a steady one: together they repeat when the first two have done so.
TEST(Sum, RepeatsAfterTheStartOfItsTerms)
{
  const auto late = sum_of(term(expression("sin(2*pi*t/0.5)"), false, 1., {}, {{0.3, 99.}, 0.2}),
                           term(expression("1+s"), true),
                           term(expression("0.1*s"), false, 1., {}, {{0.1, 0.7}, 0.05}));
  EXPECT_FALSE(late.period());
  EXPECT_NEAR(late.repetition()->period, 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(late.repetition()->from, 0.7);
  EXPECT_EQ(sum_of(term(expression("sin(2*pi*t/0.5)"))).repetition()->from, 0.);
  EXPECT_FALSE(sum_of(term(expression("sin(2*pi*t/0.5)")), term(expression("t"))).repetition());
}

/// Values by the formula, derivatives by differences (exact for a polynomial of degree 2).
TEST(Sum, CombinesFeedback)
{
  const auto seen_by = [](const double distance, const double delay, const double sensor_length = 0.) {
    const std::string near    = distance != 0. || sensor_length > 0. ? "w_near" : "1",
                      delayed = delay > 0. ? "w_delayed" : "1";
    return std::make_unique<StrainFeedback>(
      StrainFeedbackParameters{"0.5*w^2+0.2*w_t+0.6*" + near + "*" + delayed, "", distance, delay, sensor_length},
      L,
      T);
  };
  const Sum all = sum_of(term(seen_by(0.1, 0.2), false, 3., {{0.5, 1.2}, 0.}),
                         term(expression("s+t")),
                         term(seen_by(0.1, 0.), true, 0.5),
                         term(expression("1+s*t"), true));
  ASSERT_NE(all.feedback(), nullptr);
  EXPECT_TRUE(all.feedback()->facts.uses_rate);
  EXPECT_EQ(all.feedback()->facts.distance, 0.1);
  EXPECT_EQ(all.feedback()->facts.delay, 0.2);

  const std::size_t n = points.size();
  const double t      = 0.7;
  std::vector<double> w(n), rate(n), near(n), delayed(n), m(n), m_w(n), m_rate(n), m_near(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    w[i]       = 0.8 + 0.1 * static_cast<double>(i);
    rate[i]    = 0.3 - 0.2 * static_cast<double>(i);
    near[i]    = 1.2 - 0.1 * static_cast<double>(i);
    delayed[i] = 0.9 + 0.05 * static_cast<double>(i);
  }
  const auto at       = all.feedback()->at(points);
  const auto evaluate = [&](std::vector<double> &seen, const double step) {
    std::vector<double> result(n);
    for (double &value : seen)
      value += step;
    at->values(t, {w, rate, near, delayed}, {result, {}, {}, {}});
    for (double &value : seen)
      value -= step;
    return result;
  };
  at->values(t, {w, rate, near, delayed}, {m, m_w, m_rate, m_near});
  expect_near(m, evaluate(w, 0.), 0.);
  for (std::size_t i = 0; i < n; ++i)
  {
    const double s = points[i], f = 0.5 * w[i] * w[i] + 0.2 * rate[i], first = f + 0.6 * near[i] * delayed[i];
    EXPECT_NEAR(
      m[i], ((s >= 0.5 && s < 1.2 ? 3. * first : 0.) + s + t) * 0.5 * (f + 0.6 * near[i]) * (1. + s * t), 1e-14);
  }
  constexpr double h = 1e-5;
  for (const auto &[seen, derivative] : {std::pair(&w, &m_w), std::pair(&rate, &m_rate), std::pair(&near, &m_near)})
  {
    const auto after = evaluate(*seen, h), before = evaluate(*seen, -h);
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_NEAR((*derivative)[i], (after[i] - before[i]) / (2. * h), 1e-8);
  }

  EXPECT_THROW(sum_of(term(seen_by(0.1, 0.)), term(seen_by(-0.1, 0.))), InputError);
  EXPECT_THROW(sum_of(term(seen_by(0., 1.)), term(seen_by(0., 2.))), InputError);
  // A sensor and a point, or two lengths of sensors, have no common near stretch.
  EXPECT_THROW(sum_of(term(seen_by(0.1, 0.)), term(seen_by(0.1, 0., 0.2))), InputError);
  EXPECT_THROW(sum_of(term(seen_by(0., 0., 0.3)), term(seen_by(0.1, 0., 0.3))), InputError);
  EXPECT_EQ(sum_of(term(seen_by(0., 0., 0.3)), term(seen_by(0., 1.))).feedback()->facts.sensor_length, 0.3);
}

/// Through the parameter file: as many terms as it has, and the values of the formula.
TEST(Sum, RunsAsItsFormula)
{
  const Parameters parameters = parameters_with(
    test::set("sum; Term 2/Combine = multiply; Term 2/Generator = expression; "
              "Term 2/Expression/Active stress = 1-exp(-t/tau); Term 2/Expression/Constants = tau=0.2; "
              "Term 1/Generator = travelling wave; Term 1/Travelling wave/Amplitude = 0.2; "
              "Term 3/Generator = expression; Term 3/Factor = 0.1; Term 3/Expression/Active stress = sin(pi*s)"));
  EXPECT_EQ(parameters.active_stress.sum.terms.size(), 3u);
  EXPECT_EQ(parameters_with({}).active_stress.sum.terms.size(), 0u);
  const Scene scene = parameters.create_scene();
  std::ostringstream report;
  scene.active_stress->report(report);
  EXPECT_NE(report.str().find("Term 2 multiplies: expression"), std::string::npos) << report.str();

  // The same wave on its own tells its formula.
  const Scene wave = parameters_with(test::set("travelling wave; Amplitude = 0.2")).create_scene();
  for (const double t : {0., 0.3, 1.})
  {
    const std::vector<double> places = {0., 0.21, 0.5, 1.};
    const auto m = test::values(*scene.active_stress, places, t), g = test::values(*wave.active_stress, places, t);
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(m[i], (g[i] + 0.1 * std::sin(std::numbers::pi * places[i])) * (1. - std::exp(-t / 0.2)), 1e-15);
  }
}
