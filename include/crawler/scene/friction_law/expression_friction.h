// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_gradient.h>
#include <crawler/scene/friction_law.h>

namespace crawler
{
  /// A friction law that the user writes: g(w) = gamma times a formula of the stretch w, with its exact derivative.
  class ExpressionFriction : public FrictionLaw
  {
  public:
    static constexpr const char *description = "gamma times a formula of the stretch w";

    /// @param gamma friction coefficient [force time/length^2]; @param formula of the one variable w.
    ExpressionFriction(double gamma, std::shared_ptr<const Formula> formula);

    void
    values(std::span<const double> w, std::span<double> g) const override;
    void
    values_and_log_derivatives(std::span<const double> w, std::span<double> g, std::span<double> w_dg) const override;
    std::unique_ptr<FrictionLaw>
    scaled(double factor) const override;

  private:
    const double gamma_;
    const std::shared_ptr<const Formula> formula_;
    mutable FormulaGradient gradient_; ///< has room for intermediate values
  };
} // namespace crawler
