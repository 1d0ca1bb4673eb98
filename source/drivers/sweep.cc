// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/row_file.h>
#include <crawler/base/stop_signal.h>
#include <crawler/base/versions.h>
#include <crawler/base/work_queue.h>
#include <crawler/drivers/compute_similar.h>
#include <crawler/drivers/input.h>
#include <crawler/drivers/log.h>
#include <crawler/drivers/output_folder.h>
#include <crawler/drivers/study.h>
#include <crawler/drivers/sweep.h>
#include <crawler/drivers/sweep_points.h>
#include <crawler/drivers/sweep_rows.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    const std::string group = "results";
    /// May change when a sweep goes on: how much of it is computed, not what.
    const std::vector<std::string> free_entries = {"Sweep/Time limit", "Sweep/Keep fields"};

    /// Points in succession that are computed together, and share the numerics if they can.
    struct Block
    {
      unsigned long first, size;
    };

    /// They do not depend on the number of ranks or on what is done already, so neither do the answers. A block does
    /// not go beyond the end of the last axis, where its points would not be similar any more.
    std::vector<Block>
    blocks_of(const SweepDesign &design)
    {
      constexpr unsigned long most = 64, least_blocks = 256;
      const unsigned long size = std::clamp(design.n_points() / least_blocks, 1ul, most);
      const unsigned long run  = design.run_length() > 1 ? design.run_length() : design.n_points();
      // Equal parts of each run along the last axis.
      const unsigned long parts = (run + size - 1) / size;
      std::vector<Block> blocks;
      for (unsigned long start = 0; start < design.n_points(); start += run)
        for (unsigned long i = 0; i < parts; ++i)
        {
          const unsigned long from = run * i / parts, to = run * (i + 1) / parts;
          if (to > from)
            blocks.push_back({start + from, to - from});
        }
      return blocks;
    }

    /// Longest first, as far as that is known: by the duration and the number of digits wanted. Otherwise spread over
    /// the whole sweep from the beginning, so the time left is known early.
    std::vector<Block>
    in_order(std::vector<Block> blocks, SweepPoints &points)
    {
      const unsigned long stride = golden_stride(blocks.size());
      std::vector<std::pair<double, Block>> list;
      for (unsigned long i = 0; i < blocks.size(); ++i)
      {
        const Block &block    = blocks[i * stride % blocks.size()];
        const Parameters &p   = points.parameters(block.first);
        const double expected = p.time.end_time * std::log10(1. / p.accuracy) * static_cast<double>(block.size);
        list.emplace_back(expected, block);
      }
      std::stable_sort(list.begin(),
                       list.end(),
                       [](const auto &a, const auto &b)
                       {
                         return a.first > b.first * (1. + 1e-9);
                       });
      for (std::size_t i = 0; i < list.size(); ++i)
        blocks[i] = list[i].second;
      return blocks;
    }

    /// One rank's part of the work.
    class Worker
    {
    public:
      Worker(const SweepDesign &design,
             SweepPoints &points,
             const std::vector<RowFile::Column> &columns,
             const std::vector<bool> &done,
             RowFile &file,
             const std::function<bool()> &interrupted)
        : design_(design)
        , points_(points)
        , columns_(columns)
        , done_(done)
        , file_(file)
        , interrupted_(interrupted)
      {
      }

      /// Returns false if it was interrupted.
      bool
      compute(const Block &block, const std::function<void(unsigned long n, unsigned long failed)> &see)
      {
        std::vector<bool> missing(block.size);
        for (unsigned long i = 0; i < block.size; ++i)
          missing[i] = !done_[block.first + i];
        if (std::none_of(missing.begin(),
                         missing.end(),
                         [](const bool is)
                         {
                           return is;
                         }))
          return true;
        std::vector<Task> tasks(block.size);
        for (unsigned long i = 0; i < block.size; ++i)
        {
          tasks[i].parameters = points_.parameters(block.first + i);
          tasks[i].gait       = true;
        }
        const double limit          = tasks.front().parameters.sweep.point_time_limit.value_or(HUGE_VAL);
        const std::vector<bool> one = compute_similar(tasks, missing, limit, interrupted_);
        if (interrupted_())
          return false;
        write(block, tasks, one, see);
        for (unsigned long i = 0; i < block.size; ++i)
          missing[i] = missing[i] && !one[i];

        // The rest a few at a time, or one by one where one takes long: what is finished shall be on the disk soon.
        constexpr unsigned long most_together = 8;
        constexpr double long_time            = 1.; // seconds
        unsigned long together                = most_together;
        for (unsigned long i = 0; i < block.size;)
        {
          std::vector<unsigned long> some;
          for (; i < block.size && some.size() < together; ++i)
            if (missing[i])
              some.push_back(i);
          if (some.empty())
            break;
          std::vector<Task> few(some.size());
          for (std::size_t j = 0; j < some.size(); ++j)
          {
            few[j].parameters = tasks[some[j]].parameters;
            few[j].gait       = true;
          }
          const double before = now();
          compute_all(few, limit, interrupted_);
          if (interrupted_())
            return false;
          together = (now() - before) / static_cast<double>(some.size()) > long_time ? 1 : most_together;
          for (std::size_t j = 0; j < some.size(); ++j)
          {
            std::vector<bool> only(block.size, false);
            only[some[j]]  = true;
            tasks[some[j]] = std::move(few[j]);
            write(block, tasks, only, see);
          }
        }
        return true;
      }

    private:
      /// The rows of the tasks that are @p ready, those in succession at once.
      void
      write(const Block &block,
            const std::vector<Task> &tasks,
            const std::vector<bool> &ready,
            const std::function<void(unsigned long n, unsigned long failed)> &see)
      {
        std::vector<RowFile::Row> rows;
        for (unsigned long i = 0; i <= block.size; ++i)
        {
          if (i < block.size && ready[i])
          {
            rows.push_back(sweep_row(columns_, design_, block.first + i, tasks[i]));
            continue;
          }
          file_.write(block.first + i - rows.size(), rows);
          rows.clear();
        }
        unsigned long n = 0, failed = 0;
        for (unsigned long i = 0; i < block.size; ++i)
          if (ready[i])
          {
            ++n;
            failed += status_of(tasks[i]).status != "finished";
          }
        if (n > 0)
          see(n, failed);
      }

      const SweepDesign &design_;
      SweepPoints &points_;
      const std::vector<RowFile::Column> &columns_;
      const std::vector<bool> &done_;
      RowFile &file_;
      const std::function<bool()> &interrupted_;
    };

    /// Which points have a row, from the file of a sweep that was begun. Throws InputError if the folder has none, or
    /// one with other parameters.
    std::vector<bool>
    rows_that_are_there(const fs::path &folder, const SweepDesign &design, const std::string &effective)
    {
      std::error_code error;
      if (!fs::exists(folder / "results.h5", error) || !fs::exists(folder / "parameters.prm", error))
        throw InputError("\"" + folder.string() +
                         "\" has no sweep that could be resumed; another folder is expected for --output, or "
                         "--overwrite");
      const auto changes = differences(read_whole_file(folder / "parameters.prm"), effective, free_entries);
      if (!changes.empty())
        throw InputError(
          fmt::format("the sweep in \"{}\" was made with other parameters: {}; it can be resumed with the "
                      "same ones only (but for {})",
                      folder.string(),
                      fmt::join(changes, ", "),
                      fmt::join(free_entries, " and ")));
      const auto status = read_texts(folder / "results.h5", group, "status");
      if (status.size() != design.n_points())
        throw InputError(fmt::format("the sweep in \"{}\" has {} points, but this one has {}: a file that it names has "
                                     "changed",
                                     folder.string(),
                                     status.size(),
                                     design.n_points()));
      std::vector<bool> done;
      for (const std::string &word : status)
        done.push_back(!word.empty());
      return done;
    }

    std::string
    packed(const std::vector<bool> &flags)
    {
      std::string text;
      for (const bool flag : flags)
        text += flag ? '1' : '0';
      return text;
    }

    std::vector<bool>
    unpacked(const std::string &text)
    {
      std::vector<bool> flags;
      for (const char c : text)
        flags.push_back(c == '1');
      return flags;
    }

    /// results.csv and summary.json, from results.h5 (rank 0).
    std::map<std::string, unsigned long>
    finish(const fs::path &folder,
           const std::string &status,
           const std::string &reason,
           const double seconds,
           const unsigned int n_ranks,
           const std::string &command_line)
    {
      const Table table = read_table(folder / "results.h5", group);
      write_file(folder / "results.csv", csv(table));
      std::map<std::string, unsigned long> statuses, reasons;
      unsigned long n = 0;
      for (const Column &column : table)
        if (const auto *texts = std::get_if<std::vector<std::string>>(&column.values))
        {
          if (column.name == "status")
            for (const std::string &text : *texts)
              ++statuses[text.empty() ? "missing" : text];
          if (column.name == "reason")
            for (const std::string &text : *texts)
              if (!text.empty())
                ++reasons[text];
          n = texts->size();
        }
      const nlohmann::ordered_json json = {
        {"status", status},
        {"reason", reason.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(reason)},
        {"points", n},
        {"statuses", statuses},
        {"reasons", reasons},
        {"seconds", seconds},
        {"ranks", n_ranks},
        {"versions", versions()},
        {"command_line", command_line}};
      write_file(folder / "summary.json",
                 json.dump(2, ' ', /*ensure_ascii=*/false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
      return statuses;
    }

    /// The folders points/NUMBER of the points whose fields are kept, by `crawler run` with their values.
    bool
    keep_fields(MPI_Comm communicator,
                const CommandOptions &options,
                const fs::path &folder,
                const SweepDesign &design,
                const SweepPoints &points,
                const std::vector<unsigned long> &kept)
    {
      bool all = true;
      for (std::size_t i = rank_of(communicator); i < kept.size(); i += size_of(communicator))
      {
        const fs::path place = folder / "points" / fmt::format("{}", kept[i]);
        if (fs::exists(place / "summary.json"))
          continue;
        CommandOptions one = options;
        if (one.file == "-")
          one.file = (folder / "original.prm").string();
        one.output    = place.string();
        one.overwrite = one.quiet = true;
        one.resume                = false;
        one.overrides             = points.overrides(design, kept[i]);
        fs::create_directories(place);
        all = run(MPI_COMM_SELF, one) != ExitCode::stopped && all;
      }
      int everywhere = all;
      MPI_Allreduce(MPI_IN_PLACE, &everywhere, 1, MPI_INT, MPI_MIN, communicator);
      return everywhere != 0;
    }

    std::string
    in_words(const SweepDesign &design, const std::string &design_name)
    {
      std::vector<std::string> axes;
      for (const SweepAxis &axis : design.axes())
        axes.push_back(axis.entry + (design_name == "grid" ? fmt::format(" ({} values)", axis.values.size()) : ""));
      return fmt::format("{} points, {} over {}", design.n_points(), design_name, fmt::join(axes, ", "));
    }
  } // namespace

  ExitCode
  sweep(MPI_Comm communicator, const CommandOptions &options)
  {
    std::optional<StopSignal> stop_signal(std::in_place); // from here on a signal ends the sweep in order
    const double start         = now();
    const bool first           = rank_of(communicator) == 0;
    const unsigned int n_ranks = size_of(communicator);
    Log log(first, options.quiet);
    if (options.resume && options.overwrite)
      throw InputError("--resume and --overwrite contradict each other; one of them is expected");
    const ParameterFile file = read_file(communicator, options.file, options.overrides);
    SweepPoints points(communicator, file);
    const SweepDesign &design   = points.design();
    const SweepParameters &own  = points.sweep();
    const auto kept             = points.kept_points();
    const auto columns          = sweep_columns(design, points.declarations());
    const auto folder           = output_folder(options.output, options.file);
    const std::string effective = points.effective();

    const std::vector<bool> done = unpacked(on_first_rank(
      communicator,
      [&]()
      {
        std::error_code error;
        const bool goes_on = options.resume && fs::exists(folder, error) && !fs::is_empty(folder, error);
        require_usable(folder, options.overwrite || goes_on);
        if (goes_on)
        {
          const std::string known = packed(rows_that_are_there(folder, design, effective));
          log.open(folder / "log.txt", /*append=*/true);
          return known;
        }
        prepare(folder);
        fs::remove_all(folder / "points"); // of an earlier sweep
        write_file(folder / "original.prm", file.text());
        write_file(folder / "parameters.prm", effective);
        log.open(folder / "log.txt");
        auto attributes         = provenance(effective, options.command_line);
        attributes["not known"] = "NaN in numbers, an empty text in texts; an empty status: not computed yet";
        RowFile::create(folder / "results.h5", group, columns, design.n_points(), attributes);
        return std::string(design.n_points(), '0');
      }));
    const auto n_done            = static_cast<unsigned long>(std::count(done.begin(), done.end(), true));
    log.line(fmt::format("Sweep: {}, on {} rank{}{}",
                         in_words(design, own.design),
                         n_ranks,
                         n_ranks == 1 ? "" : "s",
                         n_done > 0 ? fmt::format("; {} are done already", n_done) : ""));

    const auto out_of_time = [&]()
    {
      return own.time_limit && now() - start > *own.time_limit;
    };
    const std::function<bool()> interrupted = [&]()
    {
      return stop_signal->arrived_anywhere(MPI_COMM_SELF) || out_of_time();
    };
    bool is_whole = true;
    {
      const std::vector<Block> blocks = in_order(blocks_of(design), points);
      RowFile results(communicator, folder / "results.h5", group, columns);
      WorkQueue queue(communicator, blocks.size());
      StudyProgress progress(log, design.n_points() - n_done, "points");
      Worker worker(design, points, columns, done, results, interrupted);
      unsigned long n_failed = 0;
      while (const auto number = queue.next())
        if (!worker.compute(blocks[*number],
                            [&](const unsigned long n, const unsigned long failed)
                            {
                              const auto count = queue.done(n, failed);
                              n_failed         = count.failed;
                              progress.report(count.done,
                                              n_failed > 0 ? fmt::format(", {} not finished", n_failed) : "");
                            }))
        {
          queue.close();
          is_whole = false;
          break;
        }
    }
    int all = is_whole;
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, communicator);
    bool finished      = all != 0;
    std::string reason = finished ? "" : stop_signal->arrived_anywhere(communicator) ? "signal" : "time_limit";
    if (finished && !kept.empty() && !keep_fields(communicator, options, folder, design, points, kept))
    {
      finished = false;
      reason   = "signal";
    }
    int code = 0;
    on_first_rank(communicator,
                  [&]()
                  {
                    const double seconds = now() - start;
                    const auto statuses =
                      finish(folder, finished ? "finished" : "stopped", reason, seconds, n_ranks, options.command_line);
                    std::vector<std::string> words;
                    unsigned long not_finished = 0;
                    for (const auto &[status, count] : statuses)
                    {
                      words.push_back(fmt::format("{} {}", count, status));
                      not_finished += status == "finished" ? 0 : count;
                    }
                    const double computed =
                      static_cast<double>(design.n_points() - n_done) -
                      static_cast<double>(statuses.count("missing") > 0 ? statuses.at("missing") : 0);
                    log.line(fmt::format("{} points: {}. {:.1f} s, {:.4g} points/s.",
                                         design.n_points(),
                                         fmt::join(words, ", "),
                                         seconds,
                                         computed / seconds));
                    if (!finished)
                      log.warn(fmt::format("stopped by {}; --resume goes on",
                                           reason == "signal" ? "a signal" : "Sweep/Time limit"));
                    log.line(fmt::format("Results are in {0}/results.h5 and {0}/results.csv; draw them with: python3 "
                                         "contrib/plot/sweep.py {0}",
                                         folder.string()));
                    code = static_cast<int>(!finished                            ? ExitCode::stopped
                                            : options.strict && not_finished > 0 ? ExitCode::rows_failed
                                                                                 : ExitCode::finished);
                    return "";
                  });
    MPI_Bcast(&code, 1, MPI_INT, 0, communicator);
    return static_cast<ExitCode>(code);
  }

  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log)
  {
    if (std::none_of(file.assignments().begin(),
                     file.assignments().end(),
                     [](const Assignment &assignment)
                     {
                       return assignment.path == "Sweep/Axes" && !assignment.value.empty();
                     }))
      return false;
    SweepPoints points(communicator, file);
    const SweepDesign &design = points.design();
    std::size_t bytes         = 0;
    for (const RowFile::Column &column : sweep_columns(design, points.declarations()))
      bytes += column.width == 0 ? sizeof(double) : column.width;
    // The time of a few blocks, spread over the sweep.
    constexpr unsigned long n_samples = 3;
    const auto blocks                 = blocks_of(design);
    const double before               = now();
    unsigned long n_computed          = 0;
    for (unsigned long i = 0; i < std::min<unsigned long>(n_samples, blocks.size()); ++i)
    {
      const Block &block = blocks[i * (blocks.size() - 1) / std::max(n_samples - 1, 1ul)];
      std::vector<Task> tasks(block.size);
      for (unsigned long j = 0; j < block.size; ++j)
        tasks[j].parameters = points.parameters(block.first + j);
      const auto never = []()
      {
        return false;
      };
      auto done = compute_similar(tasks, std::vector<bool>(block.size, true), HUGE_VAL, never);
      for (unsigned long j = 0; j < block.size; ++j)
        if (!done[j])
          compute_all({&tasks[j], 1}, HUGE_VAL, never);
      n_computed += block.size;
    }
    const double each = (now() - before) / static_cast<double>(n_computed);
    log.line(fmt::format("Sweep: {}.", in_words(design, points.sweep().design)));
    log.line(fmt::format(
      "  About {:.2g} s a point (from {} of them): {:.3g} s on one rank{}; results.h5 will have {:.3g} MB.",
      each,
      n_computed,
      each * static_cast<double>(design.n_points()),
      size_of(communicator) > 1 ? fmt::format(", {:.3g} s on {}",
                                              each * static_cast<double>(design.n_points()) / size_of(communicator),
                                              size_of(communicator))
                                : "",
      static_cast<double>(bytes * design.n_points()) / 1e6));
    log.line(file.name() + " is in order: all swept names and values are admissible. Nothing was written.");
    return true;
  }
} // namespace crawler
