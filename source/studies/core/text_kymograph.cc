// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/terminal.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/studies/core/text_kymograph.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  std::vector<std::string>
  text_kymograph(const Kymograph &kymograph, const std::size_t n_times, const unsigned int width)
  {
    constexpr std::size_t n_rows = 8, most_skipped = 4;
    constexpr unsigned int margin = 6, widest = 100;
    const std::vector<double> &stretch = kymograph.rows().stretch, &times = kymograph.times();
    if (stretch.empty() || width < 2 * margin)
      return {};
    const std::vector<std::string> shades = terminal_has_utf8() ? std::vector<std::string>{"█", "▓", "▒", "░", " "}
                                                                : std::vector<std::string>{"#", "*", "+", "-", " "};
    const std::size_t columns             = std::min(width, widest) - margin;
    const std::size_t step                = std::clamp<std::size_t>((n_times + columns - 1) / columns, 1, most_skipped);
    const std::size_t n_shown             = std::min(columns, (times.size() + step - 1) / step);
    const std::size_t first               = (times.size() - 1) / step + 1 - n_shown;
    const auto [low, high]                = std::ranges::minmax(stretch);
    const double range                    = std::max(high - low, 1e-6); // a body at rest has no pattern
    std::vector<std::string> rows;
    for (std::size_t row = 0; row < n_rows; ++row)
    {
      const std::size_t point =
        static_cast<std::size_t>((n_rows - row - 0.5) / n_rows * (Kymograph::n_points - 1)); // of the middle of the row
      std::string text = row == 0 ? "head  " : row + 1 == n_rows ? "tail  " : "      ";
      for (std::size_t column = first; column < first + n_shown; ++column)
      {
        const double w   = stretch[column * step * Kymograph::n_points + point];
        const auto shade = static_cast<std::size_t>((w - low) / range * static_cast<double>(shades.size()));
        text += shades[std::min(shade, shades.size() - 1)];
      }
      rows.push_back(text);
    }
    std::string scale =
      fmt::format("      t = {:.3g} to {:.3g}; stretch {:.3g} ", times[first * step], times.back(), low);
    for (const std::string &shade : shades)
      scale += shade;
    rows.push_back(scale + fmt::format(" {:.3g}", high));
    return rows;
  }
} // namespace crawler
