// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/usual_size.h>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crawler
{
  /// Before the name of a field: its range in pictures (two numbers), in the field data of kymograph.vts.
  constexpr std::string_view shown_prefix = "shown_";

  /// What a KymographWriter has written: fields on a grid over body and time.
  struct KymographTable
  {
    std::vector<double> places; ///< s/L, ascending
    std::vector<double> times;  ///< t/T, ascending; jumps of the active stress are there twice
    std::vector<std::pair<std::string, std::vector<double>>> fields; ///< name, and values [time][place]
    std::map<std::string, FieldRange> shown;                         ///< of the fields, in pictures
  };

  /// Reads kymograph.vts. Throws FileError if it cannot be read, InputError if it is no such file or is damaged.
  KymographTable
  read_kymograph(const std::filesystem::path &path);
} // namespace crawler
