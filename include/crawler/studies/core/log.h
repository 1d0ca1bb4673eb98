// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace crawler
{
  struct CommandOptions;

  /// Lines for the user, on the screen (unless quiet) and in log.txt. Only rank 0 writes.
  class Log
  {
  public:
    Log(bool is_first_rank, bool quiet);

    /// Log of a command that computes: the first line names the program's version. No status is shown with PETSc
    /// options, which may print, too.
    Log(bool is_first_rank, const CommandOptions &options);

    Log(const Log &) = delete;
    ~Log();

    void
    line(const std::string &text)
    {
      write(text, /*on_screen=*/true);
    }

    /// Writes a line that must not be missed: on standard error, also if quiet.
    void
    warn(const std::string &text);

    /// Writes a line about the progress of the work: only in the file where a status is shown instead.
    void
    progress(const std::string &text)
    {
      write(text, /*on_screen=*/status_width_ == 0);
    }

    /// Columns of the status; 0 if none is shown, because standard output is no terminal or is quiet.
    unsigned int
    status_width() const
    {
      return status_width_;
    }

    /// Shows @p text below all lines, in place of the previous status; none if it is empty. The text must not be wider
    /// than status_width(). The next line overwrites it.
    void
    show_status(const std::string &text);

    /// Writes everything from now on, and all earlier lines, to @p file as well, after its content if @p append. Throws
    /// FileError.
    void
    open(const std::filesystem::path &file, bool append = false);

    /// Call at the end. Throws FileError if a line did not get into the file; the work went on meanwhile.
    void
    require_written() const;

  private:
    void
    write(const std::string &raw, bool on_screen);
    void
    keep(const std::string &text);
    void
    clear_status();

    const bool active_, quiet_;
    unsigned int status_width_;
    bool has_status_ = false; ///< on the screen
    std::string first_line_;  ///< still to be written
    std::string earlier_;
    std::ofstream file_;
    std::filesystem::path path_;
    std::string problem_; ///< error at the first line that was lost
  };
} // namespace crawler
