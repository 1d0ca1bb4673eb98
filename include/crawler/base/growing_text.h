// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace crawler
{
  /// A text file that grows before its last lines and is complete after each addition.
  class GrowingText
  {
  public:
    /// Nothing is written yet. The file will begin with @p begin and end with @p end.
    GrowingText(const std::filesystem::path &path, const std::string &begin, const std::string &end);

    /// Throws FileError.
    void
    add(const std::string &text);

    /// Replaces all that was added. Throws FileError.
    void
    restart(const std::string &text);

    /// How much there is; a file that has grown since then becomes as it was. Throws FileError if it is shorter.
    void
    exchange(Archive &archive);

  private:
    void
    open();

    const std::filesystem::path path_;
    const std::string begin_, end_;
    std::ofstream out_;
    std::streamoff last_lines_ = 0; ///< where they begin
  };
} // namespace crawler
