// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/base/file_lock.h>

namespace
{
  using namespace crawler;

  TEST(FileLock, WhoWaitedForARemovedFileHasTheNewOne)
  {
    const test::TemporaryFolder folder;
    const auto path = folder.path / "lock";
    std::optional<FileLock> one(std::in_place, path);
    FileLock waiting(path);
    ASSERT_EQ(one->lock(), FileLock::State::mine);
    one->remove();
    one.reset();
    EXPECT_EQ(waiting.lock(), FileLock::State::mine);
    FileLock third(path);
    EXPECT_EQ(third.lock(), FileLock::State::of_another_process);
  }
} // namespace
