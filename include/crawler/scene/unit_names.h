// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  class Declarations;

  /**
   * Section "Units": the user's names for the units of length, time and force. Only names: nothing is converted. Units
   * in the program are words, "force length" or "length/time^2", translated here.
   */
  struct UnitNames
  {
    std::string length = "length", time = "time", force = "force";

    void
    add_parameters(Declarations &declarations);

    /// Throws InputError if a name does not fit into the header of a table.
    void
    require_plain() const;

    /// Translates a unit: "mN cm" for "force length".
    std::string
    of(const std::string &unit) const;

    /// Translates the units in brackets in a text, "t [time],u [length]".
    std::string
    in_brackets(const std::string &text) const;

    /// The unit to follow a number, with a blank before it; empty if the user has named no unit.
    std::string
    behind(const std::string &unit) const
    {
      return is_general() || unit == "1" ? "" : " " + of(unit);
    }

  private:
    /// True if the user has named no unit.
    bool
    is_general() const
    {
      const UnitNames general;
      return length == general.length && time == general.time && force == general.force;
    }
  };
} // namespace crawler
