// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/grid_samples.h>

#include <string>
#include <vector>

namespace crawler
{
  /**
   * Reads the samples of the function @p name ("m") from a file of one of two kinds, distinguished by its first bytes:
   *  - CSV: the header s,t,NAME and one row per sample of a full grid, in any order. A byte order mark, carriage
   *    returns, blanks and empty rows do not matter; values of s (or t) that differ by round-off only (1e-12 of their
   *    range) are the same.
   *  - HDF5: datasets s[ns], t[nt], both increasing, and NAME[nt,ns] in the root group, of any type of numbers. Throws
   * InputError for @p entry, with numbers of rows (the header is row 1) or indices (from 0), if there is no such file,
   * if it does not have this form, if something is not a finite number, if a point is missing or given twice, or if
   * there are fewer than @p least values of s or t.
   */
  GridTable
  read_grid_table(const std::string &file, const std::string &name, std::size_t least, const std::string &entry);

  /// Reads the samples of a grid from an HDF5 file (read_grid_table()). Throws InputError.
  GridTable
  read_hdf5_grid_table(const GridTableSource &source);

  /// Throws InputError for @p entry unless @p values of @p name reach from 0 to @p end, the whole of @p what ("body").
  /// Gaps below a millionth of it, as in single precision, count as round-off: the first or last value is moved.
  void
  reach_ends(std::vector<double> &values,
             double end,
             const std::string &name,
             const std::string &what,
             const std::string &file,
             const std::string &entry);
} // namespace crawler
