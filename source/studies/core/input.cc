// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
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
    /// Some entries of a section (or the beginnings of their names) that have an effect only if another one, the
    /// chooser, has one of certain values.
    struct Rule
    {
      std::string section;
      std::vector<std::string> entries;
      std::string chooser, value;
      std::vector<std::string> needed;

      bool
      is_against(const std::string &path) const
      {
        return std::find(needed.begin(), needed.end(), value) == needed.end() &&
               std::any_of(entries.begin(), entries.end(), [&](const std::string &entry) {
                 return path.starts_with(section + entry);
               });
      }
    };

    /// The sections in @p section of generators that are not used.
    void
    add_rules_of_generators(const std::string &section, const ActiveStressParameters &p, std::vector<Rule> &rules)
    {
      const bool is_strain = p.generator == "prescribed strain" && p.prescribed_strain.is_generated();
      for (const std::string &name : generator_names())
      {
        std::string title = name;
        title[0]          = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
        if (!is_strain || p.prescribed_strain.given_by != name)
          rules.push_back({section, {title + "/"}, "Generator", p.generator, {name}});
      }
    }

    std::vector<Rule>
    all_rules(const Parameters &p)
    {
      const std::string stress = "Active stress/", optimal = stress + "Optimal wave/",
                        travel = stress + "Travelling wave/", stand = stress + "Standing wave/",
                        strain          = stress + "Prescribed strain/";
      const auto &wave                  = p.active_stress.optimal_wave;
      const auto &travelling            = p.active_stress.travelling_wave;
      const std::string &travel_profile = travelling.profile.profile,
                        &given_by       = p.active_stress.prescribed_strain.given_by,
                        &stand_profile  = p.active_stress.standing_wave.profile.profile;
      std::vector<Rule> rules;
      add_rules_of_generators(stress, p.active_stress, rules);
      for (std::size_t i = 0; i < p.active_stress.sum.terms.size(); ++i)
        add_rules_of_generators(
          fmt::format("{}Sum/Term {}/", stress, i + 1), p.active_stress.sum.terms[i].stress, rules);
      const std::vector<Rule> details = {
        {stress + "Segments/", {"Front width"}, "Switching", p.active_stress.segments.switching, {"smooth"}},
        {strain, {"Strain", "Constants"}, "Given by", given_by, {"expression"}},
        {strain, {"File"}, "Given by", given_by, {"table"}},
        {strain, {"Mean strain", "Amplitude", "Wave", "Phase"}, "Given by", given_by, {"wave"}},
        {"Discretization/", {""}, "Model", word_of(p.model), {"auto", "linear", "nonlinear"}},
        {optimal, {"Sine coefficients", "Cosine coefficients"}, "Shape", wave.shape, {"Fourier"}},
        {optimal, {"Shape formula", "Shape constants"}, "Shape", wave.shape, {"expression"}},
        {optimal, {"Shape file"}, "Shape", wave.shape, {"table"}},
        {optimal, {"Wave speed"}, "Choose wave by", wave.choose_wave_by, {"wave speed"}},
        {optimal, {"Energy", "Root"}, "Choose wave by", wave.choose_wave_by, {"energy"}},
        {optimal, {"Root index"}, "Root", wave.root, {"index"}},
        {travel, {"Frequency"}, "Given by", travelling.given_by, {"frequency"}},
        {travel, {"Wave speed"}, "Given by", travelling.given_by, {"wave speed"}},
        {travel, {"Duty cycle"}, "Profile", travel_profile, {"square", "smoothed square"}},
        {travel, {"Front width"}, "Profile", travel_profile, {"smoothed square"}},
        {stand, {"Duty cycle"}, "Profile", stand_profile, {"square", "smoothed square"}},
        {stand, {"Front width"}, "Profile", stand_profile, {"smoothed square"}},
        {"Time/", {"Order"}, "Integrator", p.time.integrator, {"bdf", "automatic"}},
        {"Output/", {"Ledger tolerance"}, "Ledger", p.output.energy_balance ? "true" : "false", {"true"}},
      };
      rules.insert(rules.end(), details.begin(), details.end());
      return rules;
    }

    /// A change of an entry that has no effect is worth a word.
    std::vector<std::string>
    settings_without_effect(const ParameterFile &file, const Parameters &p, const Declarations &declarations)
    {
      const std::vector<Rule> rules = all_rules(p);
      std::vector<std::string> notes;
      for (const Assignment &assignment : file.assignments())
      {
        const auto &entries = declarations.entries();
        const auto entry =
          std::find_if(entries.begin(), entries.end(), [&](const EntryInfo &e) { return e.path == assignment.path; });
        if (entry == entries.end() || entry->default_value == assignment.value)
          continue;
        const auto rule =
          std::find_if(rules.begin(), rules.end(), [&](const Rule &r) { return r.is_against(assignment.path); });
        if (rule != rules.end())
          notes.push_back(fmt::format("Note: {}: \"{}\" has no effect with \"{} = {}\"",
                                      assignment.place,
                                      assignment.path,
                                      rule->chooser,
                                      rule->value));
      }
      return notes;
    }

    /// The entries that Output/Sensitivities names, all of them numbers of the scene.
    std::vector<std::string>
    sensitivity_entries(const Parameters &p, const Declarations &declarations)
    {
      const std::string &wanted = p.output.sensitivities, own = "Output/Sensitivities";
      std::vector<std::string> all, effective, names;
      const std::vector<Rule> rules = all_rules(p);
      for (std::size_t i = 0; i < declarations.entries().size(); ++i)
      {
        const EntryInfo &entry = declarations.entries()[i];
        const bool is_of_scene = entry.path.starts_with("Body/") || entry.path.starts_with("Ground/") ||
                                 entry.path.starts_with("Active stress/") || entry.path == "Time/End time";
        if (!is_of_scene || entry.expected.find("number") == std::string::npos ||
            entry.expected.starts_with("a whole number") ||
            !to_number(declarations.value(static_cast<unsigned int>(i))))
          continue;
        all.push_back(entry.path);
        if (std::ranges::none_of(rules, [&](const Rule &rule) { return rule.is_against(entry.path); }))
          effective.push_back(entry.path);
      }
      if (trimmed(wanted) == "all")
        return effective;
      std::istringstream list(wanted);
      for (std::string name; std::getline(list, name, ',');)
      {
        const std::string path = normal_path(name);
        if (std::ranges::find(all, path) == all.end())
        {
          const auto near = nearest_names(path, all, 1);
          throw InputError(
            fmt::format("Sensitivities has \"{}\", but entries of the body, the ground, the active stress "
                        "or the end time that are numbers are expected, or \"all\"{}",
                        trimmed(name),
                        near.empty() ? "" : "; the nearest name is " + quoted_list(near)),
            own);
        }
        if (std::ranges::find(effective, path) == effective.end())
          throw InputError(
            fmt::format("Sensitivities has \"{}\", but that has no effect with the other settings; entries "
                        "that have one are expected, or \"all\"",
                        path),
            own);
        if (std::ranges::find(names, path) == names.end())
          names.push_back(path);
      }
      return names;
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
      auto sensitivities = sensitivity_entries(parameters, declarations);
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
