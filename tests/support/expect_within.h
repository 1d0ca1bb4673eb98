// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace crawler::test
{
  /// The displacement is within its bound of what is exact, and the bound is what Accuracy asks for.
  inline void
  expect_within(const SimulationResult &result, const double exact, const double accuracy, const std::string &what)
  {
    EXPECT_EQ(result.time.status, Status::finished) << what << ": " << result.time.message;
    ASSERT_TRUE(result.error) << what;
    EXPECT_LE(std::abs(result.displacement - exact), result.error->total) << what;
    EXPECT_LE(result.error->total, accuracy * std::abs(exact) * 1.01) << what;
  }
} // namespace crawler::test
