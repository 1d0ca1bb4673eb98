// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// The @p count names of @p candidates closest to @p name (edit distance, ignoring case),
  /// best first; names that have nothing in common with it are left out.
  std::vector<std::string>
  nearest_names(const std::string &name, const std::vector<std::string> &candidates, unsigned int count = 3);

  /// "; the nearest is ...", to follow a list of what is expected where @p name was found; empty if none is near.
  std::string
  nearest_hint(const std::string &name, const std::vector<std::string> &candidates);

  /// The candidate of which @p name is most likely a misspelling, with at most a third of its letters wrong; nothing if
  /// there is none.
  std::vector<std::string>
  nearly_alike(const std::string &name, const std::vector<std::string> &candidates);

  /// "a", "b" or "c": a list in quotation marks for a sentence.
  std::string
  quoted_list(const std::vector<std::string> &names);
} // namespace crawler
