// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/entry_rules.h>
#include <crawler/studies/core/input.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// A change of an entry that has no effect is worth a word.
    std::vector<std::string>
    settings_without_effect(const ParameterFile &file, const Parameters &p, const Declarations &declarations)
    {
      const std::vector<EntryRule> rules = entry_rules(p);
      std::vector<std::string> notes;
      for (const Assignment &assignment : file.assignments())
      {
        const auto &entries = declarations.entries();
        const auto entry =
          std::find_if(entries.begin(), entries.end(), [&](const EntryInfo &e) { return e.path == assignment.path; });
        if (entry == entries.end() || entry->default_value == assignment.value)
          continue;
        const auto rule =
          std::find_if(rules.begin(), rules.end(), [&](const EntryRule &r) { return r.is_against(assignment.path); });
        if (rule != rules.end())
          notes.push_back(fmt::format("Note: {}: \"{}\" has no effect with \"{} = {}\"",
                                      assignment.place,
                                      assignment.path,
                                      rule->chooser,
                                      rule->value));
      }
      return notes;
    }

    /// Of a table that goes on behind the end of the body most likely the unit is another one.
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
  read_input(MPI_Comm communicator, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    return read_input(read_file(communicator, file_name, overrides));
  }

  Input
  read_input(ParameterFile file)
  {
    const Form form(file);
    const Parameters &parameters = form.parameters;
    std::ostringstream effective;
    form.declarations.print_prm(effective);
    try
    {
      parameters.units.require_plain();
      Scene scene = parameters.create_scene();
      auto notes  = settings_without_effect(file, parameters, form.declarations);
      for (const std::string &note : profiles_beyond_the_body(scene))
        notes.push_back(note);
      auto sensitivities = sensitivity_entries(form);
      for (const SensitivityEntry &one : sensitivities)
        if (one.is_part && to_number(form.declarations.value(one.path)) == 0.)
          throw InputError(
            fmt::format("Uncertainty has {:g} % of \"{}\", but that is 0; a number without % is expected",
                        100. * one.deviation,
                        one.path),
            "Output/Uncertainty");
      return {
        std::move(file), parameters, effective.str(), std::move(scene), std::move(sensitivities), std::move(notes)};
    }
    catch (const InputError &error)
    {
      throw file.with_place(error);
    }
  }

  ModelChoice
  choose_model(const Input &input)
  {
    try
    {
      return choose_model(input.parameters, input.scene);
    }
    catch (const InputError &error)
    {
      throw input.file.with_place(error);
    }
  }
} // namespace crawler
