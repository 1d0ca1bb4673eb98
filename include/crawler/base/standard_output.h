// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <streambuf>
#include <string>

namespace crawler
{
  /// While this object lives std::cout writes through it, so that text which is lost (a full disk) is noticed. What
  /// others write with stdio stays in its order.
  class StandardOutput : private std::streambuf
  {
  public:
    StandardOutput();
    StandardOutput(const StandardOutput &) = delete;
    ~StandardOutput() override;

    /// Writes what still waits. Why some text was lost so far, in the system's words; empty if none was. A reader that
    /// has left, as in `crawler ... | head`, wants no more text: nothing is lost.
    std::string
    problem();

  private:
    int_type
    overflow(int_type character) override;
    std::streamsize
    xsputn(const char *text, std::streamsize n) override;
    int
    sync() override;

    void
    note(bool written);

    std::streambuf *const before_;
    int error_ = 0; ///< errno of the first loss
  };
} // namespace crawler
