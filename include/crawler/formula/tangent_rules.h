// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula_operation.h>

#include <string>

namespace crawler
{
  /// The rule of differentiation of an operation by its name (as in enclosure_rules.h); null for those that are
  /// constant except for jumps. Throws std::logic_error for an unknown name.
  FormulaOperation::Tangent
  tangent_of(const std::string &operation);
} // namespace crawler
