// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_rows.h>
#include <crawler/studies/tradeoff/tradeoff.h>
#include <crawler/studies/tradeoff/tradeoff_measurement.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Table with a row for each setting, known from the beginning; the columns are a contract (doc/user_guide.md,
    /// "Trading accuracy for speed").
    PointTable
    tradeoff_table(const double time_limit)
    {
      PointTable table = {"tradeoff.h5",
                          "tradeoff",
                          {{"index", "1", "number of the setting"}},
                          0,
                          "status",
                          {{"reason", "time limit"}},
                          time_limit};
      for (const SettingColumn &one : setting_columns())
        table.columns.push_back(one.column);
      table.n_known                              = table.columns.size();
      const std::vector<RowFile::Column> results = {
        {"entries", "", "the setting as entries of the parameter file", 512},
        {"status", "", "finished, inverted, failed, stopped, refused, or not offered; empty: not tried yet", 16},
        {"reason", "", "name of what went wrong", 32},
        {"message", "", "what went wrong, or what the level says about its error, in words", 256},
        {"time limit", "s", "time after which the setting was abandoned"},
        {"displacement", "length", "displacement of the centre of mass at the end time"},
        {"error", "1", "distance of the displacement from the reference, over the size of the displacement"},
        {"shown error", "1", "error, but no smaller than the bar of the reference"},
        {"below bar", "", "true if the error cannot be told from 0: it is below the reference's bar", 8},
        {"seconds", "s", "processor time to build the simulation and run it, median; in a batch, per body"},
        {"spread", "1", "largest minus smallest measurement over the median"},
        {"repetitions", "1", "number of runs that were timed"},
        {"choice seconds", "s", "processor time of the pilot runs of an adaptive mesh, which is not in seconds"},
        {"memory", "byte", "largest heap in use by the simulation at the ends of steps; in a batch, by all bodies"},
        {"steps", "1", "accepted time steps"},
        {"rejected steps", "1", "time steps that were rejected and repeated"},
        {"newton iterations", "1", "Newton iterations of all steps"},
        {"most cells", "1", "largest number of cells of an adaptive mesh over time"}};
      table.columns.insert(table.columns.end(), results.begin(), results.end());
      return table;
    }

    /// Value in a column: an empty text or not a number if unknown.
    RowFile::Value
    value_in(const TradeoffTexts &texts, const RowFile::Column &column)
    {
      const auto found       = texts.find(column.name);
      const std::string text = found == texts.end() ? "" : found->second;
      if (column.width > 0)
        return shortened(text, column.width);
      return to_number(text).value_or(std::numeric_limits<double>::quiet_NaN());
    }

    void
    compare(TradeoffTexts &row, const TradeoffReference &reference)
    {
      const auto displacement = to_number(row["displacement"]);
      if (!displacement)
        return;
      const double error = std::abs(*displacement - reference.displacement) / reference.size;
      row["error"]       = to_text(error);
      row["shown error"] = to_text(std::max(error, reference.relative_bar));
      row["below bar"]   = error < reference.relative_bar ? "true" : "false";
    }

    /// Data shared by all parts of the study.
    struct Study
    {
      MPI_Comm communicator;
      const Input &input;
      const PointTable &table;
      const std::vector<TradeoffSetting> &settings;
      const std::function<bool()> &interrupted;
      const StudyClock &clock;
      StudyFolder &folder;
      std::vector<bool> done = {}; ///< settings that have a row
    };

    /// Ranges of settings, one for each mesh that is not done: first setting, and the one behind the last; spread out.
    std::vector<std::pair<unsigned long, unsigned long>>
    meshes_to_do(const Study &study)
    {
      std::vector<std::pair<unsigned long, unsigned long>> all, spread;
      for (unsigned long first = 0, end; first < study.settings.size(); first = end)
      {
        bool is_done = study.done[first];
        for (end = first + 1; end < study.settings.size() && same_mesh(study.settings[first], study.settings[end]);
             ++end)
          is_done = is_done && study.done[end];
        if (!is_done)
          all.emplace_back(first, end);
      }
      const unsigned long n = all.size(), stride = golden_stride(std::max(1ul, n));
      for (unsigned long i = 0; i < n; ++i)
        spread.push_back(all[i * stride % n]);
      return spread;
    }

    /// Measures the missing rows on all ranks. Returns false if some rank was interrupted.
    bool
    measure_all(const Study &study, const TradeoffReference &reference)
    {
      const auto path    = study.folder.path;
      const auto columns = study.table.written_columns();
      const auto meshes  = meshes_to_do(study);
      RowFile rows(study.communicator, path / study.table.file, study.table.group, columns);
      CrashNote note(path);
      const auto measure_mesh = [&](const unsigned long number, const auto &stops, const auto &see) {
        const char *const not_tried = "not tried: a looser tolerance on this mesh took too long";
        bool took_too_long          = false;
        for (unsigned long i = meshes[number].first; i < meshes[number].second; ++i)
        {
          if (study.done[i])
            continue;
          const TradeoffSetting &setting = study.settings[i];
          const auto entries             = overrides(setting, study.input.parameters, reference.size);
          const std::string name         = fmt::format("{}", i);
          note.at_work_on(name);
          auto row = stops()                  ? std::nullopt
                     : note.is_given_up(name) ? std::optional(gap("failed", "crashed", crash_message))
                     : took_too_long
                       ? std::optional(gap("stopped", time_limit_reason, not_tried, study.table.time_limit))
                       : measure(study.input, setting, entries, stops);
          if (!row)
            return false;
          took_too_long = (*row)["reason"] == time_limit_reason;
          compare(*row, reference);
          (*row)["entries"] = fmt::format("{}", fmt::join(entries, "; "));
          RowFile::Row values;
          for (const RowFile::Column &column : columns)
            values.push_back(value_in(*row, column));
          rows.write(i, {{values}});
          note.at_work_on({});
          see(1, (*row)["status"] != "finished");
        }
        return true;
      };
      const auto n_missing = static_cast<unsigned long>(std::ranges::count(study.done, false));
      return share_work(
        study.communicator, {meshes.size(), n_missing, "settings", study.interrupted, measure_mesh}, study.folder.log);
    }

    /// Reports the quality of the reference; without a reference nothing can be measured.
    ExitCode
    report(const TradeoffReference &reference, const double accuracy, Log &log)
    {
      const auto &[answer, check, displacement, bar, size, relative_bar, status, message] = reference;
      if (status == "stopped")
        log.warn("stopped while the reference was made; --resume starts with it");
      else if (status != "finished")
        log.warn("the nonlinear model gives no displacement to measure errors against: " + message);
      if (status != "finished")
        return status == "stopped"    ? ExitCode::stopped
               : status == "inverted" ? ExitCode::inverted
                                      : ExitCode::numerical_failure;
      log.line(
        fmt::format("Reference: displacement {:.15g} by {}; errors below the bar of {:.1e} cannot be told from 0.",
                    displacement,
                    answer.method,
                    relative_bar));
      if (check.method.empty())
        log.warn("no second method could check the reference; its own error bound gives the bar");
      else
        log.line(fmt::format(
          "  Checked by {}: it differs by {:.1e}.", check.method, std::abs(check.displacement - displacement) / size));
      if (relative_bar > accuracy)
        log.warn(fmt::format("the bar is above Accuracy, {:g}: nothing can be said about settings of that accuracy",
                             accuracy));
      return ExitCode::finished;
    }

    /// Finds the settings that have a row already, and the reference (collective).
    TradeoffReference
    begin(Study &study)
    {
      const auto known = [&](const std::size_t i, const unsigned long row) -> RowFile::Value {
        if (i == 0)
          return static_cast<double>(row);
        return value_in(study.settings[row].values, study.table.columns[i]);
      };
      const Input &input = study.input;
      PlannedRows plan{study.settings.size(),
                       {study.table.n_known, known},
                       {without_comments(input.effective), {}, {}},
                       input.effective,
                       {{"reference", ""}}};
      std::string text;
      study.done        = points_done(study.communicator, [&]() {
        auto done = begin_or_resume(study.folder, study.table, input.file, plan);
        text      = read_attribute(study.folder.path / study.table.file, study.table.group, "reference");
        return done;
      });
      text              = broadcast(text, study.communicator);
      const auto n_done = std::ranges::count(study.done, true);
      study.folder.log.line(fmt::format("Tradeoff of {}: {} settings on {}{}",
                                        input.file.name(),
                                        study.settings.size(),
                                        counted(size_of(study.communicator), "rank"),
                                        n_done > 0 ? fmt::format("; {} are already done", n_done) : ""));
      for (const std::string &note : input.notes)
        study.folder.log.line(note);
      if (!text.empty())
        if (TradeoffReference reference = nlohmann::json::parse(text); reference.status == "finished")
          return reference;
      // Every rank computes the reference, so that none has an idle core beside it; that of the first is used.
      study.folder.log.line("Making the reference ...");
      const nlohmann::json made = make_reference(input.parameters, study.interrupted);
      text = broadcast(made.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), study.communicator);
      on_first_rank(study.communicator, [&]() {
        plan.more["reference"] = text;
        create_table(study.folder, study.table, plan);
      });
      return nlohmann::json::parse(text);
    }

    /// Writes summary.json. Python adds the evaluation of all rows together, and draws them (one process).
    void
    conclude(const Study &study, const TradeoffReference &reference, const SweepCounts &counts, const SweepEnd &end)
    {
      const auto path    = study.folder.path;
      auto summary       = nlohmann::ordered_json::parse(sweep_json(counts, end));
      summary["message"] = reference.message.empty() ? nullptr : nlohmann::ordered_json(reference.message);
      summary["reference"] =
        reference.status == "finished" ? nlohmann::ordered_json(nlohmann::json(reference)) : nullptr;
      write_file(path / "summary.json", summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
      if (counts.statuses.contains("finished"))
      {
        const PythonEnd python = call_python("__main__.py", {"tradeoff", path.string()}, /*shown=*/false);
        if (python.status == static_cast<int>(ExitCode::file_error))
          throw FileError(python.problem);
        if (python.status != 0)
          study.folder.log.line(fmt::format(
            "No fronts, no recommendations and no picture were made: {}. Make them later with: crawler plot {}",
            python.problem,
            path.string()));
        else
          draw("tradeoff", path, study.folder.log);
        const auto whole = nlohmann::json::parse(read_whole_file(path / "summary.json"));
        for (const auto &line : whole.value("advice", nlohmann::json::array()))
          study.folder.log.line(line.get<std::string>());
      }
      study.folder.log.line(fmt::format("{:.1f} s. Results are in {}/.", end.seconds, path.string()));
      if (end.status == "stopped" && reference.status == "finished")
        study.folder.log.warn(fmt::format("{} after {} settings; --resume continues",
                                          study.clock.in_words(end.reason),
                                          end.n_before + n_computed(counts, end)));
    }
  } // namespace

  ExitCode
  tradeoff(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file)
  {
    StudyClock clock;
    Log log(rank_of(communicator) == 0, options);
    const Input input             = read_input(file, /*command=*/"tradeoff");
    const TradeoffParameters &own = input.parameters.tradeoff;
    const auto settings           = file.placing_errors([&]() { return settings_to_try(input); });
    const PointTable table        = tradeoff_table(own.run_time_limit);
    clock.set_limit(own.time_limit, "Tradeoff/Time limit");
    const std::function<bool()> interrupted = [&]() { return clock.is_over(); };
    const StudyKind kind = {"tradeoff", table.file, {"Tradeoff/Time limit", "Tradeoff/Time limit per run"}};
    StudyFolder folder(kind, options, log);
    Study study{communicator, input, table, settings, interrupted, clock, folder};
    const TradeoffReference reference = begin(study);
    const auto n_before               = static_cast<unsigned long>(std::ranges::count(study.done, true));
    SweepEnd end{reference.status, "", 0., size_of(communicator), n_before, options.command_line};
    ExitCode code = report(reference, input.parameters.accuracy, log);
    if (code == ExitCode::finished && !measure_all(study, reference))
      code = ExitCode::stopped;
    if (code == ExitCode::stopped)
    {
      end.status = "stopped";
      end.reason = clock.reason(communicator, /*is_whole=*/false);
    }
    on_first_rank(communicator, [&]() { folder.require_in_place(); });
    const SweepCounts counts = write_results_csv(communicator, folder.path, table.file, table.group);
    end.seconds              = clock.seconds();
    on_first_rank(communicator, [&]() {
      conclude(study, reference, counts, end);
      folder.leave();
    });
    return code;
  }
} // namespace crawler
