// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
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

  /// One operation. A skip (without a loop) goes on at `target` if no point of the block needs what stands between.
  struct FormulaOperation
  {
    using Function = void (*)();
    using Loop     = void (*)(Function, std::span<const FormulaOperand> arguments, double *result, std::size_t n);
    /// The derivative of the result, from the arguments, their derivatives and the result (one number a point each).
    using Tangent = void (*)(std::span<const double *const> arguments,
                             std::span<const double *const> rates,
                             const double *result,
                             double *rate,
                             std::size_t n);

    /// Encloses the result (enclosure.h).
    using Bound = Enclosure (*)(std::span<const Enclosure> arguments);

    Loop loop                           = nullptr;
    Tangent tangent                     = nullptr; ///< null: the result does not change, except by jumps
    Bound bound                         = nullptr;
    Function function                   = nullptr; ///< For loops that call a function, of any type.
    std::vector<unsigned int> arguments = {};      ///< Values; for a skip the condition.
    unsigned int result                 = 0;       ///< Value.
    bool branch                         = false;   ///< Of a skip: the points where the condition is this need it.
    std::size_t target                  = 0;       ///< Of a skip.
  };
} // namespace crawler
