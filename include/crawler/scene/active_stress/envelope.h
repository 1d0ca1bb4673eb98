// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

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

  /**
   * A factor window(s) ramp(t) of an active stress. The window is 1 from its start to its end and 0 outside; its edges
   * are smooth steps (wave_entries.h) of a given width inside it, or jumps if the width is 0; a start or end that is
   * not given has no edge. The ramp is a smooth step from 0 at t = 0 to 1 at the ramp's duration.
   */
  class Envelope
  {
  public:
    /// @p section is the path of the entries, with a slash at the end. Throws InputError if the window is empty,
    /// reaches beyond the body, or is shorter than its edges.
    Envelope(const EnvelopeParameters &parameters, const std::string &section, double length);

    double
    window(double s) const;

    double
    ramp(double t) const;

    /// Derivative of the ramp [1/time].
    double
    ramp_rate(double t) const;

    /// Bounds in [from, to] of the product of the ramp and a factor with @p bounds.
    ActiveStress::Bounds
    ramped(ActiveStress::Bounds bounds, double from, double to) const;

    /// Time when the ramp ends [time]; 0 without one.
    double
    ramp_end() const
    {
      return ramp_;
    }

    /// Places in (0, L) where the window jumps [length].
    std::vector<double>
    breaks_in_space() const;

  private:
    const std::optional<double> start_, end_;
    const double edge_, ramp_, length_;
  };

  /// An interval of s or of t as given by its entries; no numbers: everywhere.
  struct WindowEntries
  {
    std::vector<double> interval; ///< from, to
    double edge_width = 0.;
  };

  /**
   * The factor W(x), 1 in the window [from, to] and 0 outside, with smooth steps S (wave_entries.h) of the edge width
   * inside both ends, W(x) = S((x - from)/width) S((to - x)/width), or jumps if the width is 0. A window that begins
   * before 0 by the edge width, or ends as much after the end of the range, has no edge there.
   */
  class Window
  {
  public:
    /// Makes a window in 0 <= x <= @p end. @p variable is "s" or "t"; @p section the path of the entries, with a slash
    /// at the end. Throws InputError unless there are no or two numbers, increasing, that meet the range and leave room
    /// for edges.
    Window(const WindowEntries &entries, char variable, const std::string &section, double end);

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
      return is_everywhere_ || (from_ + edge_ <= 0. && to_ - edge_ >= end_);
    }

    /// Description for the log; empty if it is whole.
    std::string
    in_words() const;

  private:
    const char variable_;
    const double end_;
    bool is_everywhere_ = true;
    double from_ = 0., to_ = 0., edge_ = 0.;
  };
} // namespace crawler
