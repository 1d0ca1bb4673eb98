// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Returns a number coprime to @p n near its golden section: its multiples modulo n visit all of n parts, spread out
  /// from the beginning. So the time left is known early, and a study that is stopped is a coarse picture of
  /// everything.
  unsigned long
  golden_stride(unsigned long n);
} // namespace crawler
