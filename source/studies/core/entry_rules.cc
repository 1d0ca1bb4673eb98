// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress_library.h>
#include <crawler/studies/core/entry_rules.h>

#include <fmt/format.h>

#include <cctype>

namespace crawler
{
  namespace
  {
    /// The sections in @p section of generators that are not used.
    void
    add_rules_of_generators(const std::string &section, const ActiveStressParameters &p, std::vector<EntryRule> &rules)
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

  } // namespace

  std::vector<EntryRule>
  entry_rules(const Parameters &p)
  {
    const std::string stress = "Active stress/", optimal = stress + "Optimal wave/",
                      travel = stress + "Travelling wave/", stand = stress + "Standing wave/",
                      strain = stress + "Prescribed strain/", two_level = stress + "Two-level wave/",
                      modes           = stress + "Modes/";
    const auto &wave                  = p.active_stress.optimal_wave;
    const auto &travelling            = p.active_stress.travelling_wave;
    const std::string &travel_profile = travelling.profile.profile,
                      &given_by       = p.active_stress.prescribed_strain.given_by,
                      &two_level_by   = p.active_stress.two_level_wave.given_by,
                      &stand_profile  = p.active_stress.standing_wave.profile.profile;
    std::vector<EntryRule> rules;
    add_rules_of_generators(stress, p.active_stress, rules);
    for (std::size_t i = 0; i < p.active_stress.sum.terms.size(); ++i)
      add_rules_of_generators(fmt::format("{}Sum/Term {}/", stress, i + 1), p.active_stress.sum.terms[i].stress, rules);
    const std::vector<EntryRule> details = {
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
      {two_level, {"Frequency"}, "Given by", two_level_by, {"frequency"}},
      {two_level, {"Wave speed"}, "Given by", two_level_by, {"wave speed"}},
      {two_level, {"Work"}, "Given by", two_level_by, {"work"}},
      {stand, {"Duty cycle"}, "Profile", stand_profile, {"square", "smoothed square"}},
      {stand, {"Front width"}, "Profile", stand_profile, {"smoothed square"}},
      {modes, {"Wave speed"}, "In time", p.active_stress.modes.in_time, {"travelling"}},
      {modes, {"Period", "Time harmonics"}, "In time", p.active_stress.modes.in_time, {"harmonics"}},
      {modes, {"Time cells"}, "In time", p.active_stress.modes.in_time, {"splines"}},
      {"Time/", {"Order"}, "Integrator", p.time.integrator, {"bdf", "automatic"}},
      {"Output/", {"Ledger tolerance"}, "Ledger", p.output.energy_balance ? "true" : "false", {"true"}},
    };
    rules.insert(rules.end(), details.begin(), details.end());
    return rules;
  }
} // namespace crawler
