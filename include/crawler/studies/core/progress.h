// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/clock.h>
#include <crawler/studies/core/log.h>

#include <optional>
#include <string>

namespace crawler
{
  /// Duration in words: "0.83 ms", "83 s", "12 min", "3.4 h", "2.1 days".
  std::string
  duration_in_words(double seconds);

  /// Progress of a piece of work, as a bar redrawn in place on a terminal. Without a terminal, its owners write lines.
  class ProgressBar
  {
  public:
    explicit ProgressBar(Log &log)
      : log_(log)
    {
    }
    ProgressBar(const ProgressBar &) = delete;
    /// Takes the bar away.
    ~ProgressBar()
    {
      log_.show_status("");
    }

    /// True if there is a bar, and it was drawn long enough ago to be redrawn.
    bool
    is_due() const;

    /// Draws the bar at @p done from 0 to 1, with the time left if it is known; without @p done, with the elapsed time.
    /// @p text stands behind the bar.
    void
    show(std::optional<double> done, const std::string &text);

    /// Elapsed time [s].
    double
    seconds() const
    {
      return now() - start_;
    }

  private:
    Log &log_;
    const double start_ = now();
    double last_        = now();
  };

  /// Progress of work of unknown length, e.g. the pilot runs that choose the numerics: a moving bar, or a line every
  /// few seconds.
  class WaitProgress
  {
  public:
    /// @p what: "pilot runs choose mesh and time steps".
    WaitProgress(Log &log, std::string what);

    /// Call after every step of the work.
    void
    step();

  private:
    Log &log_;
    const std::string what_;
    ProgressBar bar_;
    double next_line_; ///< [s]
  };

  inline constexpr const char *pilot_runs = "pilot runs choose mesh and time steps";
} // namespace crawler
