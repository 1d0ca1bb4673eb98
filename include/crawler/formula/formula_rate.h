// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_gradient.h>

namespace crawler
{
  /// The derivative of a formula of s and t with respect to t at the points of one mesh.
  class FormulaRateAtPoints
  {
  public:
    FormulaRateAtPoints(std::shared_ptr<const Formula> formula, const std::vector<double> &points)
      : points_(points)
      , f_(points.size())
      , gradient_(std::move(formula))
    {
    }

    /// Writes the derivative at all points into @p rate.
    void
    values(const double t, const std::span<double> rate)
    {
      const std::span<const double> arguments[] = {points_, {&t, 1}};
      const std::span<double> derivatives[]     = {{}, rate};
      gradient_.evaluate(arguments, f_, derivatives);
    }

  private:
    const std::vector<double> points_;
    std::vector<double> f_;
    FormulaGradient gradient_;
  };
} // namespace crawler
