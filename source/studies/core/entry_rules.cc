// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/listed_numbers.h>
#include <crawler/scene/active_stress_library.h>
#include <crawler/studies/core/entry_rules.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace crawler
{
  namespace
  {
    /// True if the variable or constant @p name is in the formula.
    bool
    uses_name(const std::string &formula, const std::string &name)
    {
      const auto in_name = [](const char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
      for (auto i = formula.find(name); i != std::string::npos; i = formula.find(name, i + 1))
        if ((i == 0 || !in_name(formula[i - 1])) &&
            (i + name.size() == formula.size() || !in_name(formula[i + name.size()])))
          return true;
      return false;
    }

    const std::string command_entry = "crawler";

    // Conditions of a chooser on its value.

    auto
    any_of(std::vector<std::string> words)
    {
      return [words = std::move(words)](const std::string &value) {
        return std::find(words.begin(), words.end(), value) != words.end();
      };
    }
    bool
    is_set(const std::string &value)
    {
      return !value.empty() && value != "automatic";
    }
    auto
    is_not(const double number)
    {
      return [number](const std::string &value) { return to_number(value) != number; };
    }
    bool
    is_csv(const std::string &value)
    {
      return value.ends_with(".csv");
    }
    bool
    is_csv_or_list(const std::string &value)
    {
      return is_csv(value) || to_numbers(value).value_or(std::vector<double>()).size() > 1;
    }
    /// Returns a condition: the formula contains one of these constants.
    auto
    uses_one_of(const std::vector<ListedNumber> &constants)
    {
      return [constants](const std::string &formula) {
        return std::ranges::any_of(constants, [&](const ListedNumber &one) { return uses_name(formula, one.key); });
      };
    }
    /// Returns a condition: the formula contains the variable @p name.
    auto
    has(const std::string &name)
    {
      return [name](const std::string &formula) { return uses_name(formula, name); };
    }

    /// Adds the rules within the section @p root of generators.
    void
    add_rules_of_generators(const std::string &root, const bool has_sum, std::vector<EntryRule> &rules)
    {
      const std::string strain = "Prescribed strain/";
      for (const std::string &name : generator_names())
      {
        std::string section  = root + name + "/";
        section[root.size()] = static_cast<char>(std::toupper(static_cast<unsigned char>(section[root.size()])));
        if (name == "none" || (name == "sum" && !has_sum))
          continue;
        // Strains given by a formula or a table have entries of their own.
        const bool gives_strain = name != "expression" && name != "table" && name != "prescribed strain";
        rules.push_back(
          {{section}, {{root + "Generator", gives_strain ? any_of({name, "prescribed strain"}) : any_of({name})}}});
        if (gives_strain)
          rules.push_back(
            {{section}, {{root + "Generator", any_of({name})}, {root + strain + "Given by", any_of({name})}}});
      }
      /// Adds a rule for entries of one section that depend on another entry of it.
      const auto add = [&](const std::string &section,
                           const std::vector<std::string> &entries,
                           const std::vector<std::string> &choosers,
                           const std::function<bool(const std::string &)> &fits) {
        EntryRule &rule = rules.emplace_back();
        for (const std::string &entry : entries)
          rule.entries.push_back(root + section + entry);
        for (const std::string &chooser : choosers)
          rule.choosers.push_back({root + section + chooser, fits});
      };
      const std::string optimal = "Optimal wave/", travelling = "Travelling wave/", standing = "Standing wave/",
                        two_level = "Two-level wave/", feedback = "Strain feedback/", modes = "Modes/";
      add(optimal, {"Sine coefficients", "Cosine coefficients"}, {"Shape"}, any_of({"Fourier"}));
      add(optimal, {"Shape formula", "Shape constants"}, {"Shape"}, any_of({"expression"}));
      add(optimal, {"Shape file"}, {"Shape"}, any_of({"table"}));
      add(optimal, {"Wave speed"}, {"Choose wave by"}, any_of({"wave speed"}));
      add(optimal, {"Energy", "Root", "Root index"}, {"Choose wave by"}, any_of({"energy"}));
      add(optimal, {"Root index"}, {"Root"}, any_of({"index"}));
      for (const std::string &wave : {travelling, two_level})
      {
        add(wave, {"Frequency"}, {"Given by"}, any_of({"frequency"}));
        add(wave, {"Wave speed"}, {"Given by"}, any_of({"wave speed"}));
      }
      add(two_level, {"Work"}, {"Given by"}, any_of({"work"}));
      for (const std::string &wave : {travelling, standing})
      {
        add(wave, {"Duty cycle"}, {"Profile"}, any_of({"square", "smoothed square"}));
        add(wave, {"Front width"}, {"Profile"}, any_of({"smoothed square"}));
        add(wave, {"Window edge"}, {"Window start", "Window end"}, is_set);
      }
      add("Pulse/", {"Window edge"}, {"Window start", "Window end"}, is_set);
      add("Segments/", {"Front width"}, {"Switching"}, any_of({"smooth"}));
      add("Segments/", {"Phase lag", "Direction", "Gap"}, {"Number of segments"}, is_not(1.));
      add(strain, {"Strain", "Constants"}, {"Given by"}, any_of({"expression"}));
      add(strain, {"File"}, {"Given by"}, any_of({"table"}));
      add(strain, {"Mean strain", "Amplitude", "Wave number", "Wave speed", "Phase"}, {"Given by"}, any_of({"wave"}));
      add(feedback, {"Distance", "Sensor length"}, {"Active stress"}, has("w_near"));
      add(feedback, {"Delay"}, {"Active stress"}, has("w_delayed"));
      add(modes, {"Wave speed"}, {"In time"}, any_of({"travelling"}));
      add(modes, {"Period", "Time harmonics"}, {"In time"}, any_of({"harmonics"}));
      add(modes, {"Time cells"}, {"In time"}, any_of({"splines"}));
      for (const char *x : {"s", "t"})
        if (!has_sum)
          add("", {fmt::format("Edge width in {}", x)}, {fmt::format("Window in {}", x)}, is_set);
    }

    /// Adds rules for constants none of which is in their formula, unless an axis varies it.
    void
    add_rules_of_constants(const Declarations &declarations, std::vector<EntryRule> &rules)
    {
      for (const EntryInfo &entry : declarations.entries())
      {
        if (entry.values.kind != EntryKind::constants)
          continue;
        EntryRule rule{{entry.path}, {{entry.path, any_of({""})}}};
        for (const std::string &formula : entry.values.words)
          rule.choosers.push_back({formula, uses_one_of(listed_numbers(entry, declarations.value(entry.path)))});
        rules.push_back(std::move(rule));
      }
    }

    /// Adds the rules of the sections behind the active stress in the file.
    void
    add_rules_of_numerics(std::vector<EntryRule> &rules)
    {
      const auto has_equation   = any_of({"auto", "linear", "nonlinear"});
      const auto is_not_stretch = any_of({"automatic", "position"});
      const std::string mesh = "Discretization/", time = "Time/", output = "Output/";
      rules.push_back({{"Error estimate",
                        mesh,
                        time + "Integrator",
                        time + "Engine",
                        time + "Order",
                        time + "Step control",
                        time + "Tolerance",
                        time + "Initial step",
                        time + "Cycle stop",
                        time + "Maximum number of steps",
                        time + "Wall time limit",
                        time + "Checkpoint interval"},
                       {{"Model", has_equation}}});
      rules.push_back(
        {{mesh + "Mesh tolerance", mesh + "Smallest cell"}, {{mesh + "Mesh", any_of({"adaptive", "automatic"})}}});
      rules.push_back({{mesh + "Mesh", mesh + "Mesh tolerance", mesh + "Smallest cell", mesh + "Degree"},
                       {{mesh + "Formulation", is_not_stretch}}});
      // Engine has no effect where the fused engine does not fit: PETSc is the only one.
      rules.push_back({{time + "Engine"}, {{time + "Integrator", any_of({"automatic", "radau 5", "radau 9"})}}});
      rules.push_back({{time + "Engine"}, {{time + "Step control", any_of({"adaptive"})}}});
      rules.push_back({{time + "Engine"}, {{mesh + "Mesh", any_of({"automatic", "uniform"})}}});
      rules.push_back({{time + "Order"}, {{time + "Integrator", any_of({"bdf", "automatic"})}}});
      rules.push_back(
        {{output + "Snapshot format", output + "Kymograph"}, {{output + "Number of snapshots", is_not(0.)}}});
      rules.push_back({{output + "Ledger tolerance"}, {{output + "Ledger", any_of({"true"})}}});
      // Perturbation, a series, has no energy balance to check.
      rules.push_back(
        {{output + "Ledger tolerance"}, {{"Model", any_of({"auto", "kinematic", "linear", "nonlinear"})}}});
      // Cycle stop is off by default with fixed steps.
      rules.push_back({{time + "Cycle stop"},
                       {{time + "Cycle stop", any_of({"on"})}, {time + "Step control", any_of({"adaptive"})}}});
    }

    /// Adds the rules of the studies, and of other entries that some commands do not need.
    void
    add_rules_of_commands(std::vector<EntryRule> &rules)
    {
      const auto is_random = any_of({"random", "latin hypercube"});
      // Sections of studies serve their own command; check makes the plan of all.
      rules.push_back({{"Sweep/"}, {{command_entry, any_of({"sweep", "optimize", "check"})}}});
      for (const auto &[section, command] :
           {std::pair("Tradeoff/", "tradeoff"), std::pair("Optimize/", "optimize"), std::pair("Fit/", "fit")})
        rules.push_back({{section}, {{command_entry, any_of({command, "check"})}}});
      rules.push_back({{"Sweep/Design", "Sweep/Number of points", "Sweep/Seed"}, {{"Sweep/Axes", is_set}}});
      rules.push_back({{"Sweep/Keep fields",
                        "Sweep/Cross-check",
                        "Sweep/Cross-check refinement",
                        "Sweep/Time limit per point",
                        "Sweep/Time limit"},
                       {{command_entry, any_of({"sweep", "check"})}}});
      rules.push_back({{"Sweep/Cross-check refinement"}, {{"Sweep/Cross-check", any_of({"true"})}}});
      rules.push_back({{"Sweep/Number of points", "Sweep/Seed"}, {{"Sweep/Design", is_random}}});
      rules.push_back({{"Output/Number of snapshots",
                        "Output/Snapshot format",
                        "Output/Kymograph",
                        "Output/Statistics",
                        "Output/Active stress table",
                        "Time/Wall time limit",
                        "Time/Checkpoint interval"},
                       {{command_entry, any_of({"run", run_in_memory_command, "optimize", "check"})},
                        {"Sweep/Keep fields", is_set}}});
      const auto has_files = [](const std::string &command) { return command != run_in_memory_command; };
      rules.push_back({{"Output/Snapshot format", "Output/Active stress table", "Time/Checkpoint interval"},
                       {{command_entry, has_files}}});
      rules.push_back({{"Output/Number of snapshots"}, // zero or nonzero: fields or none
                       {{command_entry, has_files}, {"Output/Number of snapshots", any_of({"0"})}}});
      rules.push_back(
        {{"Error estimate",
          "Discretization/",
          "Time/Integrator",
          "Time/Engine",
          "Time/Step control",
          "Time/Tolerance",
          "Time/Cycle stop"},
         {{command_entry, any_of({"run", run_in_memory_command, "batch", "sweep", "optimize", "fit", "check"})}}});
      rules.push_back({{"Optimize/"}, {{"Optimize/Variables", is_set}, {command_entry, any_of({"optimize"})}}});
      rules.push_back({{"Optimize/Start spread", "Optimize/Seed"}, {{"Optimize/Starts", is_not(1.)}}});
      rules.push_back({{"Fit/"}, {{"Fit/Variables", is_set}, {command_entry, any_of({"fit"})}}});
      rules.push_back({{"Fit/Seed"}, {{"Fit/Starts", is_not(1.)}}});
    }
  } // namespace

  std::vector<std::string>
  unused_constants(const Declarations &declarations, const EntryInfo &constants)
  {
    std::vector<std::string> unused;
    for (const ListedNumber &one : listed_numbers(constants, declarations.value(constants.path)))
      if (std::ranges::none_of(constants.values.words,
                               [&](const std::string &path) { return uses_name(declarations.value(path), one.key); }))
        unused.push_back(one.key);
    return unused;
  }

  const EntryRule *
  rule_against(const std::vector<EntryRule> &rules,
               const std::string &path,
               const std::function<bool(const Chooser &)> &fits)
  {
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const EntryRule &one) {
      const auto is_it = [&](const std::string &entry) {
        return entry.ends_with('/') ? path.starts_with(entry) : path == entry;
      };
      return std::any_of(one.entries.begin(), one.entries.end(), is_it) &&
             std::none_of(one.choosers.begin(), one.choosers.end(), fits);
    });
    return rule == rules.end() ? nullptr : &*rule;
  }

  std::vector<EntryRule>
  entry_rules(const Declarations &declarations)
  {
    const std::string stress = "Active stress/", generator = "/Generator", body = "Body/", ground = "Ground/";
    std::vector<EntryRule> rules;
    add_rules_of_generators(stress, /*has_sum=*/true, rules);
    for (const EntryInfo &entry : declarations.entries())
      if (entry.path.starts_with(stress + "Sum/") && entry.path.ends_with(generator))
        add_rules_of_generators(
          entry.path.substr(0, entry.path.size() - generator.size() + 1), /*has_sum=*/false, rules);
    rules.push_back({{body + "Anchoring exponent"}, {{ground + "Friction law", any_of({"power"})}}});
    rules.push_back({{body + "Profile interpolation"},
                     {{body + "Elastic modulus profile", is_csv_or_list},
                      {body + "Friction profile", is_csv_or_list},
                      {body + "Initial stretch", is_csv_or_list}}});
    rules.push_back({{ground + "Profile interpolation", ground + "Outside"}, {{ground + "Profile", is_csv}}});
    const std::string constants = ground + "Constants";
    rules.push_back({{ground + "Expression"}, {{ground + "Friction law", any_of({"expression"})}}});
    rules.push_back({{constants},
                     {{ground + "Friction law", any_of({"expression"})},
                      {ground + "Profile",
                       uses_one_of(listed_numbers(declarations.info(constants), declarations.value(constants)))}}});
    rules.push_back({{ground + "Switching velocity"}, {{ground + "Backward ratio", is_not(1.)}}});
    add_rules_of_constants(declarations, rules);
    add_rules_of_numerics(rules);
    add_rules_of_commands(rules);
    return rules;
  }
} // namespace crawler
