// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/base/file_lock.h>

#include <sys/wait.h>
#include <unistd.h>

namespace
{
  using namespace crawler;

  std::filesystem::path
  a_file()
  {
    return std::filesystem::temp_directory_path() / ("file_lock_test_" + std::to_string(::getpid()));
  }

  TEST(FileLock, OneHasItAtATime)
  {
    const auto path = a_file();
    std::optional<FileLock> one(std::in_place, path);
    FileLock other(path);
    EXPECT_EQ(one->lock(), FileLock::State::mine);
    EXPECT_EQ(other.lock(), FileLock::State::of_another_process);
    one.reset();
    EXPECT_EQ(other.lock(), FileLock::State::mine);
    other.remove();
    EXPECT_FALSE(std::filesystem::exists(path));
  }

  TEST(FileLock, WhoWaitedForARemovedFileHasTheNewOne)
  {
    const auto path = a_file();
    std::optional<FileLock> one(std::in_place, path);
    FileLock waiting(path);
    ASSERT_EQ(one->lock(), FileLock::State::mine);
    one->remove();
    one.reset();
    EXPECT_EQ(waiting.lock(), FileLock::State::mine);
    FileLock third(path);
    EXPECT_EQ(third.lock(), FileLock::State::of_another_process);
    waiting.remove();
  }

  TEST(FileLock, EndsWithTheProcess)
  {
    const auto path   = a_file();
    const pid_t child = ::fork();
    if (child == 0)
    {
      FileLock lock(path);
      ::_exit(lock.lock() == FileLock::State::mine ? 0 : 1); // nothing is destroyed
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    FileLock lock(path);
    EXPECT_EQ(lock.lock(), FileLock::State::mine);
    lock.remove();
  }

  TEST(FileLock, AFileThatCannotBeMadeIsAFileError)
  {
    EXPECT_THROW(FileLock("/nowhere/at/all"), FileError);
  }
} // namespace
