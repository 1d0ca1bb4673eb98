// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/formula.h>

#include <muParserDef.h>

namespace crawler
{
  /// The rule by which an operation between two values hands on enclosures; null if there is none.
  Formula::Operation::Bound
  bound_of(mu::ECmdCode code);

  /// The same for a function by its name, "-" for the sign and "?" for the choice "c ? a : b". Throws std::logic_error
  /// for an unknown name.
  Formula::Operation::Bound
  bound_of(const std::string &function);

  /**
   * Encloses a formula of s and t and its derivative by t in boxes: intervals of both are handed on from operation to
   * operation (interval arithmetic with forward-mode automatic differentiation; R. E. Moore, Interval Analysis, 1966),
   * without directed rounding. Nothing in the box can be missed, however short it is, but the enclosure may be too
   * wide: the less so the smaller the box.
   */
  class FormulaBound
  {
  public:
    explicit FormulaBound(std::shared_ptr<const Formula> formula);

    /// Infinite where the formula may jump at a time, or where nothing can be said.
    Enclosure
    operator()(const ActiveStress::Box &box);

  private:
    const std::shared_ptr<const Formula> formula_;
    std::vector<Enclosure> values_, arguments_;
  };
} // namespace crawler
