// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/input.h>

#include <sstream>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace crawler
{
  namespace
  {
    struct Rule
    {
      std::string entry; ///< or the beginning of several
      bool used;
      std::string because;
    };

    /// The sections in @p section of generators that are not used.
    void
    rules_of_generators(const std::string &section, const ActiveStressParameters &p, std::vector<Rule> &rules)
    {
      const bool is_strain = p.generator == "prescribed strain" && p.prescribed_strain.is_generated();
      for (const std::string &name : generator_names())
      {
        std::string title = name;
        title[0]          = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
        rules.push_back({section + title + "/",
                         p.generator == name || (is_strain && p.prescribed_strain.given_by == name),
                         "Generator = " + p.generator});
      }
    }

    /// Entries that have an effect only if another entry says so: a change of one that has none is worth a word.
    std::vector<std::string>
    settings_without_effect(const ParameterFile &file, const Parameters &p, const Declarations &declarations)
    {
      const auto &wave         = p.active_stress.optimal_wave;
      const std::string choice = "Choose wave by = " + wave.choose_wave_by;
      const auto &given_by     = p.active_stress.prescribed_strain.given_by;
      const std::string source = "Given by = " + given_by;
      const auto &travelling   = p.active_stress.travelling_wave;
      const auto &standing     = p.active_stress.standing_wave;
      const auto smoothed  = [](const WaveProfileParameters &profile) { return profile.profile == "smoothed square"; };
      const bool by_energy = wave.choose_wave_by == "energy";
      std::vector<Rule> rules;
      rules_of_generators("Active stress/", p.active_stress, rules);
      for (std::size_t i = 0; i < p.active_stress.sum.terms.size(); ++i)
        rules_of_generators(
          fmt::format("Active stress/Sum/Term {}/", i + 1), p.active_stress.sum.terms[i].stress, rules);
      const std::vector<Rule> details = {
        {"Active stress/Segments/Front width",
         p.active_stress.segments.switching == "smooth",
         "Switching = " + p.active_stress.segments.switching},
        {"Active stress/Prescribed strain/Strain", given_by == "expression", source},
        {"Active stress/Prescribed strain/Constants", given_by == "expression", source},
        {"Active stress/Prescribed strain/File", given_by == "table", source},
        {"Active stress/Prescribed strain/Mean strain", given_by == "wave", source},
        {"Active stress/Prescribed strain/Amplitude", given_by == "wave", source},
        {"Active stress/Prescribed strain/Wave", given_by == "wave", source},
        {"Active stress/Prescribed strain/Phase", given_by == "wave", source},
        {"Discretization/", p.model != "perturbation" && p.model != "kinematic", "Model = " + p.model},
        {"Active stress/Optimal wave/Sine coefficients", wave.shape == "Fourier", "Shape = " + wave.shape},
        {"Active stress/Optimal wave/Cosine coefficients", wave.shape == "Fourier", "Shape = " + wave.shape},
        {"Active stress/Optimal wave/Shape formula", wave.shape == "expression", "Shape = " + wave.shape},
        {"Active stress/Optimal wave/Shape constants", wave.shape == "expression", "Shape = " + wave.shape},
        {"Active stress/Optimal wave/Shape file", wave.shape == "table", "Shape = " + wave.shape},
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
        {"Output/Ledger tolerance", p.output.energy_balance, "Ledger = false"},
      };
      rules.insert(rules.end(), details.begin(), details.end());
      std::vector<std::string> notes;
      for (const Assignment &assignment : file.assignments())
      {
        const auto &entries = declarations.entries();
        const auto entry =
          std::find_if(entries.begin(), entries.end(), [&](const EntryInfo &e) { return e.path == assignment.path; });
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
    Parameters parameters;
    Declarations declarations;
    parameters.count_terms(file);
    parameters.add_parameters(declarations);
    file.apply(declarations);
    std::ostringstream effective;
    declarations.print_prm(effective);
    try
    {
      Scene scene = parameters.create_scene();
      auto notes  = settings_without_effect(file, parameters, declarations);
      for (const std::string &note : profiles_beyond_the_body(scene))
        notes.push_back(note);
      return {std::move(file), parameters, effective.str(), std::move(scene), std::move(notes)};
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
