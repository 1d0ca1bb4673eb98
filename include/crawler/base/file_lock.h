// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>

namespace crawler
{
  /// A file that one process at a time can lock (flock). The lock ends with the process, however it ends; the file
  /// stays. Keeps two programs from writing to the same folder, on file systems that support locks.
  class FileLock
  {
  public:
    /// Creates the file if it does not exist, without waiting. Throws FileError if that fails.
    explicit FileLock(const std::filesystem::path &path);
    ~FileLock();
    FileLock(const FileLock &) = delete;

    enum class State
    {
      mine,
      of_another_process,
      not_offered ///< by the file system
    };

    /// Tries again unless locked already. The previous holder may have removed the file.
    State
    lock();

    /// Throws FileError if the file no longer has its name: its folder was removed or replaced.
    void
    require_in_place() const;

    /// Removes the file if this process holds the lock; to be called after the last write.
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
