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
    /// Sets the first lines @p begin and the last lines @p end of the file; writes nothing yet.
    GrowingText(const std::filesystem::path &path, const std::string &begin, const std::string &end);

    /// Adds text before the last lines. Throws FileError.
    void
    add(const std::string &text);

    /// Replaces everything added so far. Throws FileError.
    void
    restart(const std::string &text);

    /// Exchanges the length; a file that has grown since then is cut back. Throws FileError if it is shorter.
    void
    exchange(Archive &archive);

  private:
    void
    open();

    const std::filesystem::path path_;
    const std::string begin_, end_;
    std::ofstream out_;
    std::streamoff last_lines_ = 0; ///< their position in the file
  };
} // namespace crawler
