// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/clock.h>
#include <crawler/studies/core/log.h>

#include <optional>
#include <string>
#include <utility>

namespace crawler
{
  /// Duration in words: "0.83 ms", "83 s", "12 min", "3.4 h", "2.1 days".
  std::string
  duration_in_words(double seconds);

  /// Progress of a piece of work: a bar redrawn in place on a terminal, and a line every few seconds without one.
  class ProgressBar
  {
  public:
    /// @p between_lines [s]; infinite: the owner writes lines.
    ProgressBar(Log &log, const double between_lines)
      : log_(log)
      , between_lines_(between_lines)
    {
    }
    ProgressBar(const ProgressBar &) = delete;
    /// Takes the bar away.
    ~ProgressBar()
    {
      log_.show_status("");
    }

    /// True if it is time for the bar, provided that there is one, or for a line.
    bool
    is_due() const
    {
      return is_bar_due() || is_line_due();
    }

    /// Draws the bar if it is due, at @p done from 0 to 1, with the time left if it is known; without @p done, with the
    /// elapsed time. @p text stands behind the bar. Writes the @p line if it is due.
    void
    show(std::optional<double> done, const std::string &text, const std::string &line = "");

    /// Elapsed time [s].
    double
    seconds() const
    {
      return now() - start_;
    }

  private:
    bool
    is_bar_due() const;
    bool
    is_line_due() const
    {
      return now() >= last_line_ + between_lines_;
    }

    Log &log_;
    const double between_lines_;
    const double start_ = now();
    double last_bar_ = now(), last_line_ = now();
  };

  /// Progress of work of unknown length, e.g. the pilot runs that choose the numerics.
  class WaitProgress
  {
  public:
    /// @p what: "pilot runs choose mesh and time steps".
    WaitProgress(Log &log, std::string what)
      : what_(std::move(what))
      , bar_(log, /*between_lines=*/3.)
    {
    }

    /// Call after every step of the work.
    void
    step();

  private:
    const std::string what_;
    ProgressBar bar_;
  };

  inline constexpr const char *pilot_runs = "pilot runs choose mesh and time steps";
} // namespace crawler
