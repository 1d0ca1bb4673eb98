// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula.h>

namespace crawler
{
  /**
   * The derivative of a formula with respect to t at the points of one mesh, exact up to round-off: each operation
   * hands on the derivative of its result (forward-mode automatic differentiation). At a jump or a kink it is that of
   * one of the sides.
   */
  class FormulaRateAtPoints
  {
  public:
    FormulaRateAtPoints(std::shared_ptr<const Formula> formula, const std::vector<double> &points);

    /// Writes the derivative at all points into @p rate.
    void
    values(double t, std::span<double> rate);

  private:
    static constexpr std::size_t block_size = 64;

    void
    compute(const std::vector<Formula::Operation> &operations, std::size_t n);

    const std::shared_ptr<const Formula> formula_;
    const std::vector<double> points_;
    std::vector<double> values_, rates_; ///< [value][point] of one block
    std::vector<Formula::Operand> arguments_;
    std::vector<const double *> argument_values_, argument_rates_;
  };
} // namespace crawler
