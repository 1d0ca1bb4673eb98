// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/axis.h>
#include <crawler/studies/core/entry_rules.h>
#include <crawler/studies/core/sensitivity_entries.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// The entries that may be named.
    class Candidates
    {
    public:
      explicit Candidates(const Form &form)
      {
        const auto rules = entry_rules(form.parameters);
        for (std::size_t i = 0; i < form.declarations.entries().size(); ++i)
        {
          const EntryInfo &entry = form.declarations.entries()[i];
          const bool is_of_scene = entry.path.starts_with("Body/") || entry.path.starts_with("Ground/") ||
                                   entry.path.starts_with("Active stress/") || entry.path == "Time/End time";
          if (!is_of_scene || entry.expected.find("number") == std::string::npos ||
              entry.expected.starts_with("a whole number") ||
              !to_number(form.declarations.value(static_cast<unsigned int>(i))))
            continue;
          all_.push_back(entry.path);
          if (std::ranges::none_of(rules, [&](const EntryRule &rule) { return rule.is_against(entry.path); }))
            effective_.push_back(entry.path);
        }
      }

      const std::vector<std::string> &
      effective() const
      {
        return effective_;
      }

      /// The path of what the entry @p own of the user names.
      std::string
      find(const std::string &name, const std::string &own) const
      {
        const std::string path = normal_path(name);
        const auto word        = own.substr(own.rfind('/') + 1);
        if (std::ranges::find(all_, path) == all_.end())
        {
          const auto near = nearest_names(path, all_, 1);
          throw InputError(
            fmt::format(
              "{} has \"{}\", but entries of the body, the ground, the active stress or the end time that are "
              "numbers are expected{}{}",
              word,
              trimmed(name),
              word == "Sensitivities" ? ", or \"all\"" : "",
              near.empty() ? "" : "; the nearest name is " + quoted_list(near)),
            own);
        }
        if (std::ranges::find(effective_, path) == effective_.end())
          throw InputError(
            fmt::format("{} has \"{}\", but that has no effect with the other settings; entries that have "
                        "one are expected",
                        word,
                        path),
            own);
        return path;
      }

    private:
      std::vector<std::string> all_, effective_;
    };

    /// "0.1" or "5 %"
    SensitivityEntry
    uncertain_entry(const std::string &text, const std::string &path, const std::string &own)
    {
      const std::string given = trimmed(text);
      const bool is_part      = given.ends_with('%');
      const auto number       = to_number(trimmed(is_part ? given.substr(0, given.size() - 1) : given));
      if (!number || !(*number > 0.) || !std::isfinite(*number))
        throw InputError(
          fmt::format(
            "Uncertainty has \"{}\" for \"{}\", but a positive number, or one with %, is expected", given, path),
          own);
      return {path, is_part ? *number / 100. : *number, is_part};
    }

    /// The parts of a list, which may be empty.
    std::vector<std::string>
    parts_of(const std::string &list, const char separator)
    {
      return trimmed(list).empty() ? std::vector<std::string>() : split_parts(list, separator);
    }

    void
    add(std::vector<SensitivityEntry> &list, const SensitivityEntry &one)
    {
      const auto same = std::ranges::find(list, one.path, &SensitivityEntry::path);
      if (same == list.end())
        list.push_back(one);
      else if (same->deviation > 0. && one.deviation > 0.)
        throw InputError(fmt::format("Uncertainty has \"{}\" twice; each entry once is expected", one.path),
                         "Output/Uncertainty");
      else if (one.deviation > 0.)
        *same = one;
    }
  } // namespace

  std::vector<SensitivityEntry>
  sensitivity_entries(const Form &form)
  {
    const OutputParameters &output = form.parameters.output;
    std::vector<SensitivityEntry> list;
    if (!output.differentiates())
      return list;
    const Candidates candidates(form);
    if (trimmed(output.sensitivities) == "all")
      for (const std::string &path : candidates.effective())
        list.push_back({path, 0.});
    else
      for (const std::string &name : parts_of(output.sensitivities, ','))
        add(list, {candidates.find(name, "Output/Sensitivities"), 0.});
    const std::string own = "Output/Uncertainty";
    for (const std::string &one : parts_of(output.uncertainty, ';'))
    {
      const auto colon = one.find(':');
      if (colon == std::string::npos)
        throw InputError(fmt::format("Uncertainty has \"{}\", but an entry, a colon and its standard deviation are "
                                     "expected, like Body/Elastic modulus : 5 %",
                                     one),
                         own);
      const std::string path = candidates.find(one.substr(0, colon), own);
      add(list, uncertain_entry(one.substr(colon + 1), path, own));
    }
    return list;
  }
} // namespace crawler
