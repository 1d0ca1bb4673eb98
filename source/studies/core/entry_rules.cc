// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/axis.h>
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
    is_not(const std::string &word)
    {
      return [word](const std::string &value) {
        return value != word && !(to_number(word) && to_number(value) == to_number(word));
      };
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
      add("Segments/", {"Phase lag", "Direction", "Gap"}, {"Number of segments"}, is_not("1"));
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

    /// Rules in words: entries, and the choosers with the values that fit. The sections of studies serve their own
    /// command; check makes the plan of all.
    constexpr std::pair<const char *, const char *> rules_in_words[] = {
      {"Body/Anchoring exponent", "Ground/Friction law = power"},
      {"Ground/Expression", "Ground/Friction law = expression"},
      {"Ground/Switching velocity", "Ground/Backward ratio != 1"},

      {"Error estimate, Discretization/, Time/Integrator, Time/Engine, Time/Order, Time/Step control, Time/Tolerance, "
       "Time/Initial step, Time/Cycle stop, Time/Maximum number of steps, Time/Wall time limit, "
       "Time/Checkpoint interval",
       "Model = auto, linear, nonlinear"},
      {"Discretization/Mesh tolerance, Discretization/Smallest cell", "Discretization/Mesh = adaptive, automatic"},
      {"Discretization/Mesh, Discretization/Mesh tolerance, Discretization/Smallest cell, Discretization/Degree",
       "Discretization/Formulation = automatic, position"},
      // Engine has no effect where the fused engine does not fit: PETSc is the only one.
      {"Time/Engine", "Time/Integrator = automatic, radau 5, radau 9"},
      {"Time/Engine", "Time/Step control = adaptive"},
      {"Time/Engine", "Discretization/Mesh = automatic, uniform"},
      {"Time/Order", "Time/Integrator = bdf, automatic"},
      {"Output/Snapshot format, Output/Kymograph", "Output/Number of snapshots != 0"},
      {"Output/Ledger tolerance", "Output/Ledger = true"},
      // Perturbation, a series, has no energy balance to check.
      {"Output/Ledger tolerance", "Model = auto, kinematic, linear, nonlinear"},
      // Cycle stop is off by default with fixed steps.
      {"Time/Cycle stop", "Time/Cycle stop = on; Time/Step control = adaptive"},

      {"Sweep/", "crawler = sweep, optimize, check"},
      {"Tradeoff/", "crawler = tradeoff, check"},
      {"Optimize/", "crawler = optimize, check"},
      {"Fit/", "crawler = fit, check"},
      {"Sweep/Design, Sweep/Number of points, Sweep/Seed", "Sweep/Axes is set"},
      {"Sweep/Keep fields, Sweep/Cross-check, Sweep/Cross-check refinement, Sweep/Time limit per point, "
       "Sweep/Time limit",
       "crawler = sweep, check"},
      {"Sweep/Cross-check refinement", "Sweep/Cross-check = true"},
      {"Sweep/Number of points, Sweep/Seed", "Sweep/Design = random, latin hypercube"},
      {"Output/Number of snapshots, Output/Snapshot format, Output/Kymograph, Output/Statistics, "
       "Output/Active stress table, Time/Wall time limit, Time/Checkpoint interval",
       "crawler = run, run in memory, optimize, check; Sweep/Keep fields is set"},
      {"Output/Snapshot format, Output/Active stress table, Time/Checkpoint interval", "crawler != run in memory"},
      // Zero or nonzero: fields or none.
      {"Output/Number of snapshots", "crawler != run in memory; Output/Number of snapshots = 0"},
      {"Error estimate, Discretization/, Time/Integrator, Time/Engine, Time/Step control, Time/Tolerance, "
       "Time/Cycle stop",
       "crawler = run, run in memory, batch, sweep, optimize, fit, check"},
      {"Optimize/", "Optimize/Variables is set; crawler = optimize"},
      {"Optimize/Start spread, Optimize/Seed", "Optimize/Starts != 1"},
      {"Fit/", "Fit/Variables is set; crawler = fit"},
      {"Fit/Seed", "Fit/Starts != 1"},
    };

    /// Chooser in words: "ENTRY = WORD, WORD", "ENTRY != WORD" or "ENTRY is set".
    Chooser
    read_chooser(const std::string &words)
    {
      const auto sign = words.find_first_of("!=");
      if (sign == std::string::npos)
        return {words.substr(0, words.find(" is set")), is_set};
      const std::string entry = trimmed(words.substr(0, sign)), values = trimmed(words.substr(words.find('=') + 1));
      if (words[sign] == '!')
        return {entry, is_not(values)};
      return {entry, any_of(split_parts(values, ','))};
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
    rules.push_back({{body + "Profile interpolation"},
                     {{body + "Elastic modulus profile", is_csv_or_list},
                      {body + "Friction profile", is_csv_or_list},
                      {body + "Initial stretch", is_csv_or_list}}});
    rules.push_back({{ground + "Profile interpolation", ground + "Outside"}, {{ground + "Profile", is_csv}}});
    const std::string constants = ground + "Constants";
    rules.push_back({{constants},
                     {{ground + "Friction law", any_of({"expression"})},
                      {ground + "Profile",
                       uses_one_of(listed_numbers(declarations.info(constants), declarations.value(constants)))}}});
    add_rules_of_constants(declarations, rules);
    for (const auto &[entries, choosers] : rules_in_words)
    {
      EntryRule &rule = rules.emplace_back(EntryRule{split_parts(entries, ','), {}});
      for (const std::string &chooser : split_parts(choosers, ';'))
        rule.choosers.push_back(read_chooser(chooser));
    }
    return rules;
  }
} // namespace crawler
