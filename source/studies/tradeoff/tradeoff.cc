// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/model_choice.h>
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/row_file.h>
#include <crawler/base/stop_signal.h>
#include <crawler/base/work_queue.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/core/study_folder.h>
#include <crawler/studies/tradeoff/tradeoff.h>
#include <crawler/studies/tradeoff/tradeoff_measurement.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>
#include <crawler/studies/tradeoff/tradeoff_results.h>

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    /// Rows by the numbers of their settings.
    using Rows = std::map<unsigned long, TradeoffRow>;

    /// What all parts of the study need.
    struct Study
    {
      const Parameters &parameters;
      const Scene &scene;
      const TradeoffReference &reference;
      const std::vector<TradeoffFamily> &families;
      const std::function<bool()> &interrupted;
    };

    /// The rows of one family, in the order of its tolerances.
    std::vector<TradeoffRow>
    rows_of(const TradeoffFamily &family, const Rows &rows)
    {
      std::vector<TradeoffRow> own;
      for (std::size_t i = 0; i < family.tolerances.size(); ++i)
      {
        const auto found = rows.find(family.first_index + i);
        if (found == rows.end())
          break;
        own.push_back(found->second);
      }
      return own;
    }

    std::optional<std::size_t>
    next_of(const Study &study, const TradeoffFamily &family, const std::vector<TradeoffRow> &rows)
    {
      std::vector<TriedSetting> tried;
      for (const TradeoffRow &row : rows)
        tried.push_back({row.status, row.reason, row.displacement});
      return next_tolerance(family, tried, study.reference.displacement(), study.reference.bar);
    }

    /// This rank's share of the families that are not done. A signal ends the work of all ranks.
    Rows
    measure_own(MPI_Comm communicator,
                const Study &study,
                const Rows &kept,
                const fs::path &folder,
                TradeoffRowWriter &writer,
                Log &log)
    {
      std::vector<const TradeoffFamily *> pending;
      for (const TradeoffFamily &family : study.families)
        if (next_of(study, family, rows_of(family, kept)))
          pending.push_back(&family);
      Rows own;
      if (pending.empty())
        return own;
      CrashNote note(folder);
      const Crashes crashes = crashes_in(folder);
      WorkQueue queue(communicator, pending.size());
      StudyProgress progress(log, pending.size(), "meshes");
      const unsigned long stride = golden_stride(pending.size());
      while (const auto number = queue.next())
      {
        const TradeoffFamily &family = *pending[*number * stride % pending.size()];
        TradeoffMeasurement measurement(study.parameters, study.scene, family, study.reference.size, study.interrupted);
        std::vector<TradeoffRow> rows = rows_of(family, kept);
        while (const auto tolerance = next_of(study, family, rows))
        {
          const unsigned long setting = family.first_index + *tolerance;
          note.at_work_on(std::span(&setting, 1));
          const auto row = study.interrupted()             ? std::nullopt
                           : is_given_up(setting, crashes) ? std::optional(measurement.crashed(*tolerance))
                                                           : measurement.measure(*tolerance);
          if (!row)
          {
            queue.close();
            return own;
          }
          writer.write(*row);
          note.at_work_on({});
          rows.push_back(*row);
          own.emplace(row->index, *row);
        }
        queue.done();
        progress.report(queue.so_far().done, fmt::format(" ({} settings on this rank)", own.size()));
      }
      return own;
    }

    /// A short run that is the same on all ranks: its processor time, on all ranks at once [s].
    std::vector<double>
    calibrate(MPI_Comm communicator, const Study &study)
    {
      TradeoffFamily family;
      family.setting.formulation      = "position";
      family.setting.mesh             = "uniform";
      family.setting.engine           = "petsc";
      family.setting.integrator       = "bdf";
      family.setting.degree           = 4;
      family.setting.cells            = 8;
      family.tolerances               = {1e-5};
      Parameters parameters           = study.parameters;
      parameters.tradeoff.repetitions = 5;
      MPI_Barrier(communicator);
      TradeoffMeasurement measurement(parameters, study.scene, family, study.reference.size, study.interrupted);
      const auto row       = measurement.measure(0);
      const double seconds = row ? row->seconds : TradeoffRow::unknown;
      std::vector<double> all(size_of(communicator));
      MPI_Allgather(&seconds, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, communicator);
      return all;
    }

    void
    report_reference(const TradeoffReference &reference, const Parameters &parameters, Log &log)
    {
      log.line(fmt::format("Reference: displacement {:.15g} by {}; the last refinement changed it by {:.1e}.",
                           reference.displacement(),
                           reference.first.method,
                           reference.first.change / reference.size));
      if (reference.is_checked())
        log.line(
          fmt::format("  Checked by {}: it differs by {:.1e}. Errors below the bar of {:.1e} cannot be told from 0.",
                      reference.second.method,
                      std::abs(reference.second.displacement - reference.displacement()) / reference.size,
                      reference.relative_bar()));
      else
        log.warn(fmt::format("no second method could check the reference; its own last change gives the bar, {:.1e}",
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
      if (reference.status == "stopped" && reference.message.empty())
      {
        log.warn("stopped while the reference was made; --resume starts with it");
        return ExitCode::stopped;
      }
      log.warn("no method gives a displacement to measure errors against; the last one: " + reference.message);
      return reference.status == "inverted" ? ExitCode::inverted : ExitCode::numerical_failure;
    }

    TradeoffLists
    lists_of(const Input &input)
    {
      try
      {
        // The reference needs the whole equation.
        Parameters whole = input.parameters;
        whole.model      = Model::nonlinear;
        choose_model(whole, input.scene);
        return read_lists(input.parameters);
      }
      catch (const InputError &error)
      {
        throw input.file.with_place(error);
      }
    }

    /// What an earlier start has left.
    struct Earlier
    {
      bool is_done = false;
      std::string reference; ///< as a text; empty: there is none
      Rows rows;
    };

    fs::path
    reference_file(const fs::path &folder)
    {
      return folder / "rows" / "reference.json";
    }

    /// Known to all ranks.
    Earlier
    begin_or_resume(MPI_Comm communicator, StudyFolder &folder, const Input &input)
    {
      Earlier earlier;
      const fs::path rows = folder.path() / "rows", file = reference_file(folder.path());
      earlier.reference = on_first_rank(communicator, [&]() -> std::string {
        if (!folder.begin(input.file.text(), input.effective))
        {
          fs::remove_all(rows); // of an earlier study
          fs::create_directories(rows);
          return "";
        }
        folder.resume([&]() {
          return differences(
            read_whole_file(folder.path() / "parameters.prm"), input.effective, folder.kind().free_entries);
        });
        if (!fs::exists(rows))
          return "done";
        earlier.rows = recover_rows(folder.path());
        return fs::exists(file) ? read_whole_file(file) : "";
      });
      earlier.is_done   = earlier.reference == "done";
      earlier.rows      = unpack_rows(broadcast(pack(earlier.rows), communicator));
      return earlier;
    }

    /// All files of the results, written by rank 0.
    void
    write_results(const fs::path &folder,
                  const TradeoffResults &results,
                  const TradeoffCourse &course,
                  const std::string &effective,
                  Log &log)
    {
      const Table table = tradeoff_table(results);
      write_file(folder / "tradeoff.csv", csv(table));
      write_hdf5(folder / "tradeoff.h5", "tradeoff", table, provenance(effective, course.command_line));
      write_file(folder / "recommendations.prm", recommendations_prm(results));
      write_file(folder / "summary.json", tradeoff_json(results, course));
      log.line(in_words(results, course));
      for (const std::string &line : recommendation_lines(results))
        log.line(line);
      if (std::count(results.on_front.begin(), results.on_front.end(), true) > 0) // there is something to draw
        draw("tradeoff", folder, log);
      if (course.status == "finished") // all files are there: nothing is left to do
        fs::remove_all(folder / "rows");
      log.line(fmt::format("Results are in {0}/; {0}/recommendations.prm has the blocks to paste.", folder.string()));
    }
  } // namespace

  ExitCode
  tradeoff(MPI_Comm communicator, const CommandOptions &options)
  {
    const StopSignal stop_signal; // from here on a signal ends the study in order
    const double start = now();
    const bool first   = rank_of(communicator) == 0;
    Log log(first, options);
    const Input input = read_input(read_file(communicator, options.file, options.overrides), /*command=*/"tradeoff");
    const Parameters &parameters            = input.parameters;
    const TradeoffLists lists               = lists_of(input);
    const auto folder                       = output_folder(options.output, options.file);
    const auto is_out_of_time               = [&]() { return now() - start > parameters.tradeoff.time_limit; };
    const std::function<bool()> interrupted = [&]() {
      return stop_signal.arrived_anywhere(MPI_COMM_SELF) || is_out_of_time();
    };

    StudyFolder study_folder({"tradeoff", {"rows", "tradeoff.csv"}, {"Tradeoff/Time limit"}}, folder, options, log);
    Earlier earlier = begin_or_resume(communicator, study_folder, input);
    if (earlier.is_done)
    {
      log.line(fmt::format("The tradeoff in {} is finished; nothing is left to do.", folder.string()));
      study_folder.leave();
      return ExitCode::finished;
    }
    if (options.resume)
      log.line(fmt::format("Resumed with {} settings that are done.", earlier.rows.size()));

    log.line(fmt::format(
      "Tradeoff of {} on {}: making the reference ...", input.file.name(), counted(size_of(communicator), "rank")));
    for (const std::string &note : input.notes)
      log.line(note);
    if (earlier.reference.empty())
    {
      // On every rank alike, so that none has an idle core beside it; the first one's is used.
      const auto report = [&log](const std::string &line) { log.line(line); };
      earlier.reference =
        broadcast(pack(make_reference(parameters, input.scene, lists, interrupted, report)), communicator);
      if (first && unpack_reference(earlier.reference).status == "finished")
        write_file(reference_file(folder), earlier.reference);
    }
    const TradeoffReference reference = unpack_reference(earlier.reference);
    if (reference.status != "finished")
    {
      study_folder.leave();
      return no_reference(reference, log);
    }
    report_reference(reference, parameters, log);
    const auto all_families = families(lists, parameters, input.scene, reference.meshes);
    const Study study{parameters, input.scene, reference, all_families, interrupted};
    TradeoffCourse course;
    course.n_settings           = all_families.back().first_index + all_families.back().tolerances.size();
    course.n_ranks              = size_of(communicator);
    course.command_line         = options.command_line;
    course.calibration.at_start = calibrate(communicator, study);
    log.line(fmt::format(
      "{} settings on {} meshes; the reference took {:.1f} s.", course.n_settings, all_families.size(), now() - start));

    TradeoffRowWriter writer(folder, rank_of(communicator));
    const Rows own            = measure_own(communicator, study, earlier.rows, folder, writer, log);
    course.calibration.at_end = calibrate(communicator, study);
    Rows rows                 = std::move(earlier.rows);
    for (const std::string &part : gather(pack(own), communicator)) // on rank 0
      rows.merge(unpack_rows(part));
    int code = 0;
    if (first)
    {
      const bool finished = std::none_of(all_families.begin(), all_families.end(), [&](const TradeoffFamily &family) {
        return next_of(study, family, rows_of(family, rows)).has_value();
      });
      course.status       = finished ? "finished" : "stopped";
      course.reason       = finished ? "" : is_out_of_time() ? "time_limit" : "signal";
      code                = static_cast<int>(finished ? ExitCode::finished : ExitCode::stopped);
      course.seconds      = now() - start;
    }
    on_first_rank(communicator, [&]() {
      study_folder.require_in_place();
      std::vector<TradeoffRow> tried;
      for (const auto &[index, row] : rows)
        tried.push_back(row);
      write_results(folder, evaluate(reference, std::move(tried)), course, input.effective, log);
      if (course.status == "stopped")
        log.warn(fmt::format("stopped by {} after {} settings; --resume goes on",
                             course.reason == "signal" ? "a signal" : "Tradeoff/Time limit",
                             rows.size()));
      study_folder.leave();
      return "";
    });
    MPI_Bcast(&code, 1, MPI_INT, 0, communicator);
    return static_cast<ExitCode>(code);
  }
} // namespace crawler
