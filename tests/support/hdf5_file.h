// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/hdf5_calls.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace crawler::test
{
  /// Numbers for an HDF5 file.
  struct Dataset
  {
    std::string name;
    std::vector<hsize_t> extents;
    std::vector<double> values;
  };

  inline void
  write_hdf5_file(const std::filesystem::path &path, const std::vector<Dataset> &datasets)
  {
    const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    for (const Dataset &data : datasets)
    {
      const auto rank = static_cast<int>(data.extents.size());
      const Hdf5Handle space(H5Screate_simple(rank, data.extents.data(), nullptr), H5Sclose);
      const Hdf5Handle dataset(
        H5Dcreate(file, data.name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
      if (H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.values.data()) < 0)
        throw std::runtime_error("cannot write an HDF5 file");
    }
  }
} // namespace crawler::test
