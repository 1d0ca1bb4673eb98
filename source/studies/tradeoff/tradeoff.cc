// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/model_choice.h>
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/stop_signal.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/core/study_folder.h>
#include <crawler/studies/core/table_csv.h>
#include <crawler/studies/tradeoff/tradeoff.h>
#include <crawler/studies/tradeoff/tradeoff_measurement.h>
#include <crawler/studies/tradeoff/tradeoff_results.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    /// What all parts of the study need.
    struct Study
    {
      const Parameters &parameters;
      const Scene &scene;
      const TradeoffReference &reference;
      const std::vector<TradeoffSetting> &settings;
      std::vector<bool> done; ///< settings that have a row
    };

    /// Settings first, first + 1, ... before `end` share a mesh.
    struct MeshSettings
    {
      unsigned long first, end;
    };

    /// The meshes with settings that are not done, spread out.
    std::vector<MeshSettings>
    meshes_to_do(const Study &study)
    {
      std::vector<MeshSettings> all;
      const auto &settings = study.settings;
      for (unsigned long first = 0, end; first < settings.size(); first = end)
      {
        for (end = first + 1; end < settings.size() && same_mesh(settings[first], settings[end]);)
          ++end;
        const auto done = study.done.begin();
        if (std::find(done + static_cast<long>(first), done + static_cast<long>(end), false) !=
            done + static_cast<long>(end))
          all.push_back({first, end});
      }
      std::vector<MeshSettings> spread;
      const unsigned long n = all.size(), stride = golden_stride(std::max(1ul, n));
      for (unsigned long i = 0; i < n; ++i)
        spread.push_back(all[i * stride % n]);
      return spread;
    }

    /// The rows that are missing, by all ranks. Returns false if some rank was interrupted.
    bool
    measure_all(MPI_Comm communicator,
                const Study &study,
                const fs::path &folder,
                const std::function<bool()> &interrupted,
                Log &log)
    {
      const PointTable table = tradeoff_table();
      RowFile rows(communicator, folder / table.file, table.group, table.written_columns());
      CrashNote note(folder);
      const Crashes crashes = crashes_in(folder);
      const auto meshes     = meshes_to_do(study);
      const auto row_of     = [&](const unsigned long setting, TradeoffMeasurement &measurement) {
        if (!is_given_up(setting, crashes))
          return measurement.measure(study.settings[setting]);
        TradeoffRow row;
        row.setting = study.settings[setting];
        row.not_computed("failed", "crashed", crash_message);
        return std::optional(row);
      };
      return share_work(communicator,
                        {meshes.size(),
                         static_cast<unsigned long>(std::count(study.done.begin(), study.done.end(), false)),
                         "settings",
                         interrupted,
                         [&](const unsigned long number, const auto &stops, const auto &see) {
                           TradeoffMeasurement measurement(study.parameters, study.scene, study.reference.size, stops);
                           for (unsigned long i = meshes[number].first; i < meshes[number].end; ++i)
                             if (!study.done[i])
                             {
                               note.at_work_on(std::span(&i, 1));
                               auto row = stops() ? std::nullopt : row_of(i, measurement);
                               if (!row)
                                 return false;
                               row->compare(study.reference);
                               rows.write(i, {{written_row(*row)}});
                               note.at_work_on({});
                               see(1, !row->is_finished());
                             }
                           return true;
                         }},
                        log);
    }

    void
    report_reference(const TradeoffReference &reference, const Parameters &parameters, Log &log)
    {
      log.line(
        fmt::format("Reference: displacement {:.15g} by {}.", reference.answer.displacement, reference.answer.method));
      if (reference.is_checked())
        log.line(
          fmt::format("  Checked by {}: it differs by {:.1e}. Errors below the bar of {:.1e} cannot be told from 0.",
                      reference.check.method,
                      std::abs(reference.check.displacement - reference.answer.displacement) / reference.size,
                      reference.relative_bar()));
      else
        log.warn(fmt::format("no second method could check the reference; its own error bound gives the bar, {:.1e}",
                             reference.relative_bar()));
      if (reference.relative_bar() > parameters.accuracy)
        log.warn(fmt::format("the reference is known to {:.1e} only, but Accuracy is {:g}: nothing can be said about "
                             "settings that are as good as that",
                             reference.relative_bar(),
                             parameters.accuracy));
    }

    /// Without a reference there is nothing to measure against.
    ExitCode
    no_reference(const TradeoffReference &reference, Log &log)
    {
      if (reference.status == "stopped")
      {
        log.warn(reference.message + "; --resume starts with the reference");
        return ExitCode::stopped;
      }
      log.warn("the nonlinear model gives no displacement to measure errors against: " + reference.message);
      return reference.status == "inverted" ? ExitCode::inverted : ExitCode::numerical_failure;
    }

    std::vector<TradeoffSetting>
    settings_of(const Input &input)
    {
      try
      {
        // The reference needs the whole equation.
        Parameters whole = input.parameters;
        whole.model      = Model::nonlinear;
        choose_model(whole, input.scene);
        return settings_to_try(input.parameters, input.scene);
      }
      catch (const InputError &error)
      {
        throw input.file.with_place(error);
      }
    }

    constexpr const char *reference_attribute = "reference";

    /// What an earlier start has left, known to all ranks: which settings are done, and the reference as a text, empty
    /// if there is none.
    std::pair<std::vector<bool>, std::string>
    begin_or_resume(MPI_Comm communicator, StudyFolder &folder, const Input &input, const std::size_t n_settings)
    {
      std::string reference;
      const auto done = points_done(communicator, [&]() {
        const PointTable table = tradeoff_table();
        if (!folder.begin(input.file.text(), input.effective))
          return std::vector<bool>(n_settings, false);
        folder.resume([&]() {
          return differences(
            read_whole_file(folder.path() / "parameters.prm"), input.effective, folder.kind().free_entries);
        });
        warn_of_other_versions(folder, table);
        reference = read_attribute(folder.path() / table.file, table.group, reference_attribute);
        return rows_done(RowReader(MPI_COMM_SELF, folder.path() / table.file, table.group), table, folder.log());
      });
      return {done, broadcast(reference, communicator)};
    }

    /// All files of the results; tradeoff.h5 then knows the fronts (one process).
    void
    write_results(const fs::path &folder, const TradeoffResults &results, const TradeoffCourse &course, Log &log)
    {
      const PointTable table = tradeoff_table();
      {
        RowFile rows(MPI_COMM_SELF, folder / table.file, table.group, table.written_columns());
        for (std::size_t i = 0; i < results.rows.size(); ++i)
          if (!results.rows[i].status.empty())
            rows.write(i, {{written_row(results.rows[i])}});
      }
      write_table_csv(MPI_COMM_SELF, folder / table.file, table.group, folder / "tradeoff.csv", [](const Table &) {});
      write_file(folder / "recommendations.prm", recommendations_prm(results));
      write_file(folder / "summary.json", tradeoff_json(results, course));
      log.line(in_words(results, course));
      for (const std::string &line : recommendation_lines(results))
        log.line(line);
      const auto is_on_front = [](const TradeoffRow &row) { return row.pareto == "true"; };
      if (std::any_of(results.rows.begin(), results.rows.end(), is_on_front)) // there is something to draw
        draw("tradeoff", folder, log);
      const auto &blocks = results.recommendations;
      if (blocks.empty() && course.status == "finished")
        log.line("No setting has a displacement that is good for 1e-2: there is nothing to recommend.");
      log.line(fmt::format("Results are in {}/{}.",
                           folder.string(),
                           blocks.empty() ? "" : "; recommendations.prm has the blocks to paste"));
    }
  } // namespace

  ExitCode
  tradeoff(MPI_Comm communicator, const CommandOptions &options)
  {
    const StopSignal stop_signal; // from here on a signal ends the study in order
    const double start = now();
    Log log(rank_of(communicator) == 0, options);
    const Input input = read_input(read_file(communicator, options.file, options.overrides), /*command=*/"tradeoff");
    const Parameters &parameters            = input.parameters;
    const auto settings                     = settings_of(input);
    const auto path                         = output_folder(options.output, options.file);
    const auto is_out_of_time               = [&]() { return now() - start > parameters.tradeoff.time_limit; };
    const std::function<bool()> interrupted = [&]() {
      return stop_signal.arrived_anywhere(MPI_COMM_SELF) || is_out_of_time();
    };
    StudyFolder folder({"tradeoff", {"tradeoff.h5"}, {"Tradeoff/Time limit"}}, path, options, log);
    auto [done, text] = begin_or_resume(communicator, folder, input, settings.size());
    const auto n_done = std::count(done.begin(), done.end(), true);
    log.line(fmt::format("Tradeoff of {}: {} settings on {}{}",
                         input.file.name(),
                         settings.size(),
                         counted(size_of(communicator), "rank"),
                         n_done > 0 ? fmt::format("; {} are done already", n_done) : ""));
    for (const std::string &note : input.notes)
      log.line(note);
    if (text.empty() || unpack_reference(text).status != "finished")
    {
      // On every rank alike, so that none has an idle core beside it; the first one's is used.
      log.line("Making the reference ...");
      const auto report = [&log](const std::string &line) { log.line(line); };
      text              = broadcast(pack(make_reference(parameters, interrupted, report)), communicator);
    }
    const TradeoffReference reference = unpack_reference(text);
    const bool has_reference          = reference.status == "finished";
    if (has_reference)
      report_reference(reference, parameters, log);
    if (n_done == 0)
      on_first_rank(communicator, [&]() {
        auto attributes                 = provenance(input.effective, options.command_line);
        attributes[reference_attribute] = text;
        create_tradeoff_table(path, settings, attributes);
        return "";
      });

    const Study study{parameters, input.scene, reference, settings, std::move(done)};
    const bool is_whole = has_reference && measure_all(communicator, study, path, interrupted, log);
    ExitCode code       = is_whole ? ExitCode::finished : ExitCode::stopped;
    if (!has_reference)
      code = no_reference(reference, log);
    on_first_rank(communicator, [&]() {
      folder.require_in_place();
      const TradeoffResults results = evaluate(parameters, reference, read_rows(path, settings));
      const std::string reason      = code != ExitCode::stopped ? "" : is_out_of_time() ? "time_limit" : "signal";
      write_results(path,
                    results,
                    {has_reference && !is_whole ? "stopped" : reference.status,
                     reason,
                     now() - start,
                     static_cast<unsigned int>(size_of(communicator)),
                     options.command_line},
                    log);
      if (has_reference && !is_whole)
        log.warn(fmt::format("stopped by {} after {} settings; --resume goes on",
                             reason == "signal" ? "a signal" : "Tradeoff/Time limit",
                             results.n_tried()));
      folder.leave();
      return "";
    });
    return code;
  }
} // namespace crawler
