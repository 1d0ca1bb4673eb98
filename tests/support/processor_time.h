// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <ctime>

namespace crawler::test
{
  /// Processor time of this process so far [s].
  inline double
  processor_seconds()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }
} // namespace crawler::test
