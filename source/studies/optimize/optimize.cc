// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/stop_signal.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/core/study_folder.h>
#include <crawler/studies/core/table_csv.h>
#include <crawler/studies/optimize/gradient_check.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/optimize/optimize_searches.h>
#include <crawler/studies/run/run.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <ranges>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr double accuracy_of_check = 1e-7; ///< of simulations, for --check-gradient

    /// The parameter files and runs of an earlier study, but for files that are not the program's.
    void
    remove_optima(const fs::path &folder)
    {
      std::vector<fs::path> files, runs;
      for (const auto &entry : fs::directory_iterator(folder))
      {
        const std::string name = entry.path().filename().string();
        const auto is_own      = [&](const std::string &word, const std::string &ending) {
          return name.starts_with(word + "-") && name.ends_with(ending) &&
                 to_number(name.substr(word.size() + 1, name.size() - word.size() - 1 - ending.size())).has_value();
        };
        if (is_own("optimum", ".prm"))
          files.push_back(entry.path());
        if ((name == "best" || is_own("best", "")) && entry.is_directory())
          runs.push_back(entry.path());
      }
      std::error_code error;
      fs::remove_all(folder / "starts", error); // of earlier versions
      for (const fs::path &file : files)
        fs::remove(file, error);
      for (const fs::path &run : runs)
      {
        prepare(run);
        fs::remove(run / "active_stress.csv", error);
        fs::remove(run / "solution", error); // these if they are empty
        fs::remove(run, error);
      }
    }

    /// Starts were files of their own in versions before this table of them.
    void
    require_no_old_starts(const fs::path &folder)
    {
      std::error_code error;
      if (!fs::exists(folder / OptimizeMemory::file, error) && fs::exists(folder / "starts" / "1-0.json", error))
        throw InputError(fmt::format("the optimization in \"{}\" was made by an earlier version of crawler, which kept "
                                     "its starts as starts/*.json instead of {}, so it cannot be resumed; another "
                                     "folder is expected for --output, or --overwrite",
                                     folder.string(),
                                     OptimizeMemory::file));
    }

    std::string
    in_words(const OptimizeCases &cases, const GaitModel &model)
    {
      const auto [fewest, most] = std::ranges::minmax(
        cases.names().cases | std::views::transform([](const auto &one) { return one.paths.size(); }));
      return fmt::format("Optimisation of the {}: {}{}, {}; {}.",
                         cases.parameters().optimize.objective,
                         fewest < most ? fmt::format("{} to {} variables", fewest, most) : counted(most, "variable"),
                         cases.are_several() ? fmt::format(" in each of {}", counted(cases.size(), "case")) : "",
                         counted(cases.parameters().optimize.n_starts, "start"),
                         model.description());
    }

    /// The optimum as a parameter file, and its run in a folder of its own. Returns the summary of the run, and whether
    /// it ended as it should.
    std::pair<std::string, bool>
    run_optimum(OptimizeCases &cases,
                const StartResult &start,
                const std::string &effective,
                const fs::path &folder,
                const CommandOptions &options)
    {
      const auto family           = cases.family(start.number_of_case);
      const Parameters parameters = family->parameters(start.best.x);
      const std::string number    = cases.are_several() ? fmt::format("-{}", start.number_of_case + 1) : "";
      Declarations &entries       = family->form().declarations;
      entries.set("Sweep/Axes", "");
      const fs::path file = folder / ("optimum" + number + ".prm"), place = folder / ("best" + number);
      write_file(file,
                 "# The best gait: what differs from the file that was optimised.\ninclude parameters.prm\n" +
                   changes(entries, ParameterFile::from_text(effective, "parameters.prm")));
      entries.set("Sweep/Axes", parameters.sweep.axes);
      CommandOptions one = options;
      one.file           = file.string();
      one.output         = place.string();
      one.overrides      = {};
      one.overwrite = one.quiet = true;
      one.resume                = false;
      if (parameters.create_scene().active_stress->feedback() == nullptr)
        one.overrides.push_back("Output/Active stress table=129, 513");
      fs::create_directories(place);
      const bool is_good = run(MPI_COMM_SELF, one) == ExitCode::finished;
      return {fs::exists(place / "summary.json") ? read_whole_file(place / "summary.json") : "{}", is_good};
    }

    std::string
    first_problem(const OptimizeResults &results)
    {
      for (const StartResult &start : results.starts)
        if (!start.best.problem.empty())
          return start.best.problem;
      return "its objective is not known";
    }

    /// The limit that the best of the gaits exceeds.
    std::string
    conflict(const OptimizeResults &results)
    {
      const auto best =
        std::ranges::find_if(results.best, [&](const std::size_t i) { return !results.starts[i].is_admissible(); });
      const auto &gait = results.starts[*best].best;
      return fmt::format(
        "no gait that keeps to all limits was found: the best one exceeds {} by {:.3g} %; the limits may "
        "contradict each other, or the start is far from them",
        gait.worst_limit,
        100. * gait.violation);
    }

    /// Is an evaluation better than any gait can be?
    bool
    exceeds_bound(const OptimizeResults &results)
    {
      return std::ranges::any_of(results.starts, [](const StartResult &start) {
        return std::ranges::any_of(
          start.records, [](const GaitRecord &record) { return record.problem.starts_with("gait_efficiency"); });
      });
    }

    /// Tables, the optima with their runs, and the summary, by rank 0. Returns the exit code.
    ExitCode
    write_results(OptimizeCases &cases,
                  OptimizeSearches &searches,
                  const CommandOptions &options,
                  const std::string &effective,
                  const bool is_whole,
                  const std::string &reason,
                  const double begin,
                  const fs::path &folder,
                  Log &log)
    {
      const OptimizeResults results = searches.results();
      const auto ignore             = [](const Table &) {};
      for (const auto &[file, group] : {std::pair(OptimizeMemory::evaluations_file, OptimizeMemory::evaluations_group),
                                        std::pair(OptimizeMemory::file, OptimizeMemory::group)})
        write_table_csv(MPI_COMM_SELF, folder / file, group, (folder / file).replace_extension("csv"), ignore);
      std::vector<std::string> summaries;
      bool is_admissible = !results.best.empty(), has_converged = !results.best.empty(), runs = true;
      for (std::size_t i = 0; i < results.best.size(); ++i)
      {
        const StartResult &best       = results.starts[results.best[i]];
        is_admissible                 = is_admissible && best.is_admissible();
        has_converged                 = has_converged && best.has_converged;
        const auto [summary, is_good] = run_optimum(cases, best, effective, folder, options);
        summaries.push_back(summary);
        runs = runs && is_good;
      }
      write_file(folder / "optima.csv", csv(optimum_table(results, folder, summaries)));
      const bool is_wrong      = exceeds_bound(results);
      const bool is_good       = is_admissible && has_converged && runs && !is_wrong;
      const std::string status = !is_whole ? "stopped" : is_good ? "finished" : "failed";
      const std::string why    = is_wrong         ? "gait_efficiency"
                                 : !is_whole      ? reason
                                 : !is_admissible ? "limits_exceeded"
                                 : !has_converged ? "optimiser_not_converged"
                                 : !runs          ? "best_run_failed"
                                                  : "";
      const double seconds     = now() - begin; // pictures are no part of it
      write_file(folder / "summary.json",
                 optimize_json(results, summaries, status, why, seconds, options.command_line));
      for (const std::string &line : in_words(results, cases, summaries))
        log.line(line);
      if (!results.best.empty())
        draw("optimize", folder, log);
      if (is_wrong)
        log.warn("an evaluation is better than any gait can be (column problem of results.csv), so it is wrong");
      if (!is_whole)
        log.warn(
          fmt::format("stopped by {}; --resume goes on", reason == "signal" ? "a signal" : "Optimize/Time limit"));
      else if (status == "failed" && !is_wrong)
        log.warn(results.best.empty()       ? "no start makes a gait: " + first_problem(results)
                 : why == "limits_exceeded" ? conflict(results)
                 : why == "best_run_failed" ? "the run of a best gait did not end as it should; its log.txt says why"
                                            : "the optimiser did not converge; the lines above say why");
      const std::string number       = cases.are_several() ? "-N" : "";
      const std::size_t n_neighbours = searches.n_from_neighbours();
      if (cases.parameters().optimize.n_starts == 1 && !results.best.empty())
        log.line(fmt::format("{}1 start: the optimum may be a local one; Optimize/Starts = 8 looks from others, too.",
                             cases.are_several() ? "Each case had " : ""));
      log.line(fmt::format("{} evaluations from {}{}, {:.1f} s. {}",
                           results.n_evaluations(),
                           counted(results.starts.size() - n_neighbours, "start"),
                           n_neighbours > 0 ? " and " + counted(n_neighbours, "gait") + " of neighbours" : "",
                           seconds,
                           results.best.empty() ? fmt::format("Tables are in {}/.", folder.string())
                                                : fmt::format("The best gait is in {0}/optimum{1}.prm, its run in "
                                                              "{0}/best{1}/.",
                                                              folder.string(),
                                                              number)));
      return is_wrong    ? ExitCode::self_check_failed
             : !is_whole ? ExitCode::stopped
             : is_good   ? ExitCode::finished
                         : ExitCode::numerical_failure;
    }

    /// --check-gradient: of each case at the start; where that is special (a jump at the end of the run, say), so that
    /// nothing can be compared, beside it.
    ExitCode
    check_gradients(OptimizeCases &cases, Log &log)
    {
      constexpr double beside = 0.0137;
      bool agrees             = true;
      for (unsigned long number = 0; number < cases.size(); ++number)
      {
        const auto family = cases.family(number);
        // Differences of rough simulations say little.
        family->form().declarations.set("Accuracy", to_text(std::min(cases.parameters().accuracy, accuracy_of_check)));
        auto x               = start_values(cases.parameters().optimize, family->variables(), 0);
        const auto model     = make_gait_model(*family, x, []() { return false; });
        const auto wishes    = GaitProblem::wishes(family->form().parameters.optimize);
        const bool has_cases = cases.are_several();
        if (number == 0)
          log.line(in_words(cases, *model));
        if (has_cases)
          log.line("Case " + cases.in_words(number));
        auto result = check_gradient(*model, *family, wishes, x, log);
        if (!result)
        {
          for (std::size_t i = 0; i < x.size(); ++i)
          {
            const double shift = beside * family->scale(x, i);
            x[i] += x[i] + shift <= family->variables()[i].to ? shift : -shift;
          }
          log.line(fmt::format("Beside the start, all variables being {:g} % of their size away:", 100. * beside));
          result = check_gradient(*model, *family, wishes, x, log);
        }
        agrees = agrees && result.value_or(true);
        family->form().declarations.set("Accuracy", to_text(cases.parameters().accuracy));
      }
      return agrees ? ExitCode::finished : ExitCode::self_check_failed;
    }
  } // namespace

  ExitCode
  optimize(MPI_Comm communicator, const CommandOptions &options)
  {
    return optimize_input(communicator, options, read_file(communicator, options.file, options.overrides));
  }

  ExitCode
  optimize_input(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file)
  {
    const StopSignal stop_signal; // from here on a signal ends the study in order
    const double begin = now();
    Log log(rank_of(communicator) == 0, options);
    OptimizeCases cases(communicator, file);
    const OptimizeParameters own = cases.parameters().optimize;
    try
    {
      if (options.check_gradient)
        return check_gradients(cases, log);
      const auto family = cases.family(0);
      const auto start  = start_values(own, family->variables(), 0);
      const auto model  = make_gait_model(*family, start, []() { return false; });
      log.line(in_words(cases, *model));
      for (const std::string &note : cases.notes(file))
        log.line(note);
      model->evaluate(start, /*with_gradients=*/false).require_start();
    }
    catch (const InputError &error)
    {
      throw file.with_place(error);
    }
    const fs::path path = output_folder(options.output, options.file);
    StudyFolder folder(
      {"optimization", {OptimizeMemory::file}, {"Optimize/Time limit", "Optimize/Starts"}}, path, options, log);
    std::unique_ptr<OptimizeMemory> memory;
    on_first_rank(communicator, [&]() {
      if (options.resume)
        require_no_old_starts(path);
      memory = std::make_unique<OptimizeMemory>(cases, folder, file, options.command_line);
      if (memory->starts().empty())
        remove_optima(path);
      return "";
    });
    const std::function<bool()> interrupted = [&]() {
      return stop_signal.arrived_anywhere(MPI_COMM_SELF) || (own.time_limit && now() - begin > *own.time_limit);
    };
    OptimizeSearches searches(communicator, cases, std::move(memory), path, interrupted, log);
    const bool is_whole      = searches.go_on();
    const std::string reason = is_whole ? "" : stop_signal.arrived_anywhere(communicator) ? "signal" : "time_limit";
    const std::string code   = on_first_rank(communicator, [&]() {
      folder.require_in_place();
      const ExitCode end =
        write_results(cases, searches, options, cases.effective(), is_whole, reason, begin, path, log);
      folder.leave();
      return fmt::format("{}", static_cast<int>(end));
    });
    return static_cast<ExitCode>(std::stoi(code));
  }

  bool
  check_optimize(MPI_Comm communicator, const ParameterFile &file, Log &log)
  {
    const Assignment *const variables = file.assignment_of("Optimize/Variables");
    if (variables == nullptr || variables->value.empty())
      return false;
    OptimizeCases cases(communicator, file);
    const OptimizeParameters &own = cases.parameters().optimize;
    try
    {
      for (unsigned long number = 0; number < cases.size(); ++number)
      {
        const auto family = cases.family(number);
        const auto start  = start_values(own, family->variables(), 0);
        const auto model  = make_gait_model(*family, start, []() { return false; });
        if (number == 0)
        {
          log.line(in_words(cases, *model));
          for (const std::string &note : cases.notes(file))
            log.line(note);
        }
        GaitProblem problem(
          *model, family->form().parameters.optimize, family->variables(), start, []() { return false; });
        const GaitRecord record = problem.record(problem.to_y(start));
        log.line(fmt::format("  The start{}: {} {:.6g}, which {}.",
                             cases.are_several() ? " with " + cases.in_words(number) : "",
                             own.objective,
                             record.objective,
                             record.violation <= problem.admissible()
                               ? "keeps to all limits"
                               : fmt::format("exceeds {} by {:.3g} %", record.worst_limit, 100. * record.violation)));
      }
    }
    catch (const InputError &error)
    {
      throw file.with_place(error);
    }
    log.line(file.name() + " is in order: all variables and cases are admissible. Nothing was written.");
    return true;
  }
} // namespace crawler
