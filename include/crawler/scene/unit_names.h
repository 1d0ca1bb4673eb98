// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  class Declarations;

  /**
   * Section "Units": what the user calls the units of length, time and force. They are names alone: nothing is
   * converted. Units in the program are words, "force length" or "length/time^2"; here they become those of the user.
   */
  struct UnitNames
  {
    std::string length = "length", time = "time", force = "force";

    void
    add_parameters(Declarations &declarations);

    /// Throws InputError if a name does not fit into the header of a table.
    void
    require_plain() const;

    /// "mN cm" for "force length".
    std::string
    of(const std::string &unit) const;

    /// A text with units in brackets, "t [time],u [length]", with those of the user.
    std::string
    in_brackets(const std::string &text) const;

    /// What stands behind a number, with a blank before it: nothing if the user has named no unit.
    std::string
    behind(const std::string &unit) const;

  private:
    /// Has the user named none?
    bool
    is_general() const;
  };
} // namespace crawler
