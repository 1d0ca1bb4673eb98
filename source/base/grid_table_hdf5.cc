// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/grid_table.h>
#include <crawler/base/hdf5_calls.h>
#include <crawler/base/told_apart.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace crawler
{
  namespace
  {
    using Source = GridTableSource;

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
        if (!(values[i] - values[i - 1] > grid_round_off * std::abs(values.back() - values.front())))
          source.refuse("{0}[{1}] = {2} follows {0}[{3}] = {4} in \"{5}\", but increasing values are "
                        "expected",
                        name,
                        i,
                        told_apart(values[i], {values[i - 1]}),
                        i - 1,
                        told_apart(values[i - 1], {values[i]}),
                        source.file);
    }
  } // namespace

  GridTable
  read_hdf5_grid_table(const GridTableSource &source)
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
} // namespace crawler
