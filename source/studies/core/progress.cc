// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/terminal.h>
#include <crawler/studies/core/progress.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Number of characters of a text in UTF-8.
    std::size_t
    length_of(const std::string &text)
    {
      return static_cast<std::size_t>(std::ranges::count_if(text, [](const char c) { return (c & 0xC0) != 0x80; }));
    }

    /// Draws a bar of @p n characters, filled from @p first to @p last (from 0 to 1).
    std::string
    bar_text(const double first, const double last, const unsigned int n)
    {
      const bool utf8 = terminal_has_utf8();
      const auto at   = [n](const double x) { return static_cast<unsigned int>(std::lround(x * n)); };
      std::string text;
      for (unsigned int i = 0; i < n; ++i)
        text += i >= at(first) && i < at(last) ? (utf8 ? "█" : "#") : (utf8 ? "░" : "-");
      return text;
    }
  } // namespace

  std::string
  duration_in_words(const double seconds)
  {
    return seconds <= 0.       ? "0 s"
           : seconds < 0.01    ? fmt::format("{:.2g} ms", 1e3 * seconds)
           : seconds < 1.      ? fmt::format("{:.0f} ms", 1e3 * seconds)
           : seconds < 10.     ? fmt::format("{:.1f} s", seconds)
           : seconds < 120.    ? fmt::format("{:.0f} s", seconds)
           : seconds < 7200.   ? fmt::format("{:.0f} min", seconds / 60.)
           : seconds < 172800. ? fmt::format("{:.1f} h", seconds / 3600.)
                               : fmt::format("{:.1f} days", seconds / 86400.);
  }

  bool
  ProgressBar::is_bar_due() const
  {
    constexpr double between_bars = 0.1; // [s]
    return log_.status_width() > 0 && now() >= last_bar_ + between_bars;
  }

  void
  ProgressBar::show(const std::optional<double> done, const std::string &text, const std::string &line_of_log)
  {
    if (is_line_due())
    {
      last_line_ = now();
      log_.progress(line_of_log);
    }
    if (!is_bar_due())
      return;
    last_bar_                    = now();
    const double gone            = seconds();
    constexpr unsigned int n_bar = 24;
    const double swing           = 0.5 - 0.5 * std::cos(2. * gone); // position of a moving bar
    std::string line =
      done
        ? fmt::format("{} {:3.0f} %  {}",
                      bar_text(0., *done, n_bar),
                      100. * *done,
                      *done > 0. ? duration_in_words(gone * (1. - *done) / *done) + " left" : "time left not known yet")
        : fmt::format("{}  {}", bar_text(0.8 * swing, 0.8 * swing + 0.2, n_bar), duration_in_words(gone));
    line += "  " + text;
    while (length_of(line) >= log_.status_width() && !line.empty())
    {
      while (line.size() > 1 && (line.back() & 0xC0) == 0x80)
        line.pop_back();
      line.pop_back();
    }
    log_.show_status(line);
  }

  void
  WaitProgress::step()
  {
    if (bar_.is_due())
      bar_.show(std::nullopt, what_, fmt::format("  {} ... {:.0f} s", what_, bar_.seconds()));
  }
} // namespace crawler
