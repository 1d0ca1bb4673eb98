// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/standard_output.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace crawler
{
  StandardOutput::StandardOutput()
    : before_(std::cout.rdbuf(this))
  {
  }

  StandardOutput::~StandardOutput()
  {
    std::cout.rdbuf(before_);
  }

  void
  StandardOutput::note(const bool written)
  {
    if (!written && errno != EPIPE && error_ == 0)
      error_ = errno;
  }

  // Success is what std::cout always sees: it must not fall silent after a temporary loss.

  StandardOutput::int_type
  StandardOutput::overflow(const int_type character)
  {
    if (traits_type::eq_int_type(character, traits_type::eof()))
      return traits_type::not_eof(character);
    note(std::fputc(traits_type::to_char_type(character), stdout) != EOF);
    return character;
  }

  std::streamsize
  StandardOutput::xsputn(const char *const text, const std::streamsize n)
  {
    const auto size = static_cast<std::size_t>(n);
    note(std::fwrite(text, 1, size, stdout) == size);
    return n;
  }

  int
  StandardOutput::sync()
  {
    note(std::fflush(stdout) == 0);
    return 0;
  }

  std::string
  StandardOutput::problem()
  {
    sync();
    return error_ == 0 ? "" : std::strerror(error_);
  }
} // namespace crawler
