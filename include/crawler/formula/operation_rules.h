// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  struct Enclosure;

  /// An argument of an operation: one number for all points, or one for each.
  struct FormulaOperand
  {
    const double *values;
    bool is_scalar;

    double
    operator[](const std::size_t i) const
    {
      return is_scalar ? *values : values[i];
    }
  };

  /// How an operation propagates derivatives and enclosures.
  struct OperationRules
  {
    /// Derivative of the result, from the arguments, their derivatives and the result (one number per point each).
    using Tangent = void (*)(std::span<const double *const> arguments,
                             std::span<const double *const> rates,
                             const double *result,
                             double *rate,
                             std::size_t n);

    /// Encloses the result (enclosure.h).
    using Bound = Enclosure (*)(std::span<const Enclosure> arguments);

    Tangent tangent = nullptr; ///< null: the result is constant except for jumps
    Bound bound     = nullptr;
    /// Encloses the side on which the operation is computed, a whole number that changes where it jumps or has a kink;
    /// null if it does neither.
    Bound side = nullptr;
  };

  /// Returns the rules of an operation: a function by its name, an operator as "a+b" or "a<=b", "-" for the sign and
  /// "?" for the choice "c ? a : b". Throws std::logic_error for an unknown name.
  OperationRules
  rules_of(const std::string &operation);

  /// An operation. A skip (without a loop) jumps to `target` if no point of the block needs the operations between.
  struct FormulaOperation
  {
    using Function = void (*)();
    using Loop     = void (*)(Function, std::span<const FormulaOperand> arguments, double *result, std::size_t n);

    Loop loop                           = nullptr;
    OperationRules rules                = {};
    Function function                   = nullptr; ///< Of any type, for loops that call a function.
    std::vector<unsigned int> arguments = {};      ///< Values; for a skip the condition.
    unsigned int result                 = 0;       ///< Value.
    bool branch                         = false;   ///< For a skip: condition of points that need what is skipped.
    std::size_t target                  = 0;       ///< For a skip: number of the operation to go on with.
  };
} // namespace crawler
