// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/growing_text.h>

#include <cerrno>
#include <cstring>

namespace crawler
{
  GrowingText::GrowingText(const std::filesystem::path &path, const std::string &begin, const std::string &end)
    : path_(path)
    , begin_(begin)
    , end_(end)
  {
  }

  void
  GrowingText::add(const std::string &text)
  {
    if (!out_.is_open())
      return restart(text);
    // Replaces the end by one small write(). Replacing the file each time is quadratic, and ext4 waits for the disk
    // whenever a file replaces another one.
    out_.seekp(last_lines_);
    out_ << text + end_ << std::flush;
    if (!out_)
      throw FileError("cannot write \"" + path_.string() + "\": " + std::strerror(errno));
    last_lines_ += static_cast<std::streamoff>(text.size());
  }

  void
  GrowingText::restart(const std::string &text)
  {
    out_.close();
    write_file(path_, begin_ + text + end_);
    open();
    last_lines_ = static_cast<std::streamoff>(begin_.size() + text.size());
  }

  void
  GrowingText::open()
  {
    out_.open(path_, std::ios::binary | std::ios::in | std::ios::out); // "in" keeps the contents
    if (!out_)
      throw FileError("cannot write \"" + path_.string() + "\": " + std::strerror(errno));
  }

  void
  GrowingText::exchange(Archive &archive)
  {
    archive(last_lines_);
    if (!archive.reads() || last_lines_ == 0)
      return;
    cut_file(path_, static_cast<std::uintmax_t>(last_lines_));
    open();
    add("");
  }
} // namespace crawler
