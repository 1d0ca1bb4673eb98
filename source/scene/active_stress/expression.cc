// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/formula/formula_rate.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/period.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    const std::string formula_entry   = "Active stress/Expression/Active stress";
    const std::string constants_entry = "Active stress/Expression/Constants";

    /// The values of a formula at the points of a mesh, or their rates, as an active stress.
    template <typename Values>
    class StressFrom : public ActiveStressAtPoints
    {
    public:
      StressFrom(const std::shared_ptr<const Formula> &formula, const std::vector<double> &points)
        : values_(formula, points)
      {
      }

      void
      values(const double t, const std::span<double> m) override
      {
        values_.values(t, m);
      }

    private:
      Values values_;
    };
  } // namespace


  void
  ExpressionParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Expression");
    declarations.text("Active stress",
                      active_stress,
                      "a formula of s and t",
                      "The active stress m(s,t): s is the material coordinate, t the time; pi, L (body length) "
                      "and T (end time) are known, and sin, cos, tan, sinh, cosh, tanh, exp, log, sqrt, abs, "
                      "sign, min, max, pow, mod, floor, ceil, erf, erfc, ^, comparisons and a ? b : c.",
                      "force");
    declarations.text("Constants", constants, "a list name=number, name=number", "Constants that the formula may use.");
    declarations.leave();
  }

  Expression::Expression(const ExpressionParameters &parameters, const double length, const double end_time)
    : length_(length)
    , end_time_(end_time)
    , formula_(parameters.active_stress)
    , compiled_(read_formula(
        {"active stress", formula_, parameters.constants, formula_entry, constants_entry}, length, end_time))
    , bound_(compiled_)
  {
    require_finite_values(length, end_time);
  }

  void
  Expression::require_finite_values(const double length, const double end_time) const
  {
    constexpr unsigned int n = 16;
    std::vector<double> points(n + 1), m(n + 1);
    for (unsigned int i = 0; i <= n; ++i)
      points[i] = length * i / n;
    const auto at_points = at(points);
    for (unsigned int j = 0; j <= n; ++j)
    {
      const double t = end_time * j / n;
      at_points->values(t, m);
      for (unsigned int i = 0; i <= n; ++i)
        if (!std::isfinite(m[i]))
          throw InputError(fmt::format("the formula \"{}\" gives {} at s = {}, t = {}; a finite number is expected",
                                       formula_,
                                       m[i],
                                       points[i],
                                       t),
                           formula_entry);
    }
  }

  std::unique_ptr<ActiveStressAtPoints>
  Expression::at(const std::vector<double> &points) const
  {
    return std::make_unique<StressFrom<FormulaAtPoints>>(compiled_, points);
  }

  std::optional<double>
  Expression::period() const
  {
    if (!period_)
      period_ = find_period(*this, length_, end_time_);
    return *period_;
  }

  std::optional<ActiveStress::Bounds>
  Expression::bounds(const Box &box) const
  {
    const Enclosure m = bound_({box.s_from, box.s_to}, {box.t_from, box.t_to});
    return Bounds{m.value.largest(), m.rate.largest()};
  }

  std::unique_ptr<ActiveStressAtPoints>
  Expression::rate_at(const std::vector<double> &points) const
  {
    return std::make_unique<StressFrom<FormulaRateAtPoints>>(compiled_, points);
  }
} // namespace crawler
