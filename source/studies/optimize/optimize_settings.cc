// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/optimize/optimize_settings.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace crawler
{
  namespace
  {
    const std::string own = "Optimize/Variables";

    template <typename... Arguments>
    [[noreturn]] void
    refuse(fmt::format_string<Arguments...> sentence, Arguments &&...arguments)
    {
      throw InputError(fmt::format("\"{}\": {}", own, fmt::format(sentence, std::forward<Arguments>(arguments)...)),
                       own);
    }

    /// "List[2-4]" and "List[*]" are several numbers of a list.
    std::vector<std::string>
    expanded(const std::string &name, const Declarations &declarations)
    {
      const auto bracket = name.find('[');
      if (bracket == std::string::npos || !name.ends_with(']'))
        return {name};
      const std::string list = trimmed(name.substr(0, bracket));
      const std::string what = trimmed(name.substr(bracket + 1, name.size() - bracket - 2));
      const auto dash        = what.find('-');
      double first = 1., last = 0.;
      if (what == "*")
      {
        const std::string values = declarations.value(list);
        last                     = values.empty() ? 0. : 1. + static_cast<double>(std::ranges::count(values, ','));
      }
      else if (dash == std::string::npos)
        return {name};
      else
      {
        const auto from = to_number(trimmed(what.substr(0, dash))), to = to_number(trimmed(what.substr(dash + 1)));
        constexpr double most = 10000.;
        if (!from || !to || !(1. <= *from && *from <= *to && *to <= most) || *from != std::floor(*from) ||
            *to != std::floor(*to))
          refuse("found \"{}\", but two whole numbers from 1 to {} are expected in the brackets, as [1-5]", name, most);
        first = *from;
        last  = *to;
      }
      std::vector<std::string> names;
      for (double i = first; i <= last; ++i)
        names.push_back(fmt::format("{}[{:.0f}]", list, i));
      if (names.empty())
        refuse("\"{}\" is empty, so \"{}\" is no number; the list with its numbers, or [1-5], is expected", list, name);
      return names;
    }

    /// "FROM to TO"
    std::pair<double, double>
    read_range(const std::string &text, const std::string &name)
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

    /// Is there a limit without which the displacement would have no maximum?
    void
    require_limit(const OptimizeParameters &p, const std::vector<OptimizeVariable> &variables)
    {
      if (p.objective == "cost of transport" || p.largest_strain || p.smallest_strain || p.work || p.positive_work ||
          p.dissipation || p.mean_square_strain || p.largest_stress)
        return;
      for (const OptimizeVariable &variable : variables) // ranges are limits, but not meant as such
        if (variable.path.starts_with("Active stress/Modes/Coefficients"))
          throw InputError(
            "there is no limit on strain, stress or work: the " + p.objective +
              " has no maximum (doc/theory.md, \"Gait efficiency\"); at least one of Work, Positive work, Dissipation, "
              "Largest strain and Smallest strain, Mean-square strain, Largest stress is expected",
            own);
    }
  } // namespace

  std::vector<OptimizeVariable>
  read_variables(Form &form)
  {
    const OptimizeParameters &p = form.parameters.optimize;
    if (trimmed(p.variables).empty())
      throw InputError("Variables is empty, but \"Section/Entry : FROM to TO\" is expected: what may vary", own);
    const SceneNumbers numbers(form);
    std::vector<OptimizeVariable> variables;
    std::string list = trimmed(p.variables);
    if (list.ends_with(';'))
      list.pop_back();
    for (const std::string &part : split_parts(list, ';'))
    {
      const auto colon = part.rfind(':');
      if (colon == std::string::npos)
        refuse("found \"{}\", but \"Section/Entry : FROM to TO\" is expected", trimmed(part));
      for (const std::string &name : expanded(normal_path(part.substr(0, colon)), form.declarations))
      {
        const std::string path = numbers.find(name, own);
        const auto [from, to]  = read_range(part.substr(colon + 1), path);
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
        if (std::ranges::find(variables, path, &OptimizeVariable::path) != variables.end())
          refuse("\"{}\" is there twice, but once is expected", path);
        for (const double end : {from, to})
          try
          {
            form.parameters_with(path, end);
          }
          catch (const InputError &error)
          {
            refuse("the range of \"{}\": {}", path, error.what());
          }
        variables.push_back({path, from, to, start});
      }
    }
    if (p.smallest_strain && p.largest_strain && *p.smallest_strain == 0. && *p.largest_strain == 0.)
      refuse("no strain is allowed, so no gait moves the body; a range of strain is expected");
    require_limit(p, variables);
    return variables;
  }

  Parameters
  parameters_at(Form &form, const std::vector<OptimizeVariable> &variables, const std::vector<double> &x)
  {
    for (std::size_t i = 0; i < x.size(); ++i)
      form.declarations.set(variables[i].path, to_text(x[i]));
    return form.parameters;
  }

  std::vector<double>
  start_values(const OptimizeParameters &parameters,
               const std::vector<OptimizeVariable> &variables,
               const unsigned long number)
  {
    std::mt19937_64 random(parameters.seed * 1000003ul + number);
    std::vector<double> x;
    for (const OptimizeVariable &variable : variables)
    {
      const double part  = static_cast<double>(random() >> 11) * 0x1p-52 - 1.; // from -1 to 1, alike on all machines
      const double shift = number == 0 ? 0. : parameters.spread * part * (variable.to - variable.from);
      x.push_back(std::clamp(variable.start + shift, variable.from, variable.to));
    }
    return x;
  }
} // namespace crawler
