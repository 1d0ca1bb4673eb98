// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/drivers/input.h>
#include <crawler/parameters/declarations.h>

#include <sstream>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    /// Entries that have an effect only if another entry says so: a change of one that has none is worth a word.
    std::vector<std::string>
    settings_without_effect(const ParameterFile &file, const Parameters &p, const Declarations &declarations)
    {
      struct Rule
      {
        std::string entry; ///< or the beginning of several
        bool used;
        std::string because;
      };
      const auto &wave            = p.active_stress.optimal_wave;
      const std::string generator = "Generator = " + p.active_stress.generator,
                        choice    = "Choose wave by = " + wave.choose_wave_by;
      const auto &given_by        = p.active_stress.prescribed_strain.given_by;
      const std::string source    = "Given by = " + given_by;
      const auto &travelling      = p.active_stress.travelling_wave;
      const auto &standing        = p.active_stress.standing_wave;
      const auto smoothed         = [](const WaveProfileParameters &profile)
      {
        return profile.profile == "smoothed square";
      };
      const bool by_energy          = wave.choose_wave_by == "energy";
      const std::vector<Rule> rules = {
        {"Active stress/Optimal wave/", p.active_stress.generator == "optimal wave", generator},
        {"Active stress/Travelling wave/", p.active_stress.generator == "travelling wave", generator},
        {"Active stress/Standing wave/", p.active_stress.generator == "standing wave", generator},
        {"Active stress/Pulse/", p.active_stress.generator == "pulse", generator},
        {"Active stress/Expression/", p.active_stress.generator == "expression", generator},
        {"Active stress/Table/", p.active_stress.generator == "table", generator},
        {"Active stress/Prescribed strain/", p.active_stress.generator == "prescribed strain", generator},
        {"Active stress/Prescribed strain/Strain", given_by == "expression", source},
        {"Active stress/Prescribed strain/Constants", given_by == "expression", source},
        {"Active stress/Prescribed strain/File", given_by == "table", source},
        {"Active stress/Prescribed strain/Mean strain", given_by == "wave", source},
        {"Active stress/Prescribed strain/Amplitude", given_by == "wave", source},
        {"Active stress/Prescribed strain/Wave", given_by == "wave", source},
        {"Active stress/Prescribed strain/Phase", given_by == "wave", source},
        {"Discretization/", p.model != "perturbation" && p.model != "kinematic", "Model = " + p.model},
        {"Active stress/Optimal wave/Wave speed", !by_energy, choice},
        {"Active stress/Optimal wave/Energy", by_energy, choice},
        {"Active stress/Optimal wave/Root", by_energy, choice},
        {"Active stress/Optimal wave/Root index", wave.root == "index", "Root = " + wave.root},
        {"Active stress/Travelling wave/Frequency",
         travelling.given_by == "frequency",
         "Given by = " + travelling.given_by},
        {"Active stress/Travelling wave/Wave speed",
         travelling.given_by == "wave speed",
         "Given by = " + travelling.given_by},
        {"Active stress/Travelling wave/Duty cycle", travelling.profile.profile != "sine", "Profile = sine"},
        {"Active stress/Travelling wave/Front width",
         smoothed(travelling.profile),
         "Profile = " + travelling.profile.profile},
        {"Active stress/Standing wave/Duty cycle", standing.profile.profile != "sine", "Profile = sine"},
        {"Active stress/Standing wave/Front width",
         smoothed(standing.profile),
         "Profile = " + standing.profile.profile},
        {"Time/Order",
         p.time.integrator == "bdf" || p.time.integrator == "automatic",
         "Integrator = " + p.time.integrator},
        {"Output/Ledger tolerance", p.output.ledger, "Ledger = false"},
      };
      std::vector<std::string> notes;
      for (const Assignment &assignment : file.assignments())
      {
        const auto &entries = declarations.entries();
        const auto entry    = std::find_if(entries.begin(),
                                        entries.end(),
                                        [&](const EntryInfo &e)
                                        {
                                          return e.path == assignment.path;
                                        });
        if (entry == entries.end() || entry->default_value == assignment.value)
          continue;
        for (const Rule &rule : rules)
          if (!rule.used && assignment.path.starts_with(rule.entry))
          {
            notes.push_back(fmt::format(
              "Note: {}: \"{}\" has no effect with \"{}\"", assignment.place, assignment.path, rule.because));
            break;
          }
      }
      return notes;
    }
  } // namespace

  ParameterFile
  read_file(MPI_Comm communicator, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    const std::string text = on_first_rank(communicator,
                                           [&]()
                                           {
                                             return ParameterFile::read(file_name).text();
                                           });
    ParameterFile file     = ParameterFile::from_text(text, file_name == "-" ? "standard input" : file_name);
    for (const std::string &assignment : overrides)
      file.add_override(assignment);
    return file;
  }

  Input
  read_input(MPI_Comm communicator, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    const ParameterFile file = read_file(communicator, file_name, overrides);
    Parameters parameters;
    Declarations declarations;
    parameters.add_parameters(declarations);
    file.apply(declarations);
    std::ostringstream effective;
    declarations.print_prm(effective);
    try
    {
      Scene scene = parameters.create_scene();
      return {
        file, parameters, effective.str(), std::move(scene), settings_without_effect(file, parameters, declarations)};
    }
    catch (const InputError &error)
    {
      throw file.with_place(error);
    }
  }
} // namespace crawler
