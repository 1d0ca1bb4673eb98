// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <streambuf>
#include <string>

namespace crawler
{
  /// Receives the output of std::cout while it lives, so that lost text (a full disk) is noticed. Output that others
  /// write with stdio keeps its order.
  class StandardOutput : private std::streambuf
  {
  public:
    StandardOutput();
    StandardOutput(const StandardOutput &) = delete;
    ~StandardOutput() override;

    /// Flushes, and returns the system's reason why text was lost so far; empty if none was. A reader that has left, as
    /// in `crawler ... | head`, wants no more text: that is no loss.
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
