// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace crawler
{
  class Kymograph;

  /// The stretch of a kymograph as a picture of characters for a terminal of so many columns: head (s = L) above, time
  /// to the right, compressed parts dark. @p n_times: that it has at the end; if these are more than fit, the last ones
  /// are shown. Nothing as long as there is nothing.
  std::vector<std::string>
  text_kymograph(const Kymograph &kymograph, std::size_t n_times, unsigned int width);
} // namespace crawler
