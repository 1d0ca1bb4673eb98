// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  /// By what numbers in the unit @p found ("mm", as in a file, may be empty) are multiplied: the number @p wanted, or
  /// the factor that turns them into the unit @p wanted ("m"). Known are m, s, min, h, N, Pa, g, 1, % and the former
  /// with n, u, m, c, k, M before them. Throws InputError for the option @p option.
  double
  unit_factor(const std::string &found, const std::string &wanted, const std::string &option);
} // namespace crawler
