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

    bool leaves_out_jumps = false; ///< at the times that formula_breaks() finds

    /// Encloses for s and t in these intervals. Infinite where the formula may jump at a time, or where nothing is
    /// known.
    Enclosure
    operator()(const Interval &s, const Interval &t);

    enum class Variable
    {
      s,
      t
    };

    /// Encloses the sides of operations on this variable that have several: one number for each. If @p in_steps, also
    /// of those that depend on the other variable in steps.
    std::vector<Interval>
    sides(Variable variable, const Interval &s, const Interval &t, bool in_steps);

  private:
    /// Encloses all values; see(operation) is called for each operation while its arguments are there.
    template <typename See>
    void
    compute(const Interval &s, const Interval &t, const See &see);

    const std::shared_ptr<const Formula> formula_;
    std::vector<Enclosure> values_, arguments_;
  };
} // namespace crawler
