// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula.h>

namespace crawler
{
  /**
   * The value of a formula of any variables, and its derivatives with respect to some of them, at points that change
   * with each call. Derivatives are exact up to round-off (forward-mode automatic differentiation); at a jump or a kink
   * they are one-sided.
   */
  class FormulaGradient
  {
  public:
    explicit FormulaGradient(std::shared_ptr<const Formula> formula);

    /// Evaluates at points. @p arguments: for each variable its values at the points, or one number for all. @p
    /// derivatives: for each variable the destination of the derivative with respect to it, empty if unwanted; the list
    /// may be shorter.
    void
    evaluate(std::span<const std::span<const double>> arguments,
             std::span<double> f,
             std::span<const std::span<double>> derivatives = {});

  private:
    static constexpr std::size_t block_size = 64;

    template <typename Use>
    void
    for_operations(std::size_t n, const Use &use);

    const std::shared_ptr<const Formula> formula_;
    std::vector<double> values_, rates_; ///< [value][point] of one block
    std::vector<Formula::Operand> arguments_;
    std::vector<const double *> argument_values_, argument_rates_;
  };
} // namespace crawler
