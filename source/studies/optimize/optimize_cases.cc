// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/optimize/optimize_cases.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    const std::string axes_entry = "Sweep/Axes";

    /// Throws InputError for an axis over the objective, the starts or the clock, which all cases share.
    void
    require_admissible(const std::string &axis)
    {
      for (const char *entry :
           {"Optimize/Objective", "Optimize/Starts", "Optimize/Start spread", "Optimize/Seed", "Optimize/Time limit"})
        if (axis == entry)
          refuse_entry(
            axes_entry, "\"{}\" is the same for all cases of an optimisation; another entry is expected", axis);
    }
  } // namespace

  OptimizeCases::OptimizeCases(MPI_Comm communicator, const ParameterFile &file)
    : points_(communicator, file, /*may_be_one=*/true)
  {
    names_.objective = objective_of(parameters().optimize);
    file.placing_errors([&]() {
      for (const SweepAxis &axis : points_.design().axes())
      {
        require_admissible(axis.entry);
        names_.axes.push_back(axis.entry);
      }
      for (unsigned long number = 0; number < size(); ++number)
        try
        {
          add_case(number);
        }
        catch (const InputError &error)
        {
          throw are_several() ? InputError(fmt::format("the case {}: {}", in_words(number), error.what()), error.entry)
                              : error;
        }
    });
    std::ranges::sort(names_.limits, {}, [](const std::string &name) {
      return std::ranges::find(limit_entries, name, &LimitEntry::name) - limit_entries.begin();
    });
  }

  void
  OptimizeCases::add_case(const unsigned long number)
  {
    const auto add = [](std::vector<std::string> &list, const std::string &name) {
      const bool is_new = std::ranges::find(list, name) == list.end();
      if (is_new)
        list.push_back(name);
      return is_new;
    };
    OptimizeNames::Case &its = names_.cases.emplace_back();
    for (std::size_t i = 0; i < names_.axes.size(); ++i)
      its.values.push_back(points_.design().value(i, number));
    const auto scenes                 = family(number);
    const Declarations &entries       = scenes->form.declarations;
    const OptimizeParameters &problem = scenes->form.parameters.optimize;
    scenes->form.parameters.create_scene();
    its.objective = objective_of(problem);
    for (const Variable &variable : scenes->variables)
    {
      its.paths.push_back(variable.path);
      if (add(names_.paths, variable.path))
        names_.units.push_back(entries.info(variable.path).unit);
    }
    for (const LimitEntry &limit : limit_entries)
      if (problem.*limit.value)
        add(names_.limits, limit.name);
  }

  std::string
  OptimizeCases::in_words(const unsigned long number) const
  {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < names_.axes.size(); ++i)
      words.push_back(split_path(names_.axes[i]).back() + " = " + names_.cases[number].values[i]);
    return fmt::format("{}", fmt::join(words, ", "));
  }

  std::vector<std::string>
  OptimizeCases::notes(const ParameterFile &file)
  {
    VariedEntries varied = points_.varied();
    const auto first     = family(0);
    for (const Variable &variable : first->variables)
      varied.paths.push_back(variable.path);
    return notes_on_entries(file, points_.declarations(), "optimize", varied);
  }
} // namespace crawler
