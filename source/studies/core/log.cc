// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/terminal.h>
#include <crawler/base/versions.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/log.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <utility>

namespace crawler
{
  Log::Log(const bool is_first_rank, const bool quiet)
    : active_(is_first_rank)
    , quiet_(quiet)
    , status_width_(is_first_rank && !quiet ? terminal_width() : 0)
  {
  }

  Log::Log(const bool is_first_rank, const CommandOptions &options)
    : Log(is_first_rank, options.quiet)
  {
    const auto all = versions();
    first_line_    = fmt::format("crawler {} (revision {}, deal.II {}, PETSc {})",
                              all.at("crawler"),
                              all.at("revision"),
                              all.at("deal.II"),
                              all.at("PETSc"));
    if (!options.petsc_options.empty())
      status_width_ = 0;
  }

  Log::~Log()
  {
    clear_status();
    std::cout.flush();
  }

  void
  Log::write(const std::string &raw, const bool on_screen)
  {
    if (!active_)
      return;
    clear_status();
    if (const std::string first = std::exchange(first_line_, ""); !first.empty())
      write(first, /*on_screen=*/true);
    const std::string text = without_controls(with_plain_numbers(raw));
    if (!quiet_ && on_screen)
      std::cout << text << std::endl;
    keep(text);
  }

  void
  Log::warn(const std::string &text)
  {
    if (!active_)
      return;
    clear_status();
    std::cout.flush();
    const std::string plain = without_controls(with_plain_numbers(text));
    std::cerr << "crawler: " << plain << std::endl;
    keep(plain);
  }

  void
  Log::show_status(const std::string &text)
  {
    if (text.empty())
      clear_status();
    else if (status_width_ > 0)
    {
      std::cout << "\r" << text << "\x1b[K" << std::flush;
      has_status_ = true;
    }
  }

  void
  Log::clear_status()
  {
    if (has_status_)
      std::cout << "\r\x1b[K" << std::flush;
    has_status_ = false;
  }

  void
  Log::keep(const std::string &text)
  {
    if (!file_.is_open())
    {
      earlier_ += text + '\n';
      return;
    }
    file_ << text << std::endl;
    if (!file_ && problem_.empty())
      problem_ = std::strerror(errno);
    file_.clear();
  }

  void
  Log::require_written() const
  {
    if (!problem_.empty())
      throw FileError("cannot write \"" + path_.string() + "\": " + problem_);
  }

  void
  Log::open(const std::filesystem::path &file, const bool append)
  {
    if (!active_)
      return;
    path_ = file;
    file_.open(file, append ? std::ios::app : std::ios::trunc);
    file_ << earlier_ << std::flush;
    if (!file_)
      throw FileError("cannot write \"" + file.string() + "\": " + std::strerror(errno));
  }
} // namespace crawler
