// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <string>

namespace crawler
{
  /// Names and versions of this program and of its libraries.
  std::map<std::string, std::string>
  versions();
} // namespace crawler
