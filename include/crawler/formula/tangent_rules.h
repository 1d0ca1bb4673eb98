// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_operation.h>

#include <muParserDef.h>

#include <string>

namespace crawler
{
  /// The rule of differentiation of an operator between two values; null for comparisons and logical operators.
  FormulaOperation::Tangent
  tangent_of(mu::ECmdCode code);

  /// The same for a function by its name, "-" for the sign and "?" for the choice "c ? a : b"; null for functions that
  /// are constant except for jumps. Throws std::logic_error for an unknown name.
  FormulaOperation::Tangent
  tangent_of(const std::string &function);
} // namespace crawler
