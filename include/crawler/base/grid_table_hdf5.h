// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/grid_samples.h>

namespace crawler
{
  /// Reads the samples of a grid from an HDF5 file (read_grid_table()). Throws InputError.
  GridTable
  read_hdf5_grid_table(const GridTableSource &source);
} // namespace crawler
