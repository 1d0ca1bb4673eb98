// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace crawler
{
  namespace
  {
    const std::string axes_entry = "Sweep/Axes";

    bool
    has_feedback(const Parameters &parameters)
    {
      try
      {
        return parameters.create_scene().active_stress->feedback() != nullptr;
      }
      catch (const InputError &) // reported in its row
      {
        return false;
      }
    }
  }

  SweepPoints::SweepPoints(MPI_Comm communicator, const ParameterFile &file, const bool may_be_one)
    : file_(file)
  {
    auto base  = std::make_unique<Form>(file);
    own_       = base->parameters;
    effective_ = base->effective();
    file_.placing_errors([&]() {
      const Assignment *const axes = file_.assignment_of(axes_entry);
      design_                      = std::make_unique<SweepDesign>(own_.sweep, axes != nullptr ? axes->folder : "");
      const auto &all_axes         = design_->axes();
      if (all_axes.empty() && !may_be_one)
        refuse(axes_entry, "\"{}\" is empty, but {} is expected", axes_entry, sweep_syntax);
      file_axis_ = static_cast<std::size_t>(std::ranges::find_if(all_axes, &SweepAxis::is_file) - all_axes.begin());
      base_      = std::move(base);
      require_scene_files(communicator);
      require_admissible_values();
      require_words();
      require_scene();
      kept_points();
      sensitivities_ = sensitivity_entries(form(0));
    });
  }

  std::vector<std::string>
  SweepPoints::scene_names() const
  {
    if (file_axis_ == design_->axes().size())
      return {};
    const std::vector<std::string> &files = design_->axes()[file_axis_].values;
    const std::set<std::string> names(files.begin(), files.end());
    return {names.begin(), names.end()};
  }

  std::vector<std::string>
  SweepPoints::notes() const
  {
    const VariedEntries varied = this->varied();
    auto notes                 = notes_on_entries(file_, declarations(), "sweep", varied);
    const bool may_differ =
      varied.may_be_all || std::ranges::any_of(varied.paths, [](const std::string &path) {
        return path.starts_with("Active stress/") || path.starts_with("Ground/") || path.starts_with("Time/");
      });
    if (may_differ)
      return notes;
    try
    {
      add_notes_on_scene(file_, base_->parameters, base_->parameters.create_scene(), notes);
    }
    catch (const InputError &) // error of a point, reported there
    {
    }
    return notes;
  }

  /// Checks the scene files. A single form serves them all: each entry is checked by itself. A sum has entries of its
  /// own.
  void
  SweepPoints::require_scene_files(MPI_Comm communicator) const
  {
    on_first_rank(communicator, [&]() {
      Form common(file_);
      for (const std::string &name : scene_names())
      {
        const ParameterFile its = scene(name);
        for (const Assignment &assignment : its.assignments())
          if (assignment.path.starts_with("Sweep/"))
            throw InputError(fmt::format("{}: \"{}\" is in a file of a sweep, but section Sweep must be in {}",
                                         assignment.place,
                                         assignment.path,
                                         file_.name()));
        if (!its.subsections("Active stress/Sum").empty())
          Form(file_, &its);
        else
          its.apply(common.declarations);
      }
    });
  }

  VariedEntries
  SweepPoints::varied() const
  {
    VariedEntries varied;
    if (const Assignment *const axes = file_.assignment_of(axes_entry))
      varied.by = axes->place;
    for (const SweepAxis &axis : design_->axes())
      if (axis.is_file())
        varied.may_be_all = true;
      else
        varied.paths.push_back(axis.entry);
    return varied;
  }

  void
  SweepPoints::require_admissible_values()
  {
    for (std::size_t number = 0; number < design_->axes().size(); ++number)
    {
      const SweepAxis &axis = design_->axes()[number];
      if (axis.is_file())
        continue;
      for (const char *section : {"Sweep/", "Tradeoff/", "Output/Sensitivities", "Output/Uncertainty"})
        if (axis.entry.starts_with(section))
          refuse_entry(axes_entry, "\"{}\" cannot vary; an entry of another section is expected", axis.entry);
      Form scratch(file_);
      require_valid(axis.entry, axis.values, axes_entry, scratch.declarations, design_->folder());
      if (axis.is_range) // most numbers in it are not whole
        require_valid(axis.entry, {design_->value(number, 0)}, axes_entry, scratch.declarations);
    }
  }

  /// Checks words by the scene that they make: a formula with an unknown name, a missing table.
  void
  SweepPoints::require_words()
  {
    for (const SweepAxis &axis : design_->axes())
      if (!axis.is_file())
        for (const std::string &word : std::set<std::string>(axis.values.begin(), axis.values.end()))
        {
          if (to_number(word))
            continue;
          const auto place = std::ranges::find(axis.values, word) - axis.values.begin();
          Form &form       = this->form(design_->is_zip() ? static_cast<unsigned long>(place) : 0);
          form.declarations.set(axis.entry, word, design_->folder());
          try
          {
            form.parameters.create_scene();
          }
          catch (const InputError &error) // another entry is at fault: the word may fit at other points
          {
            if (error.entry == axis.entry)
              refuse(axes_entry, "\"{}\", value \"{}\" of \"{}\": {}", axes_entry, word, axis.entry, error.what());
          }
        }
  }

  /// Values that do not fit together at one point are a failed row; if they do not fit at the first, the middle and the
  /// last point, the file itself is wrong.
  void
  SweepPoints::require_scene()
  {
    std::optional<InputError> wrong;
    for (const unsigned long point : {0ul, design_->n_points() / 2, design_->n_points() - 1})
      try
      {
        parameters(point).create_scene();
        return;
      }
      catch (const InputError &error)
      {
        if (!wrong)
          wrong.emplace(error);
      }
    throw InputError(*wrong);
  }

  void
  SweepPoints::require_checkable()
  {
    if (!own_.sweep.cross_check)
      return;
    const Parameters &first = parameters(0);
    if (first.model != Model::nonlinear)
      throw file_.with_place(
        InputError(fmt::format("Model is {}, but Sweep/Cross-check compares answers of the nonlinear "
                               "model; Model = nonlinear is expected",
                               word_of(first.model)),
                   "Model"));
    if (has_feedback(first))
      throw file_.with_place(InputError("Generator is strain feedback, or a sum with it, but Sweep/Cross-check must "
                                        "know the stretch of the ends in advance; another one is expected",
                                        "Active stress/Generator"));
  }

  Form &
  SweepPoints::form(const unsigned long point)
  {
    constexpr std::size_t max_forms = 64; // half a megabyte each
    const auto &axes                = design_->axes();
    const auto form_of              = [&](const std::string &name) -> Form              &{
      if (const auto known = forms_.find(name); known != forms_.end())
        return *known->second;
      if (forms_.size() == max_forms)
        forms_.clear();
      const ParameterFile its = scene(name);
      return *(forms_[name] = std::make_unique<Form>(file_, &its));
    };
    Form &form = file_axis_ < axes.size() ? form_of(design_->value(file_axis_, point)) : *base_;
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (i != file_axis_)
        form.declarations.set(axes[i].entry, design_->value(i, point), design_->folder());
    return form;
  }

  std::vector<std::string>
  SweepPoints::overrides(const unsigned long point) const
  {
    std::vector<std::string> list;
    const auto &axes = design_->axes();
    const auto add   = [&](const Declarations &declarations,
                         const std::string &path,
                         const std::string &value,
                         const std::filesystem::path &folder) {
      list.push_back(path + "=" + declarations.with_absolute_name(path, value, folder));
    };
    if (file_axis_ < axes.size())
    {
      const ParameterFile its = scene(design_->value(file_axis_, point));
      const Form its_form(file_, &its); // needed since it may have entries of its own
      for (const Assignment &assignment : its.assignments())
        add(its_form.declarations, assignment.path, assignment.value, assignment.folder);
    }
    list.insert(list.end(), file_.overrides().begin(), file_.overrides().end());
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (i != file_axis_)
        add(declarations(), axes[i].entry, design_->value(i, point), design_->folder());
    return list;
  }

  std::vector<unsigned long>
  SweepPoints::kept_points() const
  {
    const std::string entry = "Sweep/Keep fields";
    std::vector<unsigned long> list;
    if (own_.sweep.keep_fields.empty())
      return list;
    for (const std::string &text : parse_values(own_.sweep.keep_fields, entry))
    {
      const auto number = to_number(text);
      if (!number || *number != std::floor(*number) || *number < 0. ||
          *number >= static_cast<double>(design_->n_points()))
        refuse_entry(
          entry, "found \"{}\", but the number of a point, from 0 to {}, is expected", text, design_->n_points() - 1);
      list.push_back(static_cast<unsigned long>(*number));
    }
    return list;
  }
} // namespace crawler
