// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/listed_numbers.h>
#include <crawler/studies/core/entry_rules.h>
#include <crawler/studies/core/scene_numbers.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  SceneNumbers::SceneNumbers(const Form &form)
    : declarations_(form.declarations)
  {
    const auto rules = entry_rules(declarations_);
    for (unsigned int i = 0; i < declarations_.entries().size(); ++i)
    {
      const EntryInfo &entry = declarations_.entries()[i];
      const bool is_of_scene = entry.path.starts_with("Body/") || entry.path.starts_with("Ground/") ||
                               entry.path.starts_with("Active stress/") || entry.path == "Time/End time";
      if (!is_of_scene || entry.expected.find("number") == std::string::npos ||
          entry.expected.starts_with("a whole number"))
        continue;
      const std::string value = declarations_.value(i);
      std::vector<std::string> paths;
      if (to_number(value) && entry.values.kind != EntryKind::profile) // also for a list with one number
        paths.push_back(entry.path);
      else
        for (const ListedNumber &one : listed_numbers(entry, value))
          paths.push_back(fmt::format("{}[{}]", entry.path, one.key));
      all_.insert(all_.end(), paths.begin(), paths.end());
      if (entry.values.kind == EntryKind::constants)
        for (const std::string &name : unused_constants(declarations_, entry))
          std::erase(paths, fmt::format("{}[{}]", entry.path, name));
      if (rule_against(rules, entry.path, [&](const Chooser &chooser) {
            return chooser.is_command() || chooser.fits(declarations_.value(chooser.path));
          }) == nullptr)
        effective_.insert(effective_.end(), paths.begin(), paths.end());
    }
  }

  std::string
  SceneNumbers::find(const std::string &name, const std::string &own, const std::string &or_else) const
  {
    std::string path = normal_path(name);
    const auto word  = own.substr(own.rfind('/') + 1);
    const auto is_in = [&](const std::vector<std::string> &list) {
      if (std::ranges::find(list, path) != list.end())
        return true;
      // Number of a list of one by its place, or a number behind those that a list has now.
      const std::string entry = path.substr(0, path.find('['));
      return path.ends_with(']') && declarations_.info(path).values.kind == EntryKind::numbers &&
             (std::ranges::find(list, entry) != list.end() || std::ranges::find(list, entry + "[1]") != list.end());
    };
    if (path.ends_with(']'))
      try
      {
        declarations_.value(path);
      }
      catch (const InputError &error)
      {
        throw InputError(fmt::format("\"{}\": {}", own, error.what()), own);
      }
    if (!is_in(all_))
    {
      for (const EntryInfo &entry : declarations_.entries())
        if (entry.path == path && entry.expected.starts_with("a whole number"))
          throw InputError(fmt::format("{} has \"{}\", which is a whole number and so has no derivatives; numbers are "
                                       "expected{}, and whole numbers as cases of section Sweep",
                                       word,
                                       path,
                                       or_else),
                           own);
      const auto near = nearest_names(path, all_, 1);
      throw InputError(
        fmt::format("{} has \"{}\", but entries of the body, the ground, the active stress or the end time that are "
                    "numbers are expected{}{}",
                    word,
                    trimmed(name),
                    or_else,
                    near.empty() ? "" : "; the nearest name is " + quoted_list(near)),
        own);
    }
    if (!is_in(effective_))
      throw InputError(fmt::format("{} has \"{}\", but that has no effect with the other settings; entries that have "
                                   "one are expected",
                                   word,
                                   path),
                       own);
    return path;
  }
} // namespace crawler
