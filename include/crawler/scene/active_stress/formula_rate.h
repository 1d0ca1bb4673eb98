// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/formula.h>

#include <muParserDef.h>

namespace crawler
{
  /// The rule of differentiation of an operator between two values; null for comparisons and logical operators.
  Formula::Operation::Tangent
  tangent_of(mu::ECmdCode code);

  /// The same for a function by its name, "-" for the sign and "?" for the choice "c ? a : b"; null for functions that
  /// are constant except for jumps. Throws std::logic_error for an unknown name.
  Formula::Operation::Tangent
  tangent_of(const std::string &function);

  /**
   * The derivative of a formula with respect to t at the points of one mesh, exact up to round-off: each operation
   * hands on the derivative of its result (forward-mode automatic differentiation). At a jump or a kink it is that of
   * one of the sides.
   */
  class FormulaRateAtPoints : public ActiveStressAtPoints
  {
  public:
    FormulaRateAtPoints(std::shared_ptr<const Formula> formula, const std::vector<double> &points);

    /// Writes the derivative at all points into @p rate.
    void
    values(double t, std::span<double> rate) override;

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
