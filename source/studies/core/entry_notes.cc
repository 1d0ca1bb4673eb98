// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/nearest_name.h>
#include <crawler/lanes/lane_tables.h>
#include <crawler/parameters/listed_numbers.h>
#include <crawler/run/cycle_stop.h>
#include <crawler/studies/core/entry_notes.h>
#include <crawler/studies/core/entry_rules.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace crawler
{
  namespace
  {
    /// Entry that has no effect.
    struct Idle
    {
      std::string path, place, section; ///< section without effect as a whole; empty if others of its entries may have
                                        ///< one
      bool is_override;
      const EntryRule *rule;
    };

    bool
    is_default(const std::string &value, const std::string &its_default)
    {
      const auto number = to_number(value);
      return value == its_default || (number && number == to_number(its_default));
    }

    std::string
    reason(const EntryRule &rule,
           const Declarations &declarations,
           const std::string &command,
           const ChosenValues &chosen)
    {
      std::vector<std::string> words;
      for (const Chooser &chooser : rule.choosers)
        words.push_back(chooser.is_command()
                          ? command == run_in_memory_command
                              ? "\"crawler.run\" without \"output\""
                              : fmt::format("\"crawler{}{}\"", command == "batch" ? "." : " ", command)
                          : fmt::format("\"{} = {}{}\"",
                                        chooser.path,
                                        declarations.value(chooser.path),
                                        chosen.contains(chooser.path) ? " (" + chosen.at(chooser.path) + ")" : ""));
      return fmt::format("has no effect with {}", fmt::join(words, " and "));
    }

    std::vector<std::string>
    idle_entries(const ParameterFile &file,
                 const Declarations &declarations,
                 const std::string &command,
                 const VariedEntries &varied,
                 const ChosenValues &chosen)
    {
      const std::vector<EntryRule> rules = entry_rules(declarations);
      const auto varies                  = [&](const std::string &path) {
        return varied.may_be_all || std::find(varied.paths.begin(), varied.paths.end(), path) != varied.paths.end();
      };
      const auto value = [&](const std::string &path) {
        return chosen.contains(path) ? chosen.at(path) : declarations.value(path);
      };
      std::vector<Idle> idle;
      const auto look_at = [&](const std::string &path, const std::string &place, const bool is_override) {
        const EntryRule *const rule = rule_against(rules, path, [&](const Chooser &chooser) {
          return chooser.is_command() ? chooser.fits(command)
                                      : varies(chooser.path) || chooser.fits(value(chooser.path));
        });
        if (rule == nullptr)
          return;
        const auto section = std::find_if(rule->entries.begin(), rule->entries.end(), [&](const std::string &entry) {
          return entry.ends_with('/') && path.starts_with(entry);
        });
        idle.push_back({path,
                        place,
                        section == rule->entries.end() ? "" : section->substr(0, section->size() - 1),
                        is_override,
                        rule});
      };
      for (const Assignment &assignment : file.assignments())
      {
        const std::string path = assignment.path.substr(0, assignment.path.find('['));
        const EntryInfo &entry = declarations.info(path);
        const std::string &own = entry.default_value;
        if (assignment.value.empty() && own.empty()) // to leave something out
          continue;
        // The default, seen from the folder of a file that names all entries.
        if (entry.names_file && !assignment.is_override && std::filesystem::path(assignment.value).filename() == own)
          continue;
        if (file.assignment_of(assignment.path) == &assignment &&
            (assignment.is_override || !is_default(assignment.value, own)))
          look_at(path, assignment.place, assignment.is_override);
      }
      for (const std::string &path : varied.paths)
        look_at(path.substr(0, path.find('[')), varied.by, /*is_override=*/true);

      std::vector<std::string> notes;
      std::set<std::pair<const EntryRule *, std::string>> sections;
      for (const Idle &one : idle)
      {
        const auto alike = [&](const Idle &other) {
          return !other.is_override && other.rule == one.rule && other.section == one.section;
        };
        const bool is_whole_section =
          !one.is_override && !one.section.empty() && std::count_if(idle.begin(), idle.end(), alike) > 1;
        if (is_whole_section && !sections.emplace(one.rule, one.section).second)
          continue;
        notes.push_back(fmt::format("Note: {}: {}\"{}\" {}",
                                    one.place,
                                    is_whole_section ? "section " : "",
                                    is_whole_section ? one.section : one.path,
                                    reason(*one.rule, declarations, command, chosen)));
      }
      return notes;
    }

    /// Notes on constants that are in no formula, while others of the list are.
    std::vector<std::string>
    notes_on_constants(const ParameterFile &file, const Declarations &declarations, const VariedEntries &varied)
    {
      std::vector<std::string> notes;
      for (const EntryInfo &entry : declarations.entries())
      {
        const Assignment *const assignment = file.assignment_of(entry.path);
        const auto &formulas               = entry.values.words;
        if (entry.values.kind != EntryKind::constants || assignment == nullptr || varied.may_be_all ||
            std::ranges::any_of(varied.paths, [&](const std::string &one) {
              return one == entry.path || std::ranges::find(formulas, one) != formulas.end();
            }))
          continue;
        const auto unused = unused_constants(declarations, entry);
        if (unused.empty() || unused.size() == listed_numbers(entry, declarations.value(entry.path)).size())
          continue;
        std::vector<std::string> values;
        for (const std::string &path : formulas)
          values.push_back(fmt::format("\"{} = {}\"", path, declarations.value(path)));
        notes.push_back(fmt::format("Note: {}: {} of \"{}\" {} no effect with {}",
                                    assignment->place,
                                    quoted_list(unused),
                                    entry.path,
                                    unused.size() == 1 ? "has" : "have",
                                    fmt::join(values, " and ")));
      }
      return notes;
    }

  } // namespace

  std::vector<std::string>
  notes_on_decimal_commas(const ParameterFile &file, const Declarations &declarations)
  {
    const auto is_whole = [](const std::string &text) {
      return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    };
    const auto has_point = [](const Assignment &other) {
      const auto number = to_number(other.value);
      return number && other.value.find('.') != std::string::npos;
    };
    const auto is_digit = [](const char c) { return c >= '0' && c <= '9'; };
    const auto is_mixed = [&](const std::string &list) {
      bool with_space = false, between_digits = false;
      for (std::size_t i = 1; i + 1 < list.size(); ++i)
        if (list[i] == ',')
        {
          with_space |= list[i + 1] == ' ';
          between_digits |= is_digit(list[i - 1]) && is_digit(list[i + 1]);
        }
      return with_space && between_digits;
    };
    const bool has_points = std::any_of(file.assignments().begin(), file.assignments().end(), has_point);
    std::vector<std::string> notes;
    for (const Assignment &assignment : file.assignments())
    {
      const EntryValues &values = declarations.info(assignment.path).values;
      const std::string &text   = assignment.value;
      const auto comma          = text.find(',');
      const bool is_list        = values.kind == EntryKind::numbers || values.kind == EntryKind::profile;
      if (!is_list || values.may_be_empty || comma == std::string::npos ||
          file.assignment_of(assignment.path) != &assignment)
        continue;
      const std::size_t start = text.starts_with("-") ? 1 : 0;
      const std::string first = text.substr(start, comma - start), second = text.substr(comma + 1);
      if (const auto numbers = to_numbers(text); numbers && is_mixed(text))
        notes.push_back(fmt::format("Note: {}: \"{} = {}\" is a list of {} numbers; decimals are written with a point",
                                    assignment.place,
                                    assignment.path,
                                    text,
                                    numbers->size()));
      else if (is_whole(first) && is_whole(second) && (first == "0" || has_points))
        notes.push_back(fmt::format("Note: {0}: \"{1} = {2},{3}\" is the two numbers {2} and {3}; decimals are written "
                                    "with a point, {2}.{3}",
                                    assignment.place,
                                    assignment.path,
                                    text.substr(0, comma),
                                    second));
    }
    return notes;
  }

  std::vector<std::string>
  notes_on_entries(const ParameterFile &file,
                   const Declarations &declarations,
                   const std::string &command,
                   const VariedEntries &varied,
                   const ChosenValues &chosen)
  {
    auto notes = idle_entries(file, declarations, command, varied, chosen);
    std::ranges::copy(notes_on_constants(file, declarations, varied), std::back_inserter(notes));
    std::ranges::copy(notes_on_decimal_commas(file, declarations), std::back_inserter(notes));
    return notes;
  }

  void
  add_notes_on_scene(const ParameterFile &file,
                     const RunParameters &parameters,
                     const Scene &scene,
                     std::vector<std::string> &notes)
  {
    const auto add = [&](const std::string &path, const std::string &reason) {
      const Assignment *const assignment = file.assignment_of(path);
      if (assignment == nullptr)
        return;
      const std::string note = fmt::format("Note: {}: \"{}\" has no effect", assignment->place, path);
      if (std::ranges::none_of(notes, [&](const std::string &other) { return other.starts_with(note); }))
        notes.push_back(note + ", since " + reason);
    };
    if (parameters.time.engine == Engine::petsc && !fits_lanes(scene))
      add("Time/Engine", "the fused engine does not support feedback by w_near or w_delayed");
    if (parameters.time.cycle_stop == CycleStopMode::automatic)
      return;
    RunParameters with_stop   = parameters;
    with_stop.time.cycle_stop = CycleStopMode::on;
    if (!cycle_wish(with_stop, scene, /*has_pictures=*/false))
      add("Time/Cycle stop",
          !scene.is_alike_everywhere() ? "the motion of the body depends on its place or its past"
          : scene.keeps_its_centre()   ? "the displacement, by which cycles are judged, is 0 at a = 0"
          : !scene.active_stress->repetition()
            ? "no period of the active stress is known"
            : fmt::format("the active stress repeats fewer than {} times", CycleStop::min_cycles));
  }
} // namespace crawler
