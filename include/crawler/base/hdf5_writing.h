// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/hdf5_handle.h>

#include <filesystem>
#include <string>

namespace crawler::hdf5
{
  /// The @p result of a call that does @p what ("write", "create", "open", "read") with a file. Throws FileError if it
  /// is negative, which is how HDF5 says that the call went wrong.
  hid_t
  checked(hid_t result, const std::filesystem::path &path, const std::string &what);

  /// HDF5 cannot close a file that it could not write (it crashes at the end of the process), so first see if it can:
  /// throws FileError if there is no room for so many @p bytes beside @p path.
  void
  require_space(const std::filesystem::path &path, double bytes);

  /// Texts of so many bytes (the caller closes it). UTF-8, but labelled ASCII: Octave cannot read a group with texts
  /// that are labelled UTF-8, and to texts that are in fact ASCII, all but names of files, it makes no difference.
  hid_t
  text_type(std::size_t width);

  /// Throws FileError.
  void
  write_attribute(hid_t object, const std::string &name, const std::string &text, const std::filesystem::path &path);
} // namespace crawler::hdf5
