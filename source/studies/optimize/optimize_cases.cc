// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/axis.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/optimize/optimize_cases.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace crawler
{
  namespace
  {
    const std::string axes_entry = "Sweep/Axes";

    /// Of all cases together there are one objective, one table and one clock.
    void
    require_admissible(const std::string &axis)
    {
      for (const char *entry :
           {"Optimize/Objective", "Optimize/Starts", "Optimize/Start spread", "Optimize/Seed", "Optimize/Time limit"})
        if (axis == entry)
          throw InputError(
            fmt::format("\"{}\": \"{}\" is the same for all cases of an optimisation; another entry is expected",
                        axes_entry,
                        axis),
            axes_entry);
    }
  } // namespace

  OptimizeCases::OptimizeCases(MPI_Comm communicator, const ParameterFile &file)
    : file_form_(file)
  {
    if (!trimmed(parameters().sweep.axes).empty())
      points_ = std::make_unique<SweepPoints>(communicator, file);
    try
    {
      if (points_)
        for (const SweepAxis &axis : points_->design().axes())
        {
          require_admissible(axis.entry);
          axes_.push_back(axis.entry);
        }
      for (unsigned long number = 0; number < size(); ++number)
        try
        {
          const auto its = family(number);
          its->form().parameters.create_scene();
          const std::size_t n = its->variables().size();
          n_variables_        = number == 0 ? std::pair(n, n)
                                            : std::pair(std::min(n, n_variables_.first), std::max(n, n_variables_.second));
        }
        catch (const InputError &error)
        {
          throw axes_.empty() ? error
                              : InputError(fmt::format("the case {}: {}", in_words(number), error.what()), error.entry);
        }
    }
    catch (const InputError &error)
    {
      throw file.with_place(error);
    }
  }

  std::unique_ptr<SceneFamily>
  OptimizeCases::family(const unsigned long number)
  {
    Form &form = points_ ? points_->form(number) : file_form_;
    return std::make_unique<SceneFamily>(form, read_variables_of_gait(form));
  }

  std::vector<std::string>
  OptimizeCases::values(const unsigned long number) const
  {
    std::vector<std::string> list;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      list.push_back(points_->design().value(i, number));
    return list;
  }

  std::string
  OptimizeCases::in_words(const unsigned long number) const
  {
    std::string words;
    const std::vector<std::string> list = values(number);
    for (std::size_t i = 0; i < axes_.size(); ++i)
      words += fmt::format(
        "{}{} = {}", i == 0 ? "" : ", ", axes_[i].substr(axes_[i].rfind('/') + 1 /* npos + 1 is 0 */), list[i]);
    return words;
  }

  std::vector<std::string>
  OptimizeCases::notes(const ParameterFile &file)
  {
    VariedEntries varied = points_ ? points_->varied() : VariedEntries();
    const auto first     = family(0);
    for (const Variable &variable : first->variables())
      varied.paths.push_back(variable.path);
    return notes_on_entries(file, declarations(), "optimize", varied);
  }

  SweepInputs
  OptimizeCases::inputs() const
  {
    SweepInputs inputs = points_ ? sweep_inputs(*points_) : SweepInputs();
    inputs.effective   = without_comments(effective());
    return inputs;
  }

  std::string
  OptimizeCases::effective() const
  {
    std::ostringstream text;
    declarations().print_prm(text);
    return text.str();
  }
} // namespace crawler
