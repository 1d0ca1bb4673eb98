// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace crawler::hdf5
{
  /// True if @p read, which reads the structure of the HDF5 file @p path, terminates. HDF5 1.10 crashes on some damaged
  /// files and never ends on others, so a copy of this process tries first, once for each @p purpose and each state of
  /// a file.
  bool
  is_harmless(const std::filesystem::path &path, const std::string &purpose, const std::function<void()> &read);
} // namespace crawler::hdf5
