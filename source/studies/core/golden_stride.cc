// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/core/golden_stride.h>

#include <cmath>
#include <numeric>

namespace crawler
{
  unsigned long
  golden_stride(const unsigned long n)
  {
    auto stride = static_cast<unsigned long>(std::ceil(0.618034 * n));
    while (std::gcd(stride, n) != 1)
      ++stride;
    return stride;
  }
} // namespace crawler
