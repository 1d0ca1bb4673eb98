// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  class Declarations;

  /// Entries shared by several generators: where along the body, and from when on, they act.
  struct EnvelopeParameters
  {
    std::optional<double> window_start, window_end; ///< [length]; unset: the end of the body
    double window_edge   = 0.;                      ///< [length]
    double ramp_duration = 0.;                      ///< [time]

    /// Declares Window start, Window end, Window edge and Ramp duration in the present section.
    void
    add_parameters(Declarations &declarations);
  };

  /// The factor ramp(t) of an active stress: a smooth step (wave_entries.h) from 0 at t = 0 to 1 at its end, or 1 if
  /// that is 0.
  struct Ramp
  {
    double end; ///< [time]

    double
    value(double t) const;

    /// Derivative [1/time].
    double
    rate(double t) const;

    /// Bounds in [from, to] of the product of the ramp and a factor with @p bounds.
    ActiveStress::Bounds
    ramped(ActiveStress::Bounds bounds, double from, double to) const;
  };

  /// An interval of s or of t as given by its entries; no numbers: everywhere.
  struct WindowEntries
  {
    std::vector<double> interval; ///< from, to
    double edge_width = 0.;
  };

  /**
   * The factor W(x), 1 in the window [from, to) and 0 outside, with smooth steps S (wave_entries.h) of the edge width
   * inside both ends, W(x) = S((x - from)/width) S((to - x)/width), or jumps if the width is 0 (but one that ends with
   * the range includes its end). A window that begins before 0 by the edge width, or ends as much after the end of the
   * range, has no edge there; without interval it is 1 everywhere.
   */
  class Window
  {
  public:
    /// Makes a window in 0 <= x <= @p end. @p variable is "s" or "t"; @p section the path of the entries, with a slash
    /// at the end. Throws InputError unless there are no or two numbers, increasing, that meet the range and leave room
    /// for edges.
    Window(const WindowEntries &entries, char variable, const std::string &section, double end);

    /// Makes a window along the body; a start or end that is not given has no edge. Throws InputError if the window is
    /// empty, reaches beyond the body, or is shorter than its edges.
    Window(const EnvelopeParameters &parameters, const std::string &section, double length);

    double
    value(double x) const;

    /// Derivative, without the jumps.
    double
    rate(double x) const;

    /// The largest value, and a bound of the largest |derivative|, in [from, to].
    std::pair<double, double>
    largest(double from, double to) const;

    /// Places in (0, end) where it jumps.
    std::vector<double>
    breaks() const
    {
      return edge_ == 0. ? ends() : std::vector<double>();
    }

    /// Places in (0, end) where it begins and ends, with or without edges; between them nothing can be missed.
    std::vector<double>
    ends() const;

    /// Place from which on it is constant up to the end of the range.
    double
    constant_from() const;

    /// True if it is 1 on the whole range.
    bool
    is_whole() const
    {
      return from_ + edge_ <= 0. && to_ - edge_ >= end_;
    }

    /// Description for the log; empty if it is whole.
    std::string
    in_words() const;

  private:
    const char variable_;
    const double end_;
    const double edge_;
    double from_ = -HUGE_VAL, to_ = HUGE_VAL;
  };
} // namespace crawler
