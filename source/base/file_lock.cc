// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/file_lock.h>

#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace crawler
{
  FileLock::FileLock(const std::filesystem::path &path)
    : path_(path)
  {
    open();
  }

  FileLock::~FileLock()
  {
    ::close(file_);
  }

  void
  FileLock::open()
  {
    if (file_ >= 0)
      ::close(file_);
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0)
      throw FileError("cannot write \"" + path_.string() + "\": " + std::strerror(errno));
  }

  FileLock::State
  FileLock::lock()
  {
    while (state_ == State::of_another_process)
    {
      if (::flock(file_, LOCK_EX | LOCK_NB) != 0)
      {
        if (errno == EINTR)
          continue;
        if (errno != EWOULDBLOCK)
          state_ = State::not_offered;
        break;
      }
      if (is_in_place())
        state_ = State::mine;
      else
        open();
    }
    return state_;
  }

  bool
  FileLock::is_in_place() const
  {
    struct stat mine, present;
    return ::fstat(file_, &mine) == 0 && ::lstat(path_.c_str(), &present) == 0 && mine.st_ino == present.st_ino &&
           mine.st_dev == present.st_dev;
  }

  void
  FileLock::require_in_place() const
  {
    if (!is_in_place())
      throw FileError("\"" + path_.parent_path().string() +
                      "\" was removed or replaced by another program while this one wrote to it: its \"" +
                      path_.filename().string() + "\" no longer exists");
  }

  void
  FileLock::remove()
  {
    if (state_ != State::of_another_process && is_in_place())
      ::unlink(path_.c_str());
  }
} // namespace crawler
