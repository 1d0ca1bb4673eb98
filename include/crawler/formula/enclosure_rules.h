// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_operation.h>

#include <muParserDef.h>

#include <string>

namespace crawler
{
  /// The rule by which an operation between two values hands on enclosures; null if there is none.
  FormulaOperation::Bound
  bound_of(mu::ECmdCode code);

  /// The same for a function by its name, "-" for the sign and "?" for the choice "c ? a : b". Throws std::logic_error
  /// for an unknown name.
  FormulaOperation::Bound
  bound_of(const std::string &function);
} // namespace crawler
