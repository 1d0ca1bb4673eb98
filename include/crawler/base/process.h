// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// Runs another program without input and output and waits for its end. True if it started and ended with status 0.
  bool
  run_silently(const std::vector<std::string> &command);
} // namespace crawler
