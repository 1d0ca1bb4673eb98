// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/log.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// How a script of contrib/plot ended.
  struct PictureEnd
  {
    int status;          ///< 0, that of the script, or EX_UNAVAILABLE if no Python has what it needs
    std::string problem; ///< what is wrong, in one line
  };

  /// Calls the script of this name in contrib/plot, also of an installed program, with the python3 of the PATH or, if
  /// there is none, Debian's. What the script prints is shown if @p shown.
  PictureEnd
  call_plot_script(const std::string &name, const std::vector<std::string> &arguments, bool shown);

  /// Draws the picture of a study's @p folder with the script of this name, or says in the log why there is none.
  void
  draw(const std::string &script, const std::filesystem::path &folder, Log &log);
} // namespace crawler
