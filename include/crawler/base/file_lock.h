// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>

namespace crawler
{
  /// A file that one process at a time may have locked (flock). The lock ends with the process, however it ends; the
  /// file stays. It keeps two programs from writing to the same folder, on file systems that have locks.
  class FileLock
  {
  public:
    /// Makes the file if there is none, and does not wait. Throws FileError if it cannot be made.
    explicit FileLock(const std::filesystem::path &path);
    ~FileLock();
    FileLock(const FileLock &) = delete;

    enum class State
    {
      mine,
      of_another_process,
      not_offered ///< by the file system
    };

    /// Tries again unless the lock is there. The file may have been removed by the process that had the lock.
    State
    lock();

    /// Throws FileError if the file is not that of its name any more: its folder was removed or replaced.
    void
    require_in_place() const;

    /// Removes the file of a lock that is mine; to be called when nothing is written any more.
    void
    remove();

  private:
    void
    open();
    bool
    is_in_place() const;

    const std::filesystem::path path_;
    int file_    = -1;
    State state_ = State::of_another_process;
  };
} // namespace crawler
