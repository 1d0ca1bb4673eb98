// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_operation.h>

#include <string>

namespace crawler
{
  /// Returns the rule by which an operation propagates enclosures: a function by its name, an operator as "a+b" or
  /// "a<=b", "-" for the sign and "?" for the choice "c ? a : b". Throws std::logic_error for an unknown name.
  FormulaOperation::Bound
  bound_of(const std::string &operation);

  /// Returns the rule that encloses the side on which an operation by its name as above is computed, a whole number
  /// that changes where the operation jumps or has a kink; null if it does neither.
  FormulaOperation::Bound
  side_of(const std::string &operation);

  /// Returns the differentiation rule of an operation by its name as above; null if it is constant except for jumps.
  /// Throws std::logic_error for an unknown name.
  FormulaOperation::Tangent
  tangent_of(const std::string &operation);
} // namespace crawler
