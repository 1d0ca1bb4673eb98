// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/batch.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_rows.h>
#include <crawler/studies/tradeoff/tradeoff.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>
#include <crawler/studies/tradeoff/tradeoff_settings.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#ifdef __GLIBC__
#  include <malloc.h>
#endif

namespace crawler
{
  namespace
  {
    /// Value in a column: an empty text or not a number if unknown.
    RowFile::Value
    value_in(const TradeoffTexts &texts, const RowFile::Column &column)
    {
      const auto found       = texts.find(column.name);
      const std::string text = found == texts.end() ? "" : found->second;
      if (column.width > 0)
        return shortened(text, column.width);
      return to_number(text).value_or(NAN);
    }

    /// Table with a row for each setting; the columns are a contract (doc/user_guide.md, "Trading accuracy for speed").
    PointTable
    tradeoff_table(const Input &input, const std::vector<TradeoffSetting> &settings)
    {
      PointTable table = {
        "tradeoff.h5", "tradeoff", {{"index", "1", "number of the setting"}}, input.effective, settings.size()};
      for (const SettingColumn &one : setting_columns())
        table.columns.push_back(one.column);
      table.known  = {table.columns.size(), [&](const std::size_t i, const unsigned long row) -> RowFile::Value {
                       if (i == 0)
                         return static_cast<double>(row);
                       return value_in(settings[row].values, setting_columns()[i - 1].column);
                     }};
      table.inputs = {{"parameters.prm", without_comments(input.effective)}};
      table.reasons_and_seconds                  = {{"reason", "time limit"}};
      table.time_limit                           = input.parameters.tradeoff.run_time_limit;
      table.others                               = {{"reference", ""}};
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

    /// Shortest measurement [s]; faster runs are repeated.
    constexpr double shortest_measurement = 5e-3;
    /// Duration [s] beyond which the first run of a setting counts as a measurement.
    constexpr double long_run        = 0.1;
    constexpr std::size_t batch_size = 8;
    /// Number of steps after each of which the heap is examined, and interval in steps afterwards.
    constexpr unsigned long looks_at_heap = 64, steps_between_looks = 16;

    /// Processor time of this process [s].
    double
    processor_seconds()
    {
      return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    }

    /// Bytes of the heap in use; not a number where the C library does not tell (glibc does).
    double
    heap_bytes()
    {
#ifdef __GLIBC__
      const struct mallinfo2 info = mallinfo2();
      return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
#else
      return std::nan("");
#endif
    }

    struct Run
    {
      const Scene &scene;
      Parameters parameters;
      bool is_batch;
      Numerics numerics = {};

      /// Computes one run on this level or mesh, or a batch of identical runs, of which the first is returned.
      SimulationResult
      operator()(const std::function<bool()> &keep_going) const
      {
        const bool energy_balance = parameters.output.energy_balance;
        if (parameters.model != Model::nonlinear)
          return ReducedModel(scene, parameters.model).compute(parameters.accuracy, energy_balance, keep_going);
        // Single runs are those of crawler run, whose steps end where the last stride begins.
        const auto gait             = is_batch ? GaitWish::none : GaitWish::any;
        const RecordOptions options = {.energy_balance = energy_balance, .gait = gait};
        if (!is_batch)
          return Simulation(MPI_COMM_SELF, scene, parameters.time, numerics).run({}, options, {}, keep_going);
        const std::vector<BatchRun> runs(batch_size, {&scene, &parameters.time, &numerics});
        if (auto results = run_batch(runs, options, keep_going); results[0])
          return std::move(*results[0]);
        SimulationResult given_up;
        given_up.time.status  = Status::failed;
        given_up.time.reason  = "gave_up";
        given_up.time.message = "the batch engine gave up; the run needs an engine for single runs";
        return given_up;
      }
    };

    /// Row of a setting that is not computed, for this reason; with the limit [s] if it would take too long.
    TradeoffTexts
    gap(const std::string &status, const std::string &reason, const std::string &message, const double limit = NAN)
    {
      return {{"status", status},
              {"reason", reason},
              {"message", message},
              {"time limit", to_text(limit)},
              {"below bar", "false"}};
    }

    TradeoffTexts
    row_of(const TimeOutcome &outcome)
    {
      return gap(word_of(outcome.status), outcome.reason, outcome.message);
    }

    /// Times the runs; returns false if it was interrupted.
    bool
    time_runs(TradeoffTexts &row, const Run &run, const double first_seconds, const std::function<bool()> &interrupted)
    {
      const double n_bodies = run.is_batch ? batch_size : 1.;
      const bool is_long    = first_seconds > long_run;
      std::vector<double> seconds(is_long ? 1 : 0, first_seconds / n_bodies);
      auto repetitions = static_cast<double>(seconds.size());
      // Short runs are not interrupted: the checks would be a part of their cost.
      const auto keep_going = is_long ? std::function<bool()>([&]() { return !interrupted(); }) : nullptr;
      while (seconds.size() < run.parameters.tradeoff.repetitions)
      {
        const double start = processor_seconds();
        double n           = 0.;
        double passed      = 0.;
        for (; passed < shortest_measurement; passed = processor_seconds() - start)
        {
          run(keep_going);
          ++n;
        }
        seconds.push_back(passed / (n * n_bodies));
        repetitions += n;
        if (interrupted())
          return false;
      }
      std::ranges::sort(seconds);
      const std::size_t n = seconds.size();
      const double median = 0.5 * (seconds[(n - 1) / 2] + seconds[n / 2]);
      row["repetitions"]  = to_text(repetitions);
      row["seconds"]      = to_text(median);
      row["spread"]       = to_text((seconds.back() - seconds.front()) / median);
      return true;
    }

    /// Measures the row, without the entries. Failures are thrown.
    std::optional<TradeoffTexts>
    measured(Run run, const bool is_adaptive, const std::function<bool()> &interrupted)
    {
      const double limit = run.parameters.tradeoff.run_time_limit, end = now() + limit;
      const auto late = [&]() {
        auto row = gap("stopped", time_limit_reason, fmt::format("stopped after {:g} s", limit), limit);
        return interrupted() ? std::nullopt : std::optional(row);
      };
      const double start = processor_seconds();
      if (run.parameters.model == Model::nonlinear)
      {
        const auto in_time = [&]() { return now() < end && !interrupted(); };
        const auto choice  = choose_numerics({run.parameters, run.scene, in_time});
        if (!choice)
          return late();
        run.numerics = choice->numerics;
      }
      const double heap_before = heap_bytes(), start_of_run = processor_seconds();
      double max_heap            = heap_before;
      unsigned long n_steps      = 0;
      bool is_out_of_time        = false;
      auto result                = run([&]() {
        if (++n_steps <= looks_at_heap || n_steps % steps_between_looks == 0)
          max_heap = std::fmax(max_heap, heap_bytes());
        is_out_of_time = now() > end;
        return !is_out_of_time && !interrupted();
      });
      const double first_seconds = processor_seconds() - start_of_run;
      if (is_out_of_time)
        return late();
      if (interrupted())
        return std::nullopt;
      check_identities(result, run.parameters);
      TradeoffTexts row = row_of(result.time);
      if (is_adaptive)
        row["choice seconds"] = to_text(start_of_run - start);
      if (run.parameters.model == Model::nonlinear)
      {
        row["steps"]             = to_text(result.time.steps);
        row["rejected steps"]    = to_text(result.time.rejected_steps);
        row["newton iterations"] = to_text(result.time.newton_iterations);
        row["most cells"]        = to_text(std::max(result.process.mesh.most_cells, run.numerics.n_cells));
      }
      // Levels that miss the requested accuracy have an answer all the same; its message says so.
      const bool misses_accuracy = result.time.reason == accuracy_not_met && std::isfinite(result.displacement);
      if (result.time.status != Status::finished && !misses_accuracy)
        return row;
      row["status"]       = "finished";
      row["reason"]       = "";
      row["message"]      = misses_accuracy ? result.time.message : "";
      row["displacement"] = to_text(result.displacement);
      row["memory"]       = to_text(max_heap - heap_before);
      return time_runs(row, run, first_seconds, interrupted) ? std::optional(row) : std::nullopt;
    }

    /**
     * Row of a setting: the computation of `crawler run` without snapshots, on this rank alone; @p entries are those of
     * the setting. The first run gives displacement and memory, and must keep the time limit; the others are timed. The
     * cost is the processor time to build the simulation and run it, without the choice of the numerics, in a process
     * that has done so before. Returns nothing if it was interrupted. Failures are the status of the row.
     */
    std::optional<TradeoffTexts>
    measure(const Input &input,
            const TradeoffSetting &setting,
            const std::vector<std::string> &entries,
            const std::function<bool()> &interrupted)
    {
      if (!setting.not_offered.empty())
        return gap("not offered", "not_offered", setting.not_offered);
      try
      {
        ParameterFile file = input.file;
        for (const std::string &one : entries)
          file.add_override(one);
        const Parameters parameters = Form(file).parameters;
        const Scene scene           = parameters.create_scene(); // refuses what `crawler run` refuses
        const Run run{scene, parameters, setting["engine"] == "batch"};
        return measured(run, setting["mesh"] == "adaptive", interrupted);
      }
      catch (const InputError &error)
      {
        return gap("refused", "inadmissible", error.what());
      }
      catch (...)
      {
        return row_of(failure_of(std::current_exception()));
      }
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
      for (const unsigned long i : spread_out(all.size()))
        spread.push_back(all[i]);
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
      const Input &input = study.input;
      std::string text;
      study.done        = points_done(study.communicator, [&]() {
        auto done = begin_or_resume(study.folder, study.table, input.file);
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
        PointTable table          = study.table;
        table.others["reference"] = text;
        create_table(study.folder, table);
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
    const PointTable table        = tradeoff_table(input, settings);
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
