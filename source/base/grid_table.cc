// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/grid_table.h>
#include <crawler/base/told_apart.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    using Source = GridTableSource;

    /// Returns the distinct values, sorted; values that differ by round-off only are merged.
    std::vector<double>
    distinct(std::vector<double> values)
    {
      // Repeats in succession go first: the slower of two columns has many.
      values.erase(std::unique(values.begin(), values.end()), values.end());
      std::sort(values.begin(), values.end());
      if (!values.empty())
      {
        const double same = grid_round_off * (values.back() - values.front());
        values.erase(
          std::unique(values.begin(), values.end(), [same](const double a, const double b) { return b - a <= same; }),
          values.end());
      }
      return values;
    }

    /// Returns the index of a value in distinct(), trying @p guess first.
    std::size_t
    index_of(const std::vector<double> &values, const double value, const std::size_t guess)
    {
      if (guess < values.size() && values[guess] == value)
        return guess;
      const double same = grid_round_off * (values.back() - values.front());
      const auto above  = std::upper_bound(values.begin() + 1, values.end(), value + same);
      return static_cast<std::size_t>(above - values.begin()) - 1;
    }

    /// Refuses a grid some of whose points have no row: @p seen has the number of the row of each point, or 0.
    void
    refuse_gaps(const GridTable &grid,
                const std::vector<std::size_t> &seen,
                const std::size_t n_rows,
                const Source &source)
    {
      const auto n_gaps = std::count(seen.begin(), seen.end(), 0u);
      if (n_gaps == 0)
        return;
      const std::size_t n_s = grid.s.size(), n_t = grid.t.size();
      std::string first;
      auto gap = seen.begin();
      for (unsigned int named = 0; named < 3 && gap != seen.end(); ++named, ++gap)
        if (gap = std::find(gap, seen.end(), 0u); gap != seen.end())
        {
          const auto missing = static_cast<std::size_t>(gap - seen.begin());
          first += fmt::format(
            "{}s = {:g}, t = {:g}", first.empty() ? "" : "; ", grid.s[missing % n_s], grid.t[missing / n_s]);
        }
      source.refuse("\"{}\" has {} rows after the header, but {} are expected, one for each pair of {} values of s "
                    "and {} values of t; the first that {} missing {} {} (\"crawler table IN OUT\" fills gaps)",
                    source.file,
                    n_rows,
                    n_s * n_t,
                    n_s,
                    n_t,
                    n_gaps == 1 ? "is" : "are",
                    n_gaps == 1 ? "is" : "are",
                    first);
    }

    GridTable
    read_csv(const std::string &text, const Source &source)
    {
      const CsvNumbers numbers = csv_numbers(text, {"s", "t", source.name}, source.file, source.entry);
      const auto &s = numbers.columns[0], &t = numbers.columns[1], &values = numbers.columns[2];
      GridTable grid;
      grid.s                = distinct(s);
      grid.t                = distinct(t);
      const std::size_t n_s = grid.s.size(), n_t = grid.t.size(), n = values.size();
      constexpr std::size_t max_gaps = 100; // grid points per row; above, the rows are not taken for a grid with gaps
      if (n_s * n_t > max_gaps * n)
        source.refuse("\"{}\" has {} rows after the header with {} different values of s and {} of t, but a full grid, "
                      "a row for each pair of these, is expected",
                      source.file,
                      n,
                      n_s,
                      n_t);
      grid.values.resize(n_s * n_t);
      std::vector<std::size_t> seen(n_s * n_t, 0); // number of the row
      Mistakes repetitions;
      for (std::size_t r = 0, i = 0, j = 0; r < n; ++r)
      {
        // Guesses are the next point in a file sorted by t, or by s.
        j                       = index_of(grid.t, t[r], i + 1 < n_s ? j : j + 1);
        i                       = index_of(grid.s, s[r], i + 1 < n_s ? i + 1 : 0);
        const std::size_t point = j * n_s + i;
        if (seen[point] == 0)
        {
          seen[point]        = numbers.rows[r];
          grid.values[point] = values[r];
        }
        else
          repetitions.note(numbers.rows[r], [&]() {
            return fmt::format("row {} of \"{}\" gives s = {:g}, t = {:g} a second time, after row {}",
                               numbers.rows[r],
                               source.file,
                               s[r],
                               t[r],
                               seen[point]);
          });
      }
      repetitions.report(source.entry);
      refuse_gaps(grid, seen, n, source);
      return grid;
    }
  } // namespace

  GridTable
  read_grid_table(const std::string &file, const std::string &name, const std::size_t least, const std::string &entry)
  {
    const Source source{file, name, entry};
    const std::string text =
      read_table_text(file, "the name of a CSV file with the header s,t," + name + " or of an HDF5 file", entry);
    GridTable grid = text.starts_with("\x89HDF\r\n\x1a\n") ? read_hdf5_grid_table(source) : read_csv(text, source);
    for (const auto &[variable, size] : {std::pair("s", grid.s.size()), std::pair("t", grid.t.size())})
      if (size < least)
        source.refuse(
          "\"{}\" has {} different values of {}, but at least {} are expected", file, size, variable, least);
    return grid;
  }

  void
  reach_ends(std::vector<double> &values,
             const double end,
             const std::string &name,
             const std::string &what,
             const std::string &file,
             const std::string &entry)
  {
    const double most = 1e-6 * end;
    if (values.front() > most || values.back() < end - most)
      refuse(entry,
             "\"{}\" has {} from {} to {}, but the whole {}, from 0 to {}, is expected",
             file,
             name,
             told_apart(values.front(), {0.}),
             told_apart(values.back(), {end}),
             what,
             told_apart(end, {values.back()}));
    values.front() = std::min(values.front(), 0.);
    values.back()  = std::max(values.back(), end);
  }
} // namespace crawler
