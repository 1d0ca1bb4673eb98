// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <chrono>

namespace crawler
{
  /// Seconds of a clock that only goes forward, for differences.
  inline double
  now()
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
} // namespace crawler
