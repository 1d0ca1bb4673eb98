// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace crawler
{
  /// What the user reads: lines on the screen (unless quiet) and in log.txt. Only rank 0 writes.
  class Log
  {
  public:
    Log(bool is_first_rank, bool quiet);

    void
    line(const std::string &text);

    /// The same for what must not be missed: on standard error, also if quiet.
    void
    warn(const std::string &text);

    /// Writes everything from now on, and all earlier lines, to @p file as well, behind what is in it if @p append.
    /// Throws FileError.
    void
    open(const std::filesystem::path &file, bool append = false);

  private:
    void
    keep(const std::string &text);

    const bool active_, quiet_;
    std::string earlier_;
    std::ofstream file_;
  };
} // namespace crawler
