// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/hdf5_handle.h>

#include <filesystem>
#include <string>

namespace crawler::hdf5
{
  /// Returns the @p result of a call that does @p what ("write", "create", "open", "read") with a file. Throws
  /// FileError if it is negative, HDF5's sign of a failed call.
  hid_t
  checked(hid_t result, const std::filesystem::path &path, const std::string &what);

  /// Throws FileError if there is no room for @p bytes beside @p path. HDF5 cannot close a file that it could not
  /// write: it crashes at the end of the process.
  void
  require_space(const std::filesystem::path &path, double bytes);

  /// Type of texts of @p width bytes (the caller closes it). UTF-8 labelled ASCII: Octave cannot read a group with
  /// texts labelled UTF-8, and for pure ASCII, all texts but file names, it makes no difference.
  hid_t
  text_type(std::size_t width);

  /// Writes a text attribute. Throws FileError.
  void
  write_attribute(hid_t object, const std::string &name, const std::string &text, const std::filesystem::path &path);
} // namespace crawler::hdf5
