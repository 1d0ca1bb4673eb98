// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/listed_numbers.h>
#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/core/variables.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Throws InputError in the name of the entry that lists the variables.
    struct Refusal
    {
      const std::string entry;

      template <typename... Arguments>
      [[noreturn]] void
      operator()(fmt::format_string<Arguments...> sentence, Arguments &&...arguments) const
      {
        throw InputError(fmt::format("\"{}\": {}", entry, fmt::format(sentence, std::forward<Arguments>(arguments)...)),
                         entry);
      }
    };

    /// Expands "List[2-4]" and "List[*]" to several numbers of a list, "Constants[*]" to all constants.
    std::vector<std::string>
    expanded(const std::string &name, const Declarations &declarations, const Refusal &refuse)
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
          refuse("found \"{}\", but two whole numbers from 1 to {} are expected in the brackets, as [1-5]", name, most);
        for (double i = *from; i <= *to; ++i)
          names.push_back(fmt::format("{}[{:.0f}]", list, i));
      }
      if (names.empty())
        refuse("\"{0}\" is \"{2}\", so \"{1}\" is not a number; a list with its numbers is expected there",
               list,
               name,
               declarations.value(list));
      return names;
    }

    /// Parses "FROM to TO".
    std::pair<double, double>
    read_range(const std::string &text, const std::string &name, const Refusal &refuse)
    {
      const auto word = text.find(" to ");
      const auto from = word == std::string::npos ? std::nullopt : to_number(trimmed(text.substr(0, word)));
      const auto to   = word == std::string::npos ? std::nullopt : to_number(trimmed(text.substr(word + 4)));
      if (!from || !to || !(*from < *to))
        refuse("found the range \"{}\" for \"{}\", but \"FROM to TO\" with increasing numbers is expected",
               trimmed(text),
               name);
      return {*from, *to};
    }
  } // namespace

  std::vector<Variable>
  read_variables(Form &form, const std::string &entry)
  {
    const Refusal refuse{entry};
    std::string list = trimmed(form.declarations.value(entry));
    if (list.empty())
      throw InputError(
        fmt::format("\"{}\" is empty, but \"Section/Entry : FROM to TO\" is expected: the entries that may vary",
                    entry),
        entry);
    const SceneNumbers numbers(form);
    std::vector<Variable> variables;
    if (list.ends_with(';'))
      list.pop_back();
    for (const std::string &part : split_parts(list, ';'))
    {
      const auto colon = part.rfind(':');
      if (colon == std::string::npos)
        refuse("found \"{}\", but \"Section/Entry : FROM to TO\" is expected", trimmed(part));
      for (const std::string &name : expanded(normal_path(part.substr(0, colon)), form.declarations, refuse))
      {
        const std::string path = numbers.find(name, entry);
        const auto [from, to]  = read_range(part.substr(colon + 1), path, refuse);
        const std::string text = form.declarations.value(path);
        const double start     = to_number(text).value_or(NAN);
        if (!(from <= start && start <= to))
          refuse("\"{}\" is {} in this file, but the start is expected in its range, from {} to {}",
                 path,
                 text,
                 to_text(from),
                 to_text(to));
        constexpr double widest = 1e8;
        if (!(to - from <= widest * std::max(std::abs(start), 1.)))
          refuse("the range of \"{}\", from {} to {}, is more than {:g} times the start, {}, or 1; a narrower one is "
                 "expected",
                 path,
                 to_text(from),
                 to_text(to),
                 widest,
                 text);
        if (std::ranges::find(variables, path, &Variable::path) != variables.end())
          refuse("\"{}\" is given twice, but is expected only once", path);
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
            refuse("the range of \"{}\": {}", path, error.what());
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
} // namespace crawler
