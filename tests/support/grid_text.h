// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/grid_samples.h>

#include <fmt/format.h>

#include <functional>

namespace crawler::test
{
  inline GridTable
  samples(const std::vector<double> &s, const std::vector<double> &t, const std::function<double(double, double)> &f)
  {
    GridTable grid{s, t, {}};
    for (const double time : t)
      for (const double place : s)
        grid.values.push_back(f(place, time));
    return grid;
  }

  /// The rows of a file with the samples.
  inline std::vector<std::string>
  rows_of(const GridTable &grid)
  {
    std::vector<std::string> rows;
    for (std::size_t j = 0; j < grid.t.size(); ++j)
      for (std::size_t i = 0; i < grid.s.size(); ++i)
        rows.push_back(fmt::format("{},{},{}", grid.s[i], grid.t[j], grid.values[j * grid.s.size() + i]));
    return rows;
  }

  inline std::string
  joined(const std::vector<std::string> &rows, const std::string &header = "s,t,m\n", const std::string &end = "\n")
  {
    std::string text = header;
    for (const std::string &row : rows)
      text += row + end;
    return text;
  }
} // namespace crawler::test
