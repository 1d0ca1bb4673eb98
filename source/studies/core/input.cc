// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/entry_notes.h>
#include <crawler/studies/core/input.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    /// Notes on tables that continue beyond the end of the body: most likely their unit is another one.
    std::vector<std::string>
    profiles_beyond_the_body(const Scene &scene)
    {
      std::vector<std::string> notes;
      for (const auto &[entry, profile] : {std::pair("Body/Elastic modulus profile", scene.profiles.elastic_modulus),
                                           std::pair("Body/Friction profile", scene.profiles.friction),
                                           std::pair("Body/Initial stretch", scene.profiles.initial_stretch)})
      {
        const auto places = profile ? profile->breaks() : std::vector<double>();
        if (!places.empty() && places.back() > 1.001 * scene.body.length)
          notes.push_back(fmt::format("Note: the table of \"{}\" reaches to s = {:g}, but the body ends at {:g}",
                                      entry,
                                      places.back(),
                                      scene.body.length));
      }
      return notes;
    }
  } // namespace

  ParameterFile
  read_file(MPI_Comm communicator, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    const std::string text = on_first_rank(communicator, [&]() { return ParameterFile::read(file_name).text(); });
    ParameterFile file     = ParameterFile::from_text(text, file_name == "-" ? "standard input" : file_name);
    for (const std::string &assignment : overrides)
      file.add_override(assignment);
    return file;
  }

  Input
  read_input(ParameterFile file, const std::string &command)
  {
    Form form(file);
    const Parameters &parameters = form.parameters;
    try
    {
      parameters.units.require_plain();
      Scene scene = parameters.create_scene();
      VariedEntries varied;
      if ((command == "fit" || command == "check") && !trimmed(parameters.fit.variables).empty())
        for (const Variable &one : read_variables(form, "Fit/Variables"))
          varied.paths.push_back(one.path);
      auto notes = notes_on_entries(file, form.declarations, command, varied);
      add_notes_on_scene(file, parameters, scene, notes);
      std::ranges::copy(profiles_beyond_the_body(scene), std::back_inserter(notes));
      auto sensitivities = sensitivity_entries(form);
      for (const SensitivityEntry &one : sensitivities)
        if (one.is_part && to_number(form.declarations.value(one.path)) == 0.)
          refuse("Output/Uncertainty",
                 "Uncertainty has {:g} % of \"{}\", but that is 0; a number without % is expected",
                 100. * one.deviation,
                 one.path);
      return {
        std::move(file), parameters, form.effective(), std::move(scene), std::move(sensitivities), std::move(notes)};
    }
    catch (const InputError &error)
    {
      const InputError placed = file.with_place(error);
      std::string message     = placed.what();
      if (message.find("decimals are written with a point") == std::string::npos)
        for (const std::string &note : notes_on_decimal_commas(file, form.declarations)) // possible cause
          message += "; " + note.substr(note.find(": ") + 2);
      throw InputError(message, placed.entry);
    }
  }

  std::vector<std::string>
  notes_on_choice(const Input &input, const Model model, const Numerics *const numerics)
  {
    const auto is_of_numerics = [](const Assignment &assignment) {
      return assignment.path.starts_with("Discretization/") || assignment.path.starts_with("Time/") ||
             assignment.path == "Error estimate" || assignment.path == "Output/Ledger tolerance";
    };
    if (std::none_of(input.file.assignments().begin(), input.file.assignments().end(), is_of_numerics))
      return {};
    const Form form(input.file);
    const Parameters &p = form.parameters;
    ChosenValues chosen;
    if (p.model == Model::automatic)
      chosen["Model"] = word_of(model);
    if (numerics != nullptr && p.discretization.formulation == FormulationEntry::automatic)
      chosen["Discretization/Formulation"] = word_of(numerics->formulation);
    if (numerics != nullptr && p.discretization.mesh == MeshKind::automatic)
      chosen["Discretization/Mesh"] = numerics->mesh.tolerance > 0. ? "adaptive" : "uniform";
    if (numerics != nullptr && p.time.integrator == "automatic")
      chosen["Time/Integrator"] = numerics->integrator;
    const std::string any_command = "check";
    const auto known              = notes_on_entries(input.file, form.declarations, any_command);
    auto notes                    = notes_on_entries(input.file, form.declarations, any_command, {}, chosen);
    std::erase_if(notes,
                  [&](const std::string &note) { return std::find(known.begin(), known.end(), note) != known.end(); });
    return notes;
  }

  ModelChoice
  choose_model(const Input &input)
  {
    return input.file.placing_errors([&]() { return choose_model(input.parameters, input.scene); });
  }
} // namespace crawler
