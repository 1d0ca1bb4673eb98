// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/scene/active_stress.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace crawler
{
  /// Breaks closer than this fraction of the duration, or of the length, are one.
  constexpr double min_time_between_breaks = 1e-12, min_space_between_breaks = 1e-9;

  /// The @p places that are in (0, @p end), apart from its ends by more than round-off.
  std::vector<double>
  within(std::vector<double> places, double end);

  /// Largest number of spline knots that count as breaks: the third derivative jumps there. Where more are, cells are
  /// small anyway.
  constexpr std::size_t max_knots_of_splines = 24;

  /// Breaks of a list in (0, @p length), ascending, each once [length]; the ends of the body are none.
  std::vector<double>
  distinct_breaks_in_space(std::vector<double> places, double length);

  /// Adds to the @p places of jumps and kinks of the stretch their echoes, where a feedback that sees the stretch
  /// elsewhere has them in turn: where it, or an end of its sensor, meets one of them or an end of the body, where a
  /// point meets these, and so on [length].
  std::vector<double>
  with_echoes(std::vector<double> places, const StretchFeedback::Facts &facts, double length);

  /// Moves points at an end of the body inwards if one of the @p breaks is there: with floor(4*s/L) a fifth segment
  /// begins at s = L, which is none.
  std::vector<double>
  off_breaks_at_ends(std::vector<double> points, const std::vector<double> &breaks, double length);

  /**
   * The pieces of [0, T] between the times when the active stress, or a derivative of it, jumps, also by a feedback
   * that sees an earlier jump, or the start, after its delay. Within a piece from t_b to t_c it is evaluated at times
   * in [t_b + 2 d, t_c - d], d = 1e-12 T: the values of a generator at the very time of a break do not matter. Times
   * are in units of T.
   */
  class TimeSegments
  {
  public:
    /// Makes one piece, without breaks: times are not moved.
    TimeSegments() = default;

    /// Pieces of a duration, @p end_time T [time]. Breaks at 0 and T, or beyond, may be among those of the stress.
    TimeSegments(const ActiveStress &stress, double end_time);

    /// Times in (0, 1) where pieces meet.
    const std::vector<double> &
    breaks() const
    {
      return breaks_;
    }

    /// Goes to the first piece.
    void
    restart()
    {
      piece_ = 0;
      set_limits();
    }

    /// Goes to the next piece, which must exist.
    void
    go_on()
    {
      ++piece_;
      set_limits();
    }

    bool
    is_last() const
    {
      return piece_ == breaks_.size();
    }

    /// The end of the present piece.
    double
    end() const
    {
      return is_last() ? 1. : breaks_[piece_];
    }

    /// Time within the present piece, away from its ends, that replaces @p t.
    double
    inside(const double t) const
    {
      return std::clamp(t, from_, to_);
    }

    void
    exchange(Archive &archive)
    {
      archive(piece_);
      set_limits();
    }

  private:
    void
    set_limits();

    std::vector<double> breaks_;
    std::size_t piece_ = 0;
    bool clamps_       = false;
    double from_ = -std::numeric_limits<double>::infinity(), to_ = std::numeric_limits<double>::infinity();
  };
} // namespace crawler
