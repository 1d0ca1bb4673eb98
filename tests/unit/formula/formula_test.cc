// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/formula/formula.h>

#include <muParser.h>

using namespace crawler;

namespace
{
  const Formula::Constants constants = {{"pi", 3.14159265358979323846}, {"L", 1.}, {"w", 0.15}};

  /// muParser itself, one point after another.
  class PointByPoint
  {
  public:
    explicit PointByPoint(const std::string &formula)
    {
      parser_.DefineFun("pow", static_cast<double (*)(double, double)>(&std::pow));
      parser_.DefineFun("floor", static_cast<double (*)(double)>(&std::floor));
      parser_.DefineFun("ceil", static_cast<double (*)(double)>(&std::ceil));
      parser_.DefineFun("erf", static_cast<double (*)(double)>(&std::erf));
      parser_.DefineFun("erfc", static_cast<double (*)(double)>(&std::erfc));
      parser_.DefineFun("mod", [](const double x, const double y) { return x - y * std::floor(x / y); });
      for (const auto &[name, value] : constants)
        parser_.DefineConst(name, value);
      parser_.DefineVar("s", &s_);
      parser_.DefineVar("t", &t_);
      parser_.SetExpr(formula);
    }

    double
    operator()(const double s, const double t)
    {
      s_ = s;
      t_ = t;
      return parser_.Eval();
    }

  private:
    double s_ = 0., t_ = 0.;
    mu::Parser parser_;
  };

  class FormulaIsMuParser : public testing::TestWithParam<const char *>
  {
  };
} // namespace

/// To the last bit, on no points, one point, a part of a block and several blocks, forth and back in time.
TEST_P(FormulaIsMuParser, AtManyPoints)
{
  PointByPoint expected(GetParam());
  const auto formula = std::make_shared<const Formula>(GetParam(), constants);
  for (const std::size_t n : {0, 1, 60, 64, 65, 300})
  {
    std::vector<double> points(n), m(n);
    for (std::size_t i = 0; i < n; ++i)
      points[i] = static_cast<double>(i) / 299. * (i % 2 == 0 ? 1. : -0.7);
    FormulaAtPoints at_points(formula, points);
    for (const double t : {0., 0.3, 1.7, -0.4, 0.5, 0.3})
    {
      at_points.values(t, m);
      for (std::size_t i = 0; i < n; ++i)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(m[i]), std::bit_cast<std::uint64_t>(expected(points[i], t)))
          << "s = " << points[i] << ", t = " << t << ": " << m[i] << " instead of " << expected(points[i], t);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
  Formulas,
  FormulaIsMuParser,
  testing::Values("0.1*sin(2*pi*(s+t))",
                  "2",
                  "s",
                  "t",
                  "-t",
                  "3*s",
                  "s*2 + 1",
                  "t^3 - 2*t",
                  "sin(0.3)*2",
                  "s^2 + s^3 - t^4 + s^0.5 + s^t",
                  "pow(s, 3) + pow(2, t) + pow(t, s)",
                  "mod(s, 0.3) + mod(t, 1) + mod(s + t, 0.25)",
                  "erf((s - t)/w) + erfc(s) - erf(t)",
                  "floor(7*s) + ceil(3*t) + rint(s + t) + sign(s - 0.5) + abs(t - s)",
                  "min(s, t) + max(s, t, 0.4) + sum(s, 1, t, 2) + avg(s, 3) + min(t, 1)",
                  "atan2(s, t) + exp(-s)*cosh(t) + ln(2 + s) + log10(3 + t) + sqrt(s)",
                  "(s < t) + 2*(s <= t) + 4*(s > 0.5) + 8*(t >= 0.3) + 16*(s == t) + 32*(s != 0)",
                  "(s > 0.2 && t > 0.1) + 2*(s > 0.8 || t < 0)",
                  "s > 0.4 ? 1 : 2",
                  "t < 0.4 ? sin(s + t) : cos(s*t)",
                  "s < 0.3 ? sin(s + t) : t < 0.4 ? s*t : s + t > 1 ? exp(s - t) : 7",
                  "(s < t ? (t < 0.4 ? s + t : s - t) : sin(s)) + (s*t > 0.1 ? t : s)",
                  "(s - 0.5 ? sqrt(s*t - 0.1) : 1/(s*t))", // not a number or infinite at some points
                  "0.6*exp(-((s - (L + 5*w) + (L + 10*w)*mod(t, 1)/1)/w)^2)"));
