// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_operation.h>

#include <string>

namespace crawler
{
  /// Returns the rules of an operation: a function by its name, an operator as "a+b" or "a<=b", "-" for the sign and
  /// "?" for the choice "c ? a : b". Throws std::logic_error for an unknown name.
  OperationRules
  rules_of(const std::string &operation);
} // namespace crawler
