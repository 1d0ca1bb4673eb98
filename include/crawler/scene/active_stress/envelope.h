// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// Entries that several generators share: where along the body, and from when on, they act.
  struct EnvelopeParameters
  {
    std::optional<double> window_start, window_end; ///< [length]; nothing: the end of the body
    double window_edge   = 0.;                      ///< [length]
    double ramp_duration = 0.;                      ///< [time]

    /// Declares Window start, Window end, Window edge and Ramp duration in the present section.
    void
    add_parameters(Declarations &declarations);
  };

  /**
   * A factor window(s) ramp(t) of an active stress. The window is 1 from its start to its end and 0 outside; its edges
   * are smooth steps (profile.h) of a given width that lie inside of it, or jumps if the width is 0; where its start or
   * end is not given it has no edge. The ramp is a smooth step from 0 at t = 0 to 1 at the ramp's duration.
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

    /// Its derivative [1/time].
    double
    ramp_rate(double t) const;

    /// A bound of that in [from, to].
    double
    largest_ramp_rate(double from, double to) const;

    bool
    has_ramp() const
    {
      return ramp_ > 0.;
    }

    /// Where the window jumps, in (0, L) [length].
    std::vector<double>
    breaks_in_space() const;

  private:
    const std::optional<double> start_, end_;
    const double edge_, ramp_, length_;
  };
} // namespace crawler
