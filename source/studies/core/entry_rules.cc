// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/axis.h>
#include <crawler/parameters/listed_numbers.h>
#include <crawler/scene/active_stress_library.h>
#include <crawler/studies/core/entry_rules.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <tuple>

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

    /// Rule in words: entries, separated by commas, and choosers, by semicolons: "ENTRY = WORD, WORD", "ENTRY != WORD",
    /// "ENTRY is set" or "ENTRY has NAME", all of them in the section @p root.
    EntryRule
    rule_in_words(const std::string &root, const std::string &entries, const std::string &choosers)
    {
      EntryRule rule;
      for (const std::string &entry : split_parts(entries, ','))
        rule.entries.push_back(root + entry);
      for (const std::string &words : split_parts(choosers, ';'))
      {
        const auto sign          = words.find_first_of("!=");
        const std::string values = sign == words.npos ? "" : trimmed(words.substr(words.find('=') + 1));
        if (const auto verb = words.find(" has "); sign == words.npos && verb != words.npos)
          rule.choosers.push_back({root + words.substr(0, verb), has(words.substr(verb + 5))});
        else if (sign == words.npos)
          rule.choosers.push_back({root + words.substr(0, words.find(" is set")), is_set});
        else if (words[sign] == '!')
          rule.choosers.push_back({root + trimmed(words.substr(0, sign)), is_not(values)});
        else
          rule.choosers.push_back({root + trimmed(words.substr(0, sign)), any_of(split_parts(values, ','))});
      }
      return rule;
    }

    /// Rules within the section of generators in words: sections, entries, and choosers.
    constexpr std::tuple<const char *, const char *, const char *> rules_of_generators[] = {
      {"Optimal wave/", "Sine coefficients, Cosine coefficients", "Shape = Fourier"},
      {"Optimal wave/", "Shape formula, Shape constants", "Shape = expression"},
      {"Optimal wave/", "Shape file", "Shape = table"},
      {"Optimal wave/", "Wave speed", "Choose wave by = wave speed"},
      {"Optimal wave/", "Energy, Root, Root index", "Choose wave by = energy"},
      {"Optimal wave/", "Root index", "Root = index"},
      {"Travelling wave/, Two-level wave/", "Frequency", "Given by = frequency"},
      {"Travelling wave/, Two-level wave/", "Wave speed", "Given by = wave speed"},
      {"Two-level wave/", "Work", "Given by = work"},
      {"Travelling wave/, Standing wave/", "Duty cycle", "Profile = square, smoothed square"},
      {"Travelling wave/, Standing wave/", "Front width", "Profile = smoothed square"},
      {"Travelling wave/, Standing wave/, Pulse/", "Window edge", "Window start is set; Window end is set"},
      {"Segments/", "Front width", "Switching = smooth"},
      {"Segments/", "Phase lag, Direction, Gap", "Number of segments != 1"},
      {"Prescribed strain/", "Strain, Constants", "Given by = expression"},
      {"Prescribed strain/", "File", "Given by = table"},
      {"Prescribed strain/", "Mean strain, Amplitude, Wave number, Wave speed, Phase", "Given by = wave"},
      {"Strain feedback/", "Distance, Sensor length", "Active stress has w_near"},
      {"Strain feedback/", "Delay", "Active stress has w_delayed"},
      {"Modes/", "Wave speed", "In time = travelling"},
      {"Modes/", "Period, Time harmonics", "In time = harmonics"},
      {"Modes/", "Time cells", "In time = splines"}};

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
      for (const auto &[sections, entries, choosers] : rules_of_generators)
        for (const std::string &section : split_parts(sections, ','))
          rules.push_back(rule_in_words(root + section, entries, choosers));
      for (const char *x : {"s", "t"})
        if (!has_sum)
          rules.push_back(
            rule_in_words(root, fmt::format("Edge width in {}", x), fmt::format("Window in {} is set", x)));
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
      rules.push_back(rule_in_words("", entries, choosers));
    return rules;
  }
} // namespace crawler
