// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/axis.h>
#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/core/sensitivity_entries.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    /// Parses "0.1" or "5 %".
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

    /// Parts of a list, which may be empty.
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
        throw InputError(fmt::format("Uncertainty has \"{}\" twice, but each entry is expected only once", one.path),
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
    const SceneNumbers numbers(form);
    if (trimmed(output.sensitivities) == "all")
      for (const std::string &path : numbers.effective())
        list.push_back({path, 0.});
    else
      for (const std::string &name : parts_of(output.sensitivities, ','))
        add(list, {numbers.find(name, "Output/Sensitivities", ", or \"all\""), 0.});
    const std::string own = "Output/Uncertainty";
    for (const std::string &one : parts_of(output.uncertainty, ';'))
    {
      const auto colon = one.find(':');
      if (colon == std::string::npos)
        throw InputError(fmt::format("Uncertainty has \"{}\", but an entry, a colon and its standard deviation are "
                                     "expected, like Body/Elastic modulus : 5 %",
                                     one),
                         own);
      const std::string path = numbers.find(one.substr(0, colon), own);
      add(list, uncertain_entry(one.substr(colon + 1), path, own));
    }
    return list;
  }
} // namespace crawler
