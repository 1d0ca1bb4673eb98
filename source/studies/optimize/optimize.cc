// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/row_file.h>
#include <crawler/base/stop_signal.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/core/study_folder.h>
#include <crawler/studies/optimize/gradient_check.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/optimize/optimize_cases.h>
#include <crawler/studies/optimize/optimize_results.h>
#include <crawler/studies/run/run.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;
    using Json   = nlohmann::ordered_json;

    constexpr double accuracy_of_check = 1e-7; ///< of simulations, for --check-gradient

    /// A case and a start: of its own, or the best gait of a neighbour of the case.
    struct Part
    {
      unsigned long number_of_case, start;
      std::optional<unsigned long> neighbour = {};
      std::vector<double> x                  = {}; ///< the gait of the neighbour

      fs::path
      file(const fs::path &folder) const
      {
        return folder / "starts" /
               (neighbour
                  ? fmt::format("{}-from-{}-{:08x}.json", number_of_case + 1, *neighbour + 1, mark(std::span(x)))
                  : fmt::format("{}-{}.json", number_of_case + 1, start));
      }

      /// A number that no other part has, for the notes on crashes.
      unsigned long
      number() const
      {
        return mark(std::span(file("").native()));
      }

    private:
      /// A number that other bytes do not have (FNV-1a).
      template <class Span>
      static std::uint32_t
      mark(const Span bytes)
      {
        std::uint32_t sum = 2166136261u;
        for (const std::byte byte : std::as_bytes(bytes))
          sum = (sum ^ std::to_integer<std::uint32_t>(byte)) * 16777619u;
        return sum;
      }
    };

    std::vector<Part>
    parts_of(const OptimizeCases &cases)
    {
      std::vector<Part> parts;
      for (unsigned long number = 0; number < cases.size(); ++number)
        for (unsigned long start = 0; start < cases.parameters().optimize.n_starts; ++start)
          parts.push_back({number, start});
      return parts;
    }

    /// What is in the folder already of a part. Throws InputError if its file is damaged.
    std::optional<StartResult>
    earlier(const Part &part, const fs::path &folder)
    {
      const fs::path file = part.file(folder);
      if (!fs::exists(file))
        return std::nullopt;
      try
      {
        return unpack_start(read_whole_file(file));
      }
      catch (const nlohmann::json::exception &)
      {
        throw InputError(
          fmt::format("\"{}\" is damaged, or of another version; without this file --resume computes its "
                      "start again",
                      file.string()));
      }
    }

    bool
    is_done(const Part &part, const fs::path &folder)
    {
      const auto found = earlier(part, folder);
      return found && !found->was_interrupted;
    }

    /// What the parts have found so far.
    OptimizeResults
    results_of(OptimizeCases &cases, std::vector<Part> parts, const fs::path &folder)
    {
      std::ranges::stable_sort(parts, {}, &Part::number_of_case);
      std::vector<StartResult> starts;
      for (const Part &part : parts)
        if (auto start = earlier(part, folder))
          starts.push_back(std::move(*start));
      return {cases, std::move(starts)};
    }

    /// The gait @p x in a case, if it keeps to all limits and is better than @p own by more than the optimiser's
    /// tolerance.
    std::optional<GaitRecord>
    better_gait(OptimizeCases &cases, const StartResult &own, const std::vector<double> &x)
    {
      constexpr double more = 10.;
      const auto family     = cases.family(own.number_of_case);
      const auto &variables = family->variables();
      for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i] < variables[i].from || x[i] > variables[i].to)
          return std::nullopt;
      const OptimizeParameters wishes = family->form().parameters.optimize;
      try
      {
        const auto model = make_gait_model(*family, x, []() { return false; });
        GaitProblem problem(*model, wishes, variables, x, []() { return false; });
        const GaitRecord record = problem.record(problem.to_y(x));
        if (!record.problem.empty() || record.violation > problem.admissible())
          return std::nullopt;
        const std::vector<GaitRecord> both = {own.best, record};
        const bool is_better               = &GaitProblem::best_of(both, wishes, problem.admissible()) == &both[1] &&
                               (!own.is_admissible() || std::abs(record.objective - own.best.objective) >
                                                          more * problem.admissible() * std::abs(own.best.objective));
        return is_better ? std::optional(record) : std::nullopt;
      }
      catch (const InputError &) // here it is no gait
      {
        return std::nullopt;
      }
    }

    /// Of each case whose best gait is beaten by that of a neighbour the best one of these, to go on from there.
    std::vector<Part>
    parts_from_neighbours(OptimizeCases &cases, const std::vector<Part> &parts, const fs::path &folder, Log &log)
    {
      const OptimizeResults results = results_of(cases, parts, folder);
      const auto best_of            = [&](const unsigned long number) -> const StartResult            *{
        for (const std::size_t i : results.best)
          if (results.starts[i].number_of_case == number)
            return &results.starts[i];
        return nullptr;
      };
      std::vector<Part> more;
      for (unsigned long number = 0; number < cases.size(); ++number)
      {
        const StartResult *const own = best_of(number);
        if (own == nullptr)
          continue;
        StartResult leader = *own;
        std::optional<Part> found;
        for (const unsigned long neighbour : cases.neighbours(number))
        {
          const StartResult *const other = best_of(neighbour);
          if (other == nullptr || results.cases[neighbour].paths != results.cases[number].paths)
            continue;
          const std::vector<double> &x = other->best.x;
          const bool is_known =
            std::ranges::any_of(parts, [&](const Part &part) { return part.number_of_case == number && part.x == x; });
          const auto record = is_known ? std::nullopt : better_gait(cases, leader, x);
          if (!record)
            continue;
          leader.best = *record;
          const auto n_own =
            std::ranges::count_if(parts, [&](const Part &part) { return part.number_of_case == number; });
          found = {number, static_cast<unsigned long>(n_own), neighbour, x};
        }
        if (!found)
          continue;
        log.line(
          fmt::format("With {} the gait of {} is better ({:.6g}) than its own ({:.6g}): the search goes on there.",
                      cases.in_words(number),
                      cases.in_words(*found->neighbour),
                      leader.best.objective,
                      own->best.objective));
        more.push_back(*found);
      }
      return more;
    }

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

    void
    begin_or_resume(MPI_Comm communicator, StudyFolder &folder, const ParameterFile &file, const std::string &effective)
    {
      on_first_rank(communicator, [&]() -> std::string {
        const fs::path starts = folder.path() / "starts";
        if (folder.begin(file.text(), effective))
          folder.resume([&]() {
            return differences(
              read_whole_file(folder.path() / "parameters.prm"), effective, folder.kind().free_entries);
          });
        else
        {
          remove_optima(folder.path());
          fs::remove_all(starts);
          fs::create_directories(starts);
        }
        return "";
      });
    }

    std::string
    in_words(const OptimizeCases &cases, const GaitModel &model)
    {
      const auto [fewest, most] = cases.n_variables();
      return fmt::format("Optimisation of the {}: {}{}, {}; {}.",
                         cases.parameters().optimize.objective,
                         fewest < most ? fmt::format("{} to {} variables", fewest, most) : counted(most, "variable"),
                         !cases.axes().empty() ? fmt::format(" in each of {}", counted(cases.size(), "case")) : "",
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
      const std::string number    = !cases.axes().empty() ? fmt::format("-{}", start.number_of_case + 1) : "";
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
                  const std::vector<Part> &parts,
                  const CommandOptions &options,
                  const std::string &effective,
                  const bool is_whole,
                  const std::string &reason,
                  const double begin,
                  const fs::path &folder,
                  Log &log)
    {
      const OptimizeResults results = results_of(cases, parts, folder);
      const Table evaluations       = evaluation_table(results);
      write_file(folder / "results.csv", csv(evaluations));
      write_hdf5(folder / "results.h5", "optimize", evaluations, provenance(effective, options.command_line));
      write_file(folder / "starts.csv", csv(start_table(results)));
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
      write_file(folder / "optima.csv", csv(optimum_table(results, summaries)));
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
      for (const std::string &line : in_words(results, summaries, cases.parameters().units))
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
      const std::string number = !cases.axes().empty() ? "-N" : "";
      const auto n_neighbours =
        std::ranges::count_if(parts, [](const Part &part) { return part.neighbour.has_value(); });
      if (cases.parameters().optimize.n_starts == 1 && !results.best.empty())
        log.line(fmt::format("{}1 start: the optimum may be a local one; Optimize/Starts = 8 looks from others, too.",
                             cases.axes().empty() ? "" : "Each case had "));
      log.line(fmt::format("{} evaluations from {}{}, {:.1f} s. {}",
                           std::get<std::vector<double>>(evaluations.front().values).size(),
                           counted(results.starts.size() - static_cast<std::size_t>(n_neighbours), "start"),
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
        const bool has_cases = !cases.axes().empty();
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
    std::vector<Part> parts     = parts_of(cases);
    const std::string effective = cases.effective();
    const fs::path path         = output_folder(options.output, options.file);
    StudyFolder folder({"optimization", {"starts"}, {"Optimize/Time limit", "Optimize/Starts"}}, path, options, log);
    begin_or_resume(communicator, folder, file, effective);

    const std::function<bool()> interrupted = [&]() {
      return stop_signal.arrived_anywhere(MPI_COMM_SELF) || (own.time_limit && now() - begin > *own.time_limit);
    };
    SearchState state;
    CrashNote note(path);
    const Crashes crashes = crashes_in(path);
    const auto search_all = [&](const std::vector<Part> &some) {
      const auto n_missing =
        static_cast<unsigned long>(std::ranges::count_if(some, [&](const Part &part) { return !is_done(part, path); }));
      return share_work(communicator,
                        {some.size(),
                         n_missing,
                         "starts",
                         interrupted,
                         [&](const unsigned long number, const auto &stops, const auto &see) {
                           const Part &part = some[number];
                           if (is_done(part, path))
                             return true;
                           const auto family = cases.family(part.number_of_case);
                           const auto x = part.neighbour ? part.x : start_values(own, family->variables(), part.start);
                           const unsigned long mark = part.number();
                           note.at_work_on(std::span(&mark, 1));
                           const StartResult result =
                             is_given_up(mark, crashes)
                               ? without_gait(part.number_of_case, part.start, x, crash_message)
                               : search(*family, part.number_of_case, part.start, x, state, stops);
                           write_file(part.file(path), pack(result));
                           note.at_work_on({});
                           see(1, result.has_converged ? 0 : 1);
                           return !result.was_interrupted;
                         },
                         [&]() {
                           const std::string evaluations = counted(state.evaluations, "evaluation");
                           return std::isnan(state.best)
                                    ? evaluations + ", no gait within the limits yet"
                                    : fmt::format("{}, best {} {:.6g}", evaluations, own.objective, state.best);
                         }},
                        log);
    };
    bool is_whole = search_all(parts);
    for (unsigned long round = 0; is_whole && round < cases.size(); ++round)
    {
      const std::string more = on_first_rank(communicator, [&]() {
        Json list = Json::array();
        for (const Part &part : parts_from_neighbours(cases, parts, path, log))
          list.push_back({part.number_of_case, part.start, *part.neighbour, part.x});
        return list.dump();
      });
      std::vector<Part> added;
      for (const Json &part : Json::parse(more))
        added.push_back({part[0], part[1], part[2].get<unsigned long>(), part[3]});
      if (added.empty())
        break;
      parts.insert(parts.end(), added.begin(), added.end());
      is_whole = search_all(added);
    }
    const std::string reason = is_whole ? "" : stop_signal.arrived_anywhere(communicator) ? "signal" : "time_limit";
    const std::string code   = on_first_rank(communicator, [&]() {
      folder.require_in_place();
      const ExitCode end = write_results(cases, parts, options, effective, is_whole, reason, begin, path, log);
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
                             !cases.axes().empty() ? " with " + cases.in_words(number) : "",
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
