// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace crawler::test
{
  /// Expects the displacement within its bound of the exact one, and the bound within Accuracy.
  inline void
  expect_within(const SimulationResult &result, const double exact, const double accuracy, const std::string &what)
  {
    EXPECT_EQ(result.time.status, Status::finished) << what << ": " << result.time.message;
    ASSERT_TRUE(result.error) << what;
    EXPECT_LE(std::abs(result.displacement - exact), result.error->total) << what;
    EXPECT_LE(result.error->total, accuracy * std::abs(exact) * 1.01) << what;
  }
} // namespace crawler::test
