// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/formula_breaks.h>
#include <crawler/formula/formula_gradient.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/period.h>

#include <array>

namespace crawler
{
  void
  ExpressionParameters::add_parameters(Declarations &declarations)
  {
    declarations.text("Active stress", active_stress, "a formula of s and t", "force")
      .means("The active stress m(s,t): s is the material coordinate, t the time; pi, L (body length) and T (end time) "
             "are available, as are sin, cos, tan, sinh, cosh, tanh, exp, log, sqrt, abs, sign, min, max, pow, mod, "
             "floor, ceil, erf, erfc, ^, comparisons and a ? b : c.");
    declarations.constants("Constants", constants, {"Active stress"}).means("Constants that the formula may use.");
  }

  Expression::Expression(const FormulaInput &input, const double length, const double end_time)
    : length_(length)
    , compiled_(read_formula(input, length, end_time))
    , bound_(compiled_)
  {
    facts_.search              = [=, this]() { return find_repetition(*this, length, end_time); };
    const FormulaBreaks breaks = formula_breaks(compiled_, length, end_time);
    facts_.breaks_in_space     = breaks.in_space.value_or(std::vector<double>());
    facts_.breaks_in_time      = breaks.in_time.value_or(std::vector<double>());
    bound_.leaves_out_jumps    = breaks.in_time.has_value();
    require_finite_values(*this, input, "", length, end_time);
  }

  Expression::Expression(const ExpressionParameters &parameters, const double length, const double end_time)
    : Expression({"active stress",
                  parameters.active_stress,
                  parameters.constants,
                  "Active stress/Expression/Active stress",
                  "Active stress/Expression/Constants"},
                 length,
                 end_time)
  {
  }

  std::unique_ptr<ActiveStressAtPoints>
  Expression::evaluator(const std::vector<double> &places, const bool rate) const
  {
    const std::vector<double> points = off_breaks_at_ends(places, facts_.breaks_in_space, length_);
    if (!rate)
      return stress_at_points([at = FormulaAtPoints(compiled_, points)](
                                const double t, const std::span<double> m) mutable { at.values(t, m); });
    return stress_at_points([points, m = std::vector<double>(points.size()), gradient = FormulaGradient(compiled_)](
                              const double t, const std::span<double> m_t) mutable {
      gradient.evaluate(
        std::array<std::span<const double>, 2>{{points, {&t, 1}}}, m, std::array<std::span<double>, 2>{{{}, m_t}});
    });
  }

  std::optional<ActiveStress::Bounds>
  Expression::bounds(const Box &box) const
  {
    const Enclosure m = bound_({box.s_from, box.s_to}, {box.t_from, box.t_to});
    return Bounds{norm(m.value), norm(m.rate)};
  }
} // namespace crawler
