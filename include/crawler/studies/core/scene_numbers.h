// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/form.h>

#include <string>
#include <vector>

namespace crawler
{
  /// Numbers of the scene that entries of other sections may name: those of the body, the ground and the active stress,
  /// and the end time; those of lists and constants of formulas one by one, "Section/Entry[2]", "Section/Entry[a]".
  class SceneNumbers
  {
  public:
    explicit SceneNumbers(const Form &form);

    /// Paths of the numbers that have an effect.
    const std::vector<std::string> &
    effective() const
    {
      return effective_;
    }

    /// Returns the path of the number that the entry @p own calls @p name. Throws InputError for @p own, with the
    /// nearest name, unless it is a number of the scene that has an effect; @p or_else is what else is expected.
    std::string
    find(const std::string &name, const std::string &own, const std::string &or_else = "") const;

  private:
    const Declarations &declarations_;
    std::vector<std::string> all_, effective_;
  };
} // namespace crawler
