// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/enclosure.h>
#include <crawler/formula/formula.h>

namespace crawler
{
  /**
   * Encloses a formula of s and t and its derivative by t in boxes: interval arithmetic with forward-mode automatic
   * differentiation (Moore @cite Moore1966), without directed rounding. No event in the box is missed, however short,
   * but the enclosure may be too wide: the less so the smaller the box.
   */
  class FormulaBound
  {
  public:
    explicit FormulaBound(std::shared_ptr<const Formula> formula);

    /// Encloses for s and t in these intervals. Infinite where the formula may jump at a time, or where nothing is
    /// known.
    Enclosure
    operator()(const Interval &s, const Interval &t);

  private:
    const std::shared_ptr<const Formula> formula_;
    std::vector<Enclosure> values_, arguments_;
  };
} // namespace crawler
