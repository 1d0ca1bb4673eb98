// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_signal.h>
#include <crawler/base/work_queue.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_check.h>
#include <crawler/studies/sweep/sweep_folder.h>
#include <crawler/studies/sweep/sweep_results.h>
#include <crawler/studies/sweep/sweep_rows.h>
#include <crawler/studies/sweep/sweep_worker.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    std::string
    packed(const std::vector<bool> &flags)
    {
      std::string text(flags.size(), '0');
      for (std::size_t i = 0; i < flags.size(); ++i)
        text[i] = flags[i] ? '1' : '0';
      return text;
    }

    std::vector<bool>
    unpacked(const std::string &text)
    {
      std::vector<bool> flags(text.size());
      for (std::size_t i = 0; i < flags.size(); ++i)
        flags[i] = text[i] == '1';
      return flags;
    }

    bool
    on_all_ranks(MPI_Comm communicator, const bool here)
    {
      int all = here;
      MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, communicator);
      return all != 0;
    }

    /// What went wrong with the files of any rank is a FileError on all of them.
    void
    throw_on_all_ranks(MPI_Comm communicator, const std::string &problem)
    {
      const auto problems = gather(problem, communicator);
      on_first_rank(communicator, [&]() {
        for (const std::string &one : problems)
          if (!one.empty())
            throw FileError(one + "; the rows that were written are there, and --resume makes the rest");
        return "";
      });
    }

    /// The folders points/NUMBER of the points whose fields are kept, by `crawler run` with their values. Points that
    /// were given up have none.
    bool
    keep_fields(MPI_Comm communicator,
                const CommandOptions &options,
                const fs::path &folder,
                const SweepDesign &design,
                const SweepPoints &points,
                const std::vector<unsigned long> &kept)
    {
      bool all = true;
      std::string problem;
      const RowReader table(MPI_COMM_SELF, folder / "results.h5", sweep_group);
      const std::size_t reason = table.index_of("reason");
      for (std::size_t i = rank_of(communicator); i < kept.size(); i += size_of(communicator))
      {
        const fs::path place = folder / "points" / fmt::format("{}", kept[i]);
        const Column row     = table.read(reason, kept[i], 1);
        if (fs::exists(place / "summary.json") ||
            std::get<std::vector<std::string>>(row.values).front() == time_limit_reason)
          continue;
        CommandOptions one = options;
        if (one.file == "-")
          one.file = (folder / "original.prm").string();
        one.output    = place.string();
        one.overwrite = one.quiet = true;
        one.resume                = false;
        one.overrides             = points.overrides(design, kept[i]);
        try
        {
          fs::create_directories(place);
          all = run(MPI_COMM_SELF, one) != ExitCode::stopped && all;
        }
        catch (const InputError &) // values that do not fit together: the row says so, and there are no fields
        {
          std::error_code error;
          fs::remove(place, error); // if it is empty
        }
        catch (const std::exception &error)
        {
          problem = error.what();
        }
      }
      throw_on_all_ranks(communicator, problem);
      return on_all_ranks(communicator, all);
    }

    /// The rows that are missing, by all ranks. Returns false if some rank was interrupted. A file that one rank cannot
    /// write ends the work of all: FileError on all ranks.
    bool
    compute_rows(MPI_Comm communicator,
                 const fs::path &folder,
                 SweepPoints &points,
                 const std::vector<RowFile::Column> &columns,
                 const std::vector<bool> &done,
                 const std::function<bool()> &interrupted,
                 Log &log)
    {
      bool is_whole = true;
      std::string problem;
      {
        const SweepBlocks blocks(points.design());
        const SweepOrder order(blocks, points);
        const auto n_known = static_cast<std::ptrdiff_t>(known_columns(columns, points.design()).n_columns);
        const std::vector<RowFile::Column> written(columns.begin() + n_known, columns.end());
        RowFile results(communicator, folder / "results.h5", sweep_group, written);
        WorkQueue queue(communicator, blocks.size());
        StudyProgress progress(log, static_cast<unsigned long>(std::count(done.begin(), done.end(), false)), "points");
        const auto show_progress = [&]() {
          if (rank_of(communicator) != 0 || !progress.is_due())
            return;
          const auto all = queue.so_far();
          progress.report(all.done, all.failed > 0 ? fmt::format(", {} not finished", all.failed) : "");
        };
        const std::function<bool()> stops = [&]() // asked at every step of a run
        {
          queue.serve();
          show_progress();
          return interrupted();
        };
        SweepWorker worker(points, written, done, results, stops);
        const auto see = [&](const unsigned long n, const unsigned long failed) {
          queue.done(n, failed);
          show_progress();
        };
        try
        {
          while (const auto number = queue.next())
            if (!worker.compute(blocks[order[*number]], see))
            {
              is_whole = false;
              break;
            }
        }
        catch (const FileError &error)
        {
          problem = error.what();
        }
        if (!is_whole || !problem.empty())
          queue.close();
      }
      throw_on_all_ranks(communicator, problem);
      return on_all_ranks(communicator, is_whole);
    }

    /// What stands in the log at the end.
    void
    report(const SweepCounts &counts, const SweepEnd &end, const fs::path &folder, Log &log)
    {
      std::vector<std::string> words;
      for (const auto &[status, count] : counts.statuses)
        words.push_back(fmt::format("{} {}", count, status));
      log.line(fmt::format("{} point{}: {}. {:.1f} s, {:.4g} points/s.",
                           counts.n_points,
                           counts.n_points == 1 ? "" : "s",
                           fmt::join(words, ", "),
                           end.seconds,
                           static_cast<double>(n_computed(counts, end)) / end.seconds));
      if (end.status != "finished")
        log.warn(
          fmt::format("stopped by {}; --resume goes on", end.reason == "signal" ? "a signal" : "Sweep/Time limit"));
      log.line(fmt::format("Results are in {0}/results.h5 and {0}/results.csv; draw them with: {1} {0}",
                           folder.string(),
                           plot_script("sweep.py")));
    }
  } // namespace

  ExitCode
  sweep(MPI_Comm communicator, const CommandOptions &options)
  {
    const StopSignal stop_signal; // from here on a signal ends the sweep in order
    const double start         = now();
    const unsigned int n_ranks = size_of(communicator);
    Log log(rank_of(communicator) == 0, options.quiet);
    if (options.resume && options.overwrite)
      throw InputError("--resume and --overwrite contradict each other; one of them is expected");
    const ParameterFile file = read_file(communicator, options.file, options.overrides);
    SweepPoints points(communicator, file);
    const SweepDesign &design  = points.design();
    const SweepParameters &own = points.sweep();
    const auto kept            = points.kept_points();
    const auto columns         = sweep_columns(design, points.declarations());
    const fs::path path        = output_folder(options.output, options.file);
    SweepFolder folder(path, options, log);
    const std::vector<bool> done =
      unpacked(on_first_rank(communicator, [&]() { return packed(folder.begin_or_resume(file, points, columns)); }));
    const auto n_done = static_cast<unsigned long>(std::count(done.begin(), done.end(), true));
    log.line(fmt::format("Sweep: {}, on {} rank{}{}",
                         in_words(design, own.design),
                         n_ranks,
                         n_ranks == 1 ? "" : "s",
                         n_done > 0 ? fmt::format("; {} are done already", n_done) : ""));

    const std::function<bool()> interrupted = [&]() {
      return stop_signal.arrived_anywhere(MPI_COMM_SELF) || (own.time_limit && now() - start > *own.time_limit);
    };
    bool is_whole      = compute_rows(communicator, path, points, columns, done, interrupted, log);
    std::string reason = is_whole ? "" : stop_signal.arrived_anywhere(communicator) ? "signal" : "time_limit";
    if (is_whole && !kept.empty() && !keep_fields(communicator, options, path, design, points, kept))
    {
      is_whole = false;
      reason   = "signal";
    }
    SweepEnd end{is_whole ? "finished" : "stopped", reason, 0., n_ranks, n_done, options.command_line};
    try
    {
      const SweepCounts counts = write_results_csv(communicator, path);
      end.seconds              = now() - start;
      const std::string code   = on_first_rank(communicator, [&]() {
        write_file(path / "summary.json", sweep_json(counts, end));
        report(counts, end, path, log);
        folder.leave();
        const auto finished     = counts.statuses.find("finished");
        const auto not_finished = counts.n_points - (finished == counts.statuses.end() ? 0 : finished->second);
        return fmt::format("{}",
                           static_cast<int>(!is_whole                            ? ExitCode::stopped
                                              : options.strict && not_finished > 0 ? ExitCode::rows_failed
                                                                                   : ExitCode::finished));
      });
      return static_cast<ExitCode>(std::stoi(code));
    }
    catch (const FileError &error)
    {
      throw FileError(fmt::format("{}; results.h5 is whole, and --resume makes the rest", error.what()),
                      /*on_all_ranks=*/true);
    }
  }
} // namespace crawler
