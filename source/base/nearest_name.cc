// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/nearest_name.h>

#include <algorithm>
#include <cctype>
#include <numeric>

namespace crawler
{
  namespace
  {
    std::string
    lower(std::string text)
    {
      for (char &c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return text;
    }

    /// Levenshtein distance.
    std::size_t
    edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<std::size_t> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0u);
      for (std::size_t i = 1; i <= a.size(); ++i)
      {
        std::size_t diagonal = row[0];
        row[0]               = i;
        for (std::size_t j = 1; j <= b.size(); ++j)
        {
          const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
          diagonal                      = row[j];
          row[j]                        = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
      }
      return row.back();
    }
  } // namespace

  std::vector<std::string>
  nearest_names(const std::string &name, const std::vector<std::string> &candidates, const unsigned int count)
  {
    std::vector<std::pair<std::size_t, std::string>> ranked;
    const std::string wanted = lower(name);
    for (const std::string &candidate : candidates)
    {
      const std::string other = lower(candidate);
      std::size_t distance    = edit_distance(wanted, other);
      // Names that contain each other (Length, Body length) are near although many letters differ.
      if (wanted.size() >= 3 && other.size() >= 3 &&
          (other.find(wanted) != std::string::npos || wanted.find(other) != std::string::npos))
        distance = std::min<std::size_t>(distance, 3);
      if (distance <= std::max<std::size_t>(3, std::max(wanted.size(), other.size()) / 2))
        ranked.emplace_back(distance, candidate);
    }
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    std::vector<std::string> result;
    for (const auto &[distance, candidate] : ranked)
      if (result.size() < count)
        result.push_back(candidate);
    return result;
  }

  std::string
  nearest_hint(const std::string &name, const std::vector<std::string> &candidates)
  {
    const auto near = nearest_names(name, candidates, 1);
    return near.empty() ? "" : "; the nearest is " + quoted_list(near);
  }

  std::vector<std::string>
  nearly_alike(const std::string &name, const std::vector<std::string> &candidates)
  {
    auto nearest = nearest_names(name, candidates, 1);
    if (!nearest.empty() && 3 * edit_distance(lower(name), lower(nearest[0])) > name.size())
      nearest.clear();
    return nearest;
  }

  std::string
  quoted_list(const std::vector<std::string> &names)
  {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
      text += (i == 0 ? "" : (i + 1 == names.size() ? " or " : ", ")) + ("\"" + names[i]) + "\"";
    return text;
  }
} // namespace crawler
