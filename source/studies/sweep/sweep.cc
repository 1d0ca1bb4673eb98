// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/sweep/sweep.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    /// "6 points, grid over Body/Length (2 values), ..."
    std::string
    in_words(const SweepDesign &design, const std::string &design_name)
    {
      std::vector<std::string> axes;
      for (const SweepAxis &axis : design.axes())
        axes.push_back(axis.entry +
                       (design_name == "grid" ? fmt::format(" ({})", counted(axis.values.size(), "value")) : ""));
      return fmt::format("{}, {} over {}", counted(design.n_points(), "point"), design_name, fmt::join(axes, ", "));
    }

    /// Writes the folders points/NUMBER of the points whose fields are kept, by `crawler run` with their values. Points
    /// that were given up have none.
    bool
    keep_fields(MPI_Comm communicator,
                const StudyFolder &folder,
                const SweepPoints &points,
                const std::vector<unsigned long> &kept)
    {
      bool all = true;
      std::string problem;
      const RowReader table(MPI_COMM_SELF, folder.path / sweep_file, sweep_group);
      const std::size_t reason = table.index_of("reason");
      for (std::size_t i = rank_of(communicator); i < kept.size(); i += size_of(communicator))
      {
        const fs::path place = folder.path / "points" / fmt::format("{}", kept[i]);
        const Column row     = table.read(reason, kept[i], 1);
        if (fs::exists(place / "summary.json") ||
            std::get<std::vector<std::string>>(row.values).front() == time_limit_reason)
          continue;
        const fs::path &file = folder.options.file;
        try
        {
          all = run_for_study(folder.options,
                              file == "-" ? folder.path / "original.prm" : file,
                              points.overrides(kept[i]),
                              place) != ExitCode::stopped &&
                all;
        }
        catch (const InputError &) // inconsistent values: the row says so, and there are no fields
        {
          std::error_code error;
          fs::remove(place, error); // removed only if it is empty
        }
        catch (const std::exception &error)
        {
          problem = error.what();
        }
      }
      throw_on_all_ranks(communicator, problem);
      return !is_true_anywhere(!all, communicator);
    }

    PointTable
    table_of(const SweepPoints &points)
    {
      PointTable table = {
        sweep_file, sweep_group, sweep_columns(points), points.effective(), points.design().n_points()};
      table.known              = known_columns(table.columns, points.design());
      table.time_limit         = points.sweep().point_time_limit.value_or(HUGE_VAL);
      const std::string reason = "reason"; // column of the point, and of each run of a cross-check
      for (const RowFile::Column &column : table.columns)
        if (column.name.ends_with(reason))
          table.reasons_and_seconds.emplace_back(column.name,
                                                 column.name.substr(0, column.name.size() - reason.size()) + "seconds");
      return table;
    }

    /// Computes the missing rows on all ranks. Returns false if some rank was interrupted.
    bool
    compute_rows(MPI_Comm communicator,
                 const StudyFolder &folder,
                 SweepPoints &points,
                 const PointTable &table,
                 const std::vector<bool> &done,
                 const std::function<bool()> &interrupted)
    {
      CrashNote note(folder.path);
      SweepWork own(points, size_of(communicator), &note);
      RowFile results(communicator, folder.path / table.file, table.group, table.written_columns());
      return share_work(
        communicator,
        {own.n_parts(),
         static_cast<unsigned long>(std::count(done.begin(), done.end(), false)),
         "points",
         interrupted,
         [&](const unsigned long number, const auto &stops, const auto &see) {
           return own.compute(
             number,
             done,
             [&](const unsigned long first, const std::span<const RowFile::Row> rows) { results.write(first, rows); },
             stops,
             see);
         }},
        folder.log);
    }

    void
    report_check(const SweepCounts &counts, Log &log)
    {
      for (const auto &[point, why] : counts.wrong_answers)
        log.line(fmt::format("Silent wrong answer at point {}: {}", point, why));
      if (const auto n = counts.number_of(Verdict::silent_wrong_answer); n > counts.wrong_answers.size())
        log.line(fmt::format("... and {} more (column verdict of results.csv)", n - counts.wrong_answers.size()));
      log.line(fmt::format(
        "Cross-check: {} with two answers at least, {}{}.",
        counted(counts.checked(), "point"),
        counted(counts.number_of(Verdict::silent_wrong_answer), "silent wrong answer"),
        std::isnan(counts.largest_error_ratio)
          ? ""
          : fmt::format("; the largest measured error is {:.2g} of the promised one", counts.largest_error_ratio)));
    }

    void
    report(const SweepCounts &counts, const SweepEnd &end, const StudyFolder &folder, const StudyClock &clock)
    {
      Log &log = folder.log;
      std::vector<std::string> words;
      for (const auto &[status, count] : counts.statuses)
        words.push_back(fmt::format("{} {}", count, status));
      log.line(fmt::format("{}: {}. {:.1f} s, {:.4g} points/s.",
                           counted(counts.n_points, "point"),
                           fmt::join(words, ", "),
                           end.seconds,
                           static_cast<double>(n_computed(counts, end)) / end.seconds));
      if (!counts.verdicts.empty())
        report_check(counts, log);
      if (end.status != "finished")
        log.warn(clock.in_words(end.reason) + "; --resume continues");
      log.line(fmt::format("Results are in {0}/results.h5 and {0}/results.csv; draw them with: crawler plot {0}",
                           folder.path.string()));
    }

    std::string
    size_in_words(const double bytes)
    {
      return bytes < 1e6   ? fmt::format("{:.3g} kB", bytes / 1e3)
             : bytes < 1e9 ? fmt::format("{:.3g} MB", bytes / 1e6)
                           : fmt::format("{:.3g} GB", bytes / 1e9);
    }

    /// Writes the files and the lines at the end of a sweep; returns its exit code.
    ExitCode
    end_sweep(MPI_Comm communicator, SweepEnd end, StudyFolder &folder, const StudyClock &clock)
    {
      try
      {
        const SweepCounts counts = write_results_csv(communicator, folder.path);
        end.seconds              = clock.seconds();
        return exit_code_of_first_rank(communicator, [&]() {
          write_file(folder.path / "summary.json", sweep_json(counts, end));
          report(counts, end, folder, clock);
          folder.leave();
          const auto finished     = counts.statuses.find("finished");
          const auto not_finished = counts.n_points - (finished == counts.statuses.end() ? 0 : finished->second);
          return end.status != "finished"                    ? ExitCode::stopped
                 : folder.options.strict && not_finished > 0 ? ExitCode::rows_failed
                                                             : ExitCode::finished;
        });
      }
      catch (const FileError &error)
      {
        throw FileError(fmt::format("{}; results.h5 is intact, and --resume computes the rest", error.what()),
                        /*on_all_ranks=*/true);
      }
    }
  } // namespace

  ExitCode
  sweep(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file)
  {
    StudyClock clock;
    const unsigned int n_ranks = size_of(communicator);
    Log log(rank_of(communicator) == 0, options);
    SweepPoints points(communicator, file);
    points.require_checkable();
    const SweepDesign &design  = points.design();
    const SweepParameters &own = points.sweep();
    const auto kept            = points.kept_points();
    PointTable table           = table_of(points);
    StudyFolder folder(
      {"sweep", sweep_file, {"Sweep/Time limit", "Sweep/Time limit per point", "Sweep/Keep fields"}}, options, log);
    const std::vector<bool> done = points_done(communicator, [&]() {
      table.inputs = sweep_inputs(points);
      auto list    = begin_or_resume(folder, table, file);
      if (std::count(list.begin(), list.end(), true) == 0)
        remove_runs(folder.path / "points", "[0-9]+"); // fields of an earlier sweep
      return list;
    });
    const auto n_done            = static_cast<unsigned long>(std::count(done.begin(), done.end(), true));
    log.line(fmt::format("Sweep: {}, on {}{}",
                         in_words(design, own.design),
                         counted(n_ranks, "rank"),
                         n_done > 0 ? fmt::format("; {} are already done", n_done) : ""));
    for (const std::string &note : points.notes())
      log.line(note);
    announce_petsc_options(options, log);

    clock.set_limit(own.time_limit, "Sweep/Time limit");
    bool is_whole      = compute_rows(communicator, folder, points, table, done, [&]() { return clock.is_over(); });
    std::string reason = clock.reason(communicator, is_whole);
    if (n_done < design.n_points())
      warn_of_unused_petsc_options(communicator, options, log);
    if (is_whole && !kept.empty() && !keep_fields(communicator, folder, points, kept))
    {
      is_whole = false;
      reason   = "signal";
    }
    on_first_rank(communicator, [&]() { folder.require_in_place(); });
    return end_sweep(communicator,
                     {is_whole ? "finished" : "stopped", reason, 0., n_ranks, n_done, options.command_line},
                     folder,
                     clock);
  }

  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log)
  {
    const Assignment *const axes = file.assignment_of("Sweep/Axes");
    if (axes == nullptr || axes->value.empty())
      return false;
    SweepPoints points(communicator, file);
    points.require_checkable();
    const SweepDesign &design = points.design();
    const PointTable table    = table_of(points);
    // Measured time of some parts, spread over the sweep.
    constexpr unsigned long max_samples = 32;
    constexpr double long_enough        = 0.5; // [s]
    SweepWork work(points, size_of(communicator));
    const auto parts = spread_out(work.n_parts());
    const std::vector<bool> none_done(design.n_points(), false);
    const auto write_nothing = [](unsigned long, std::span<const RowFile::Row>) {};
    const auto never_stopped = []() { return false; };
    unsigned long n_computed = 0;
    const auto count         = [&](const unsigned long n, unsigned long) { n_computed += n; };
    const double before      = now();
    for (unsigned long i = 0; i < parts.size() && n_computed < design.n_points() &&
                              (i < max_samples || n_computed == 0) && now() - before < long_enough;
         ++i)
      work.compute(parts[(i + 1) % parts.size()], none_done, write_nothing, never_stopped, count);
    const double each = (now() - before) / static_cast<double>(n_computed);
    log.line(fmt::format("Sweep: {}.", in_words(design, points.sweep().design)));
    for (const std::string &note : points.notes())
      log.line(note);
    const double all = each * static_cast<double>(design.n_points());
    log.line(
      fmt::format("  About {} per point (measured on {} of them): {} on one rank{}; results.h5 will have about {}, "
                  "results.csv less.",
                  duration_in_words(each),
                  n_computed,
                  duration_in_words(all),
                  size_of(communicator) > 1
                    ? fmt::format(", {} on {}", duration_in_words(all / size_of(communicator)), size_of(communicator))
                    : "",
                  size_in_words(RowFile::bytes_of(table.columns, table.n_rows, table.attributes("")))));
    log.line(file.name() + " is valid: all swept names and values are admissible. Nothing was written.");
    return true;
  }
} // namespace crawler
