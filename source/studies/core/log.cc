// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/studies/core/log.h>

#include <iostream>

namespace crawler
{
  Log::Log(const bool is_first_rank, const bool quiet)
    : active_(is_first_rank)
    , quiet_(quiet)
  {
  }

  void
  Log::line(const std::string &raw)
  {
    if (!active_)
      return;
    const std::string text = without_controls(with_plain_numbers(raw));
    if (!quiet_)
      std::cout << text << std::endl;
    keep(text);
  }

  void
  Log::warn(const std::string &raw)
  {
    if (!active_)
      return;
    const std::string text = without_controls(with_plain_numbers(raw));
    std::cerr << "crawler: " << text << std::endl;
    keep(text);
  }

  void
  Log::keep(const std::string &text)
  {
    if (file_.is_open())
      file_ << text << std::endl;
    else
      earlier_ += text + '\n';
  }

  void
  Log::open(const std::filesystem::path &file, const bool append)
  {
    if (!active_)
      return;
    file_.open(file, append ? std::ios::app : std::ios::trunc);
    file_ << earlier_ << std::flush;
    if (!file_)
      throw FileError("cannot write \"" + file.string() + "\"");
  }
} // namespace crawler
