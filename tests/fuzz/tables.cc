// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Tables that users give: the first byte chooses the reader; behind it stands the text, or what is changed in an HDF5
// file.
#include <crawler/base/csv_numbers.h>
#include <crawler/base/files.h>
#include <crawler/base/grid_table.h>
#include <crawler/base/hdf5_calls.h>

#include <fstream>
#include <vector>

#include "fuzz.h"

namespace
{
  using namespace crawler;

  /// Whole HDF5 tables of several layouts.
  std::string
  hdf5_table(const unsigned int kind)
  {
    const std::filesystem::path path = fuzz::scratch() / "whole.h5";
    {
      const bool is_new = kind == 3; // the newer format of headers
      const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      if (is_new)
        H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110);
      const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
      const auto write = [&](const char *name, const std::vector<hsize_t> &extents, const std::vector<double> &values) {
        const Hdf5Handle space(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose),
          creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        if (kind == 1 || is_new)
        {
          H5Pset_chunk(creation, static_cast<int>(extents.size()), extents.data());
          H5Pset_shuffle(creation);
          H5Pset_deflate(creation, 6);
          if (is_new)
            H5Pset_fletcher32(creation);
        }
        const hid_t type = kind == 2 ? H5T_STD_I16BE : H5T_IEEE_F64LE;
        const Hdf5Handle dataset(H5Dcreate(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
        fuzz::require(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
                      "a table can be written");
      };
      write("s", {3}, {0., 1., 2.});
      write("t", {2}, {0., 1.});
      write("m", {2, 3}, {0., 1., 0., 1., 2., 1.});
    }
    return read_whole_file(path);
  }

  const std::filesystem::path &
  file_of(const std::string &content)
  {
    static const std::filesystem::path path = fuzz::scratch() / "table";
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
} // namespace

int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  fuzz::Bytes bytes(data, size);
  const unsigned int kind = bytes.number<std::uint8_t>() % 8;
  fuzz::is_accepted([&]() {
    if (kind == 0)
      csv_numbers(bytes.rest(), {"s", "value"}, "table", "");
    else if (kind <= 3)
      read_grid_table(file_of(bytes.rest()), "m", 0, "");
    else
    {
      static const std::vector<std::string> files = {hdf5_table(0), hdf5_table(1), hdf5_table(2), hdf5_table(3)};
      read_grid_table(file_of(fuzz::damaged(files[kind - 4], bytes)), "m", 0, "");
    }
  });
  return 0;
}
