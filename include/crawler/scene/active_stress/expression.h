// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_bound.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/known_stress.h>

#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Expression".
  struct ExpressionParameters
  {
    std::string active_stress = "0.1*sin(2*pi*(s+t))";
    std::string constants     = "";

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * An active stress m(s,t) given as a formula (muParser) with the variables s and t, the constants pi, L (the body
   * length) and T (the end time) and the user's own.
   */
  class Expression : public KnownStress
  {
  public:
    /// Throws InputError with the position if the formula or the list of constants has an error, or if the formula is
    /// not a finite number somewhere on a grid over the body and the duration.
    Expression(const FormulaInput &input, double length, double end_time);
    Expression(const ExpressionParameters &parameters, double length, double end_time);

    std::optional<Bounds>
    bounds(const Box &box) const override;

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    const double length_;
    const std::shared_ptr<const Formula> compiled_;
    mutable FormulaBound bound_;
  };
} // namespace crawler
