// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// Kinds of pictures, each with the script contrib/python/crawler/plot/KIND.py: "kymograph", "sweep", ...
  std::vector<std::string>
  plot_kinds();

  /// crawler plot: draws the output folder @p path of a run or study, or the table of a calibration or of crawler
  /// table, with the script of @p kind; if this is empty, with the one that fits the files. @p options are passed on to
  /// the script. Throws InputError and FileError with the message of the script.
  void
  plot(const std::string &path, const std::string &kind, const std::vector<std::string> &options);
} // namespace crawler
