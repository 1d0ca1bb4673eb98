// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <string>

namespace crawler
{
  /// Names and versions of this program and of its libraries.
  std::map<std::string, std::string>
  versions();

  /// One line of them.
  std::string
  versions_in_words();
} // namespace crawler
