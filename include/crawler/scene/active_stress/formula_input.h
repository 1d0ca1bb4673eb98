// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula.h>

#include <memory>
#include <string>
#include <vector>

namespace crawler
{
  class ActiveStress;

  /// A formula as written by the user.
  struct FormulaInput
  {
    std::string quantity; ///< the quantity, for messages
    std::string formula, constants;
    std::string formula_entry, constants_entry; ///< full names of the entries
    std::vector<std::string> variables = {"s", "t"};
  };

  /// Compiles a formula of its variables with the constants pi, L, T and the user's own. Throws InputError with the
  /// position if the formula or the list of constants has an error.
  std::shared_ptr<const Formula>
  read_formula(const FormulaInput &input, double length, double end_time);

  /// Throws InputError if an active stress by a formula is not a finite number somewhere on a grid over the body and
  /// the duration; @p where names the body in the message, unless it holds for any.
  void
  require_finite_values(
    const ActiveStress &stress, const FormulaInput &input, const std::string &where, double length, double end_time);
} // namespace crawler
