// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/grid_table.h>
#include <crawler/base/hdf5_handle.h>
#include <crawler/base/hdf5_trial.h>
#include <crawler/base/told_apart.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace crawler
{
  namespace
  {
    constexpr double round_off = 1e-12;

    /// Origin of a table, for messages.
    struct Source
    {
      std::string file, name, entry;

      template <typename... Arguments>
      [[noreturn]] void
      refuse(fmt::format_string<Arguments...> message, Arguments &&...arguments) const
      {
        throw InputError(fmt::format(message, std::forward<Arguments>(arguments)...), entry);
      }
    };

    /// Returns the distinct values, sorted; values that differ by round-off only are merged.
    std::vector<double>
    distinct(std::vector<double> values)
    {
      // Repeats in succession go first: the slower of two columns has many.
      values.erase(std::unique(values.begin(), values.end()), values.end());
      std::sort(values.begin(), values.end());
      if (!values.empty())
      {
        const double same = round_off * (values.back() - values.front());
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
      const double same = round_off * (values.back() - values.front());
      const auto above  = std::upper_bound(values.begin() + 1, values.end(), value + same);
      return static_cast<std::size_t>(above - values.begin()) - 1;
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
        else if (repetitions.is_first(numbers.rows[r]))
          repetitions.say(fmt::format("row {} of \"{}\" gives s = {:g}, t = {:g} a second time, after row {}",
                                      numbers.rows[r],
                                      source.file,
                                      s[r],
                                      t[r],
                                      seen[point]));
      }
      repetitions.refuse(source.entry);
      const auto n_gaps = std::count(seen.begin(), seen.end(), 0u);
      if (n_gaps > 0)
      {
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
                      n,
                      n_s * n_t,
                      n_s,
                      n_t,
                      n_gaps == 1 ? "is" : "are",
                      n_gaps == 1 ? "is" : "are",
                      first);
      }
      return grid;
    }

    /// A dataset's numbers and extents.
    struct Dataset
    {
      std::vector<double> values;
      std::vector<hsize_t> extents;
    };

    Dataset
    read_dataset(const hid_t file, const std::string &name, const std::string &form, const Source &source)
    {
      const auto wrong = [&](const std::string &what) {
        source.refuse(
          "\"{}\" {}, but the datasets s[ns], t[nt] and {}[nt,ns] are expected", source.file, what, source.name);
      };
      const Hdf5Handle dataset(H5Dopen(file, name.c_str(), H5P_DEFAULT), H5Dclose);
      if (dataset < 0)
        wrong("has no dataset " + name);
      const Hdf5Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
      const H5T_class_t kind = H5Tget_class(type);
      if (kind != H5T_FLOAT && kind != H5T_INTEGER)
        wrong("has a dataset " + name + " that does not hold numbers");
      const auto wanted = static_cast<std::size_t>(1 + std::count(form.begin(), form.end(), ','));
      Dataset result;
      const int rank = H5Sget_simple_extent_ndims(space);
      if (rank < 0 || static_cast<std::size_t>(rank) != wanted)
        wrong(fmt::format("has a dataset {} with {} dimensions", name, rank));
      result.extents.resize(wanted);
      H5Sget_simple_extent_dims(space, result.extents.data(), nullptr);
      constexpr std::size_t most = 1ul << 30;
      std::size_t n              = 1;
      for (const hsize_t extent : result.extents)
      {
        if (extent > 0 && n > most / extent)
          wrong(fmt::format("has a dataset {} of more than {} values", name, most));
        n *= extent;
      }
      if (n > 0 && H5Dget_storage_size(dataset) == 0)
        wrong("has a dataset " + name + " without values");
      result.values.resize(n);
      if (n > 0 && H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data()) < 0)
        wrong("has a dataset " + name + " that cannot be read");
      return result;
    }

    /// Throws InputError unless the numbers of a dataset are finite and increasing.
    void
    require_increasing(const std::vector<double> &values, const std::string &name, const Source &source)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
          source.refuse("{}[{}] in \"{}\" is {}, but a finite number is expected", name, i, source.file, values[i]);
      for (std::size_t i = 1; i < values.size(); ++i)
        if (!(values[i] - values[i - 1] > round_off * std::abs(values.back() - values.front())))
          source.refuse("{0}[{1}] = {2} follows {0}[{3}] = {4} in \"{5}\", but increasing values are "
                        "expected",
                        name,
                        i,
                        told_apart(values[i], {values[i - 1]}),
                        i - 1,
                        told_apart(values[i - 1], {values[i]}),
                        source.file);
    }

    GridTable
    read_hdf5(const Source &source)
    {
      H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); // our own message instead of HDF5's stack
      Dataset s, t, value;
      const auto read = [&]() {
        const Hdf5Handle file(H5Fopen(source.file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
        if (file < 0)
          source.refuse("\"{}\" begins like an HDF5 file, but HDF5 cannot open it", source.file);
        s     = read_dataset(file, "s", "ns", source);
        t     = read_dataset(file, "t", "nt", source);
        value = read_dataset(file, source.name, "nt,ns", source);
      };
      if (!hdf5::is_harmless(source.file, source.name, read))
        source.refuse("\"{}\" begins like an HDF5 file, but it is damaged: HDF5 crashes or hangs on it", source.file);
      read();
      GridTable grid;
      grid.s                = std::move(s.values);
      grid.t                = std::move(t.values);
      const std::size_t n_s = grid.s.size(), n_t = grid.t.size();
      if (value.extents != std::vector<hsize_t>{n_t, n_s})
        source.refuse("{0}[{1},{2}] in \"{3}\" does not match s[{4}] and t[{5}]; {0}[{5},{4}] is expected{6}",
                      source.name,
                      value.extents[0],
                      value.extents[1],
                      source.file,
                      n_s,
                      n_t,
                      value.extents == std::vector<hsize_t>{n_s, n_t}
                        ? ": the order of s and t is reversed, as MATLAB, R and Fortran store arrays"
                        : "");
      require_increasing(grid.s, "s", source);
      require_increasing(grid.t, "t", source);
      grid.values = value.values;
      for (std::size_t i = 0; i < grid.values.size(); ++i)
        if (!std::isfinite(grid.values[i]))
          source.refuse("{}[{},{}] in \"{}\" (s = {:g}, t = {:g}) is {}, but a finite number is expected",
                        source.name,
                        i / n_s,
                        i % n_s,
                        source.file,
                        grid.s[i % n_s],
                        grid.t[i / n_s],
                        grid.values[i]);
      return grid;
    }
  } // namespace

  GridTable
  read_grid_table(const std::string &file, const std::string &name, const std::string &entry)
  {
    const Source source{file, name, entry};
    if (const std::string reason = unreadable(file); !reason.empty())
      source.refuse("\"{}\" {}; a CSV or HDF5 file is expected", file, reason);
    std::ostringstream content;
    std::ifstream in(file, std::ios::binary);
    if (!in || in.peek() == std::ifstream::traits_type::eof() || !(content << in.rdbuf()))
      source.refuse("cannot read \"{}\", or it is empty; the name of a CSV file with the header s,t,{} or of "
                    "an HDF5 file is expected",
                    file,
                    name);
    const std::string text = std::move(content).str();
    return text.starts_with("\x89HDF\r\n\x1a\n") ? read_hdf5(source) : read_csv(text, source);
  }

  void
  require_number_of_values(const std::vector<double> &values,
                           const std::size_t least,
                           const std::string &name,
                           const std::string &file,
                           const std::string &entry)
  {
    if (values.size() < least)
      throw InputError(
        fmt::format(
          "\"{}\" has {} different values of {}, but at least {} are expected", file, values.size(), name, least),
        entry);
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
      throw InputError(fmt::format("\"{}\" has {} from {} to {}, but the whole {}, from 0 to {}, is expected",
                                   file,
                                   name,
                                   told_apart(values.front(), {0.}),
                                   told_apart(values.back(), {end}),
                                   what,
                                   told_apart(end, {values.back()})),
                       entry);
    values.front() = std::min(values.front(), 0.);
    values.back()  = std::max(values.back(), end);
  }
} // namespace crawler
