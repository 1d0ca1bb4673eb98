// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace crawler::test
{
  /// Expects as many numbers, each within @p tolerance of the expected one.
  inline void
  expect_near(const std::vector<double> &found,
              const std::vector<double> &expected,
              const double tolerance,
              const std::string &what = "")
  {
    ASSERT_EQ(found.size(), expected.size()) << what;
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], expected[i], tolerance) << what << ", number " << i;
  }
} // namespace crawler::test
