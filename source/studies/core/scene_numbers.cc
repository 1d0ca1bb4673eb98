// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/listed_numbers.h>
#include <crawler/studies/core/entry_rules.h>
#include <crawler/studies/core/scene_numbers.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Numbers of the scene that entries of other sections may name: those of the body, the ground and the active
    /// stress, and the end time; those of lists and constants of formulas one by one, "Section/Entry[2]",
    /// "Section/Entry[a]".
    class SceneNumbers
    {
    public:
      explicit SceneNumbers(const Form &form)
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

      /// Paths of the numbers that have an effect.
      const std::vector<std::string> &
      effective() const
      {
        return effective_;
      }

      /// Returns the path of the number that the entry @p own calls @p name. Throws InputError for @p own, with the
      /// nearest name, unless it is a number of the scene that has an effect; @p or_else is what else is expected.
      std::string
      find(const std::string &name, const std::string &own, const std::string &or_else = "") const
      {
        std::string path = normal_path(name);
        const auto word  = split_path(own).back();
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
            refuse_entry(own, "{}", error.what());
          }
        if (!is_in(all_))
        {
          for (const EntryInfo &entry : declarations_.entries())
            if (entry.path == path && entry.expected.starts_with("a whole number"))
              refuse(own,
                     "{} has \"{}\", which is a whole number and so has no derivatives; numbers are "
                     "expected{}, and whole numbers as cases of section Sweep",
                     word,
                     path,
                     or_else);
          const auto near = nearest_names(path, all_, 1);
          refuse(own,
                 "{} has \"{}\", but entries of the body, the ground, the active stress or the end time that are "
                 "numbers are expected{}{}",
                 word,
                 trimmed(name),
                 or_else,
                 near.empty() ? "" : "; the nearest name is " + quoted_list(near));
        }
        if (!is_in(effective_))
          refuse(own,
                 "{} has \"{}\", but that has no effect with the other settings; entries that have "
                 "one are expected",
                 word,
                 path);
        return path;
      }

    private:
      const Declarations &declarations_;
      std::vector<std::string> all_, effective_;
    };

    /// Expands "List[2-4]" and "List[*]" to several numbers of a list, "Constants[*]" to all constants.
    std::vector<std::string>
    expanded(const std::string &name, const Declarations &declarations, const std::string &own)
    {
      const auto bracket = name.find('[');
      if (bracket == std::string::npos || !name.ends_with(']'))
        return {name};
      const std::string list = trimmed(name.substr(0, bracket));
      const std::string what = trimmed(name.substr(bracket + 1, name.size() - bracket - 2));
      const auto dash        = what.find('-');
      std::vector<std::string> names;
      if (what == "*")
        for (const ListedNumber &one : listed_numbers(declarations.info(list), declarations.value(list)))
          names.push_back(fmt::format("{}[{}]", list, one.key));
      else if (dash == std::string::npos)
        return {name};
      else
      {
        const auto from = to_number(trimmed(what.substr(0, dash))), to = to_number(trimmed(what.substr(dash + 1)));
        constexpr double most = 10000.;
        if (!from || !to || !(1. <= *from && *from <= *to && *to <= most) || *from != std::floor(*from) ||
            *to != std::floor(*to))
          refuse_entry(
            own, "found \"{}\", but two whole numbers from 1 to {} are expected in the brackets, as [1-5]", name, most);
        for (double i = *from; i <= *to; ++i)
          names.push_back(fmt::format("{}[{:.0f}]", list, i));
      }
      if (names.empty())
        refuse_entry(own,
                     "\"{0}\" is \"{2}\", so \"{1}\" is not a number; a list with its numbers is expected there",
                     list,
                     name,
                     declarations.value(list));
      return names;
    }

    /// Parses "FROM to TO".
    std::pair<double, double>
    read_range(const std::string &text, const std::string &name, const std::string &own)
    {
      const auto word = text.find(" to ");
      const auto from = word == std::string::npos ? std::nullopt : to_number(trimmed(text.substr(0, word)));
      const auto to   = word == std::string::npos ? std::nullopt : to_number(trimmed(text.substr(word + 4)));
      if (!from || !to || !(*from < *to))
        refuse_entry(own,
                     "found the range \"{}\" for \"{}\", but \"FROM to TO\" with increasing numbers is expected",
                     trimmed(text),
                     name);
      return {*from, *to};
    }

    /// Parses "0.1" or "5 %".
    SensitivityEntry
    uncertain_entry(const std::string &text, const std::string &path, const std::string &own)
    {
      const std::string given = trimmed(text);
      const bool is_part      = given.ends_with('%');
      const auto number       = to_number(trimmed(is_part ? given.substr(0, given.size() - 1) : given));
      if (!number || !(*number > 0.) || !std::isfinite(*number))
        refuse(
          own, "Uncertainty has \"{}\" for \"{}\", but a positive number, or one with %, is expected", given, path);
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
        refuse("Output/Uncertainty", "Uncertainty has \"{}\" twice, but each entry is expected only once", one.path);
      else if (one.deviation > 0.)
        *same = one;
    }
  } // namespace

  std::vector<Variable>
  read_variables(Form &form, const std::string &entry)
  {
    std::string list = trimmed(form.declarations.value(entry));
    if (list.empty())
      refuse(
        entry, "\"{}\" is empty, but \"Section/Entry : FROM to TO\" is expected: the entries that may vary", entry);
    const SceneNumbers numbers(form);
    std::vector<Variable> variables;
    if (list.ends_with(';'))
      list.pop_back();
    for (const std::string &part : split_parts(list, ';'))
    {
      const auto colon = part.rfind(':');
      if (colon == std::string::npos)
        refuse_entry(entry, "found \"{}\", but \"Section/Entry : FROM to TO\" is expected", trimmed(part));
      for (const std::string &name : expanded(normal_path(part.substr(0, colon)), form.declarations, entry))
      {
        const std::string path = numbers.find(name, entry);
        const auto [from, to]  = read_range(part.substr(colon + 1), path, entry);
        const std::string text = form.declarations.value(path);
        const double start     = to_number(text).value_or(NAN);
        if (!(from <= start && start <= to))
          refuse_entry(entry,
                       "\"{}\" is {} in this file, but the start is expected in its range, from {} to {}",
                       path,
                       text,
                       to_text(from),
                       to_text(to));
        constexpr double widest = 1e8;
        if (!(to - from <= widest * std::max(std::abs(start), 1.)))
          refuse_entry(
            entry,
            "the range of \"{}\", from {} to {}, is more than {:g} times the start, {}, or 1; a narrower one is "
            "expected",
            path,
            to_text(from),
            to_text(to),
            widest,
            text);
        if (std::ranges::find(variables, path, &Variable::path) != variables.end())
          refuse_entry(entry, "\"{}\" is given twice, but is expected only once", path);
        const EntryKind kind = form.declarations.info(path).values.kind;
        for (const double end : {from, to})
          try
          {
            const Parameters parameters = form.parameters_with(path, end);
            if (kind == EntryKind::profile || kind == EntryKind::constants) // the formula limits their values
              parameters.create_scene();
          }
          catch (const InputError &error)
          {
            refuse_entry(entry, "the range of \"{}\": {}", path, error.what());
          }
        variables.push_back({path, from, to, start});
      }
    }
    return variables;
  }

  std::vector<Variable>
  read_variables(const ParameterFile &file, const std::string &entry)
  {
    Form form(file);
    return file.placing_errors([&]() { return read_variables(form, entry); });
  }

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
        if (trimmed(name) == "all")
          refuse_entry("Output/Sensitivities", "\"all\" stands beside other entries, but is expected alone");
        else
          add(list, {numbers.find(name, "Output/Sensitivities", ", or \"all\""), 0.});
    const std::string own = "Output/Uncertainty";
    for (const std::string &one : parts_of(output.uncertainty, ';'))
    {
      const auto colon = one.find(':');
      if (colon == std::string::npos)
        refuse(own,
               "Uncertainty has \"{}\", but an entry, a colon and its standard deviation are "
               "expected, like Body/Elastic modulus : 5 %",
               one);
      const std::string path = numbers.find(one.substr(0, colon), own);
      add(list, uncertain_entry(one.substr(colon + 1), path, own));
    }
    return list;
  }
} // namespace crawler
