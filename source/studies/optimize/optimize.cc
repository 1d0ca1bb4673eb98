// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/optimize/optimize_results.h>
#include <crawler/studies/optimize/optimize_searches.h>
#include <crawler/studies/run/run.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    std::string
    in_words(const OptimizeCases &cases, const GaitModel &model)
    {
      const auto n_variables    = [](const OptimizeNames::Case &one) { return one.paths.size(); };
      const auto [least, most]  = std::ranges::minmax_element(cases.names().cases, {}, n_variables);
      const std::string several = counted(most->paths.size(), "variable");
      return fmt::format(
        "Optimisation of the {}: {}{}, {}; {}.",
        cases.parameters().optimize.objective,
        least->paths.size() < most->paths.size() ? fmt::format("{} to {}", least->paths.size(), several) : several,
        cases.are_several() ? fmt::format(" in each of {}", counted(cases.size(), "case")) : "",
        counted(cases.parameters().optimize.n_starts, "start"),
        model.description());
    }

    /// Writes the optimum as a parameter file, and runs it in a folder of its own. Returns the summary of the run, and
    /// true if it ended as it should.
    std::pair<nlohmann::ordered_json, bool>
    run_optimum(OptimizeCases &cases, const StartResult &start, const StudyFolder &folder)
    {
      const auto family           = cases.family(start.number_of_case);
      const Parameters parameters = family->parameters(start.best.x);
      const std::string number    = cases.are_several() ? fmt::format("-{}", start.number_of_case + 1) : "";
      Declarations &entries       = family->form.declarations;
      entries.set("Sweep/Axes", "");
      const fs::path file = folder.path / ("optimum" + number + ".prm"), place = folder.path / ("best" + number);
      write_file(file,
                 "# The best gait: what differs from the file that was optimised.\ninclude parameters.prm\n" +
                   changes(entries, ParameterFile::from_text(cases.points().effective(), "parameters.prm")));
      entries.set("Sweep/Axes", parameters.sweep.axes);
      std::vector<std::string> overrides;
      if (parameters.create_scene().active_stress->feedback() == nullptr)
        overrides.emplace_back("Output/Active stress table=129, 513");
      const bool is_good        = run_for_study(folder.options, file, overrides, place) == ExitCode::finished;
      const std::string summary = fs::exists(place / "summary.json") ? read_whole_file(place / "summary.json") : "{}";
      return {nlohmann::ordered_json::parse(summary), is_good};
    }

    struct Ending
    {
      std::string reason; ///< empty: none, all is well
      ExitCode code;
      std::string warning;
    };

    /// Ending of a study; @p stop: the reason of @p clock if it was stopped.
    Ending
    ending_of(const OptimizeResults &results,
              const bool runs_are_good,
              const std::string &stop,
              const StudyClock &clock)
    {
      const auto of_best = [&](const auto &is_so) {
        return std::ranges::find_if_not(results.best, [&](const std::size_t i) { return is_so(results.starts[i]); });
      };
      const auto has_problem = [](const std::string &begin) {
        return
          [begin](const GaitRecord &record) { return !record.problem.empty() && record.problem.starts_with(begin); };
      };
      const auto exceeds_bound = [&](const StartResult &start) {
        return std::ranges::any_of(start.records, has_problem("gait_efficiency"));
      };
      if (std::ranges::any_of(results.starts, exceeds_bound))
        return {"gait_efficiency",
                ExitCode::self_check_failed,
                "an evaluation is better than any gait can be (column problem of results.csv), so it is wrong"};
      if (!stop.empty())
        return {stop, ExitCode::stopped, clock.in_words(stop) + "; --resume continues"};
      if (results.best.empty())
      {
        const auto first = std::ranges::find_if(results.starts, has_problem(""), &StartResult::best);
        return {"limits_exceeded",
                ExitCode::numerical_failure,
                "no start makes a gait: " +
                  (first == results.starts.end() ? "its objective is not known" : first->best.problem)};
      }
      if (const auto worst = of_best([](const StartResult &best) { return best.is_admissible(); });
          worst != results.best.end())
        return {"limits_exceeded",
                ExitCode::numerical_failure,
                fmt::format("no gait within all limits was found: the best one exceeds {} by {:.3g} %; the limits may "
                            "contradict each other, or the start is far from them",
                            results.starts[*worst].best.worst_limit,
                            100. * results.starts[*worst].best.violation)};
      if (of_best([](const StartResult &best) { return best.has_converged; }) != results.best.end())
        return {"optimiser_not_converged",
                ExitCode::numerical_failure,
                "the optimiser did not converge; the lines above say why"};
      if (!runs_are_good)
        return {"best_run_failed",
                ExitCode::numerical_failure,
                "the run of a best gait did not end normally; its log.txt says why"};
      return {"", ExitCode::finished, ""};
    }

    void
    report(const OptimizeCases &cases,
           const OptimizeResults &results,
           const std::size_t n_neighbours,
           const double seconds,
           const StudyFolder &folder)
    {
      Log &log                 = folder.log;
      const std::string number = cases.are_several() ? "-N" : "", place = folder.path.string();
      if (cases.parameters().optimize.n_starts == 1 && !results.best.empty())
        log.line(
          fmt::format("{}1 start: the optimum may be a local one; Optimize/Starts = 8 searches from others, too.",
                      cases.are_several() ? "Each case had " : ""));
      log.line(fmt::format(
        "{} evaluations from {}{}, {:.1f} s. {}",
        results.n_evaluations(),
        counted(results.starts.size() - n_neighbours, "start"),
        n_neighbours > 0 ? " and " + counted(n_neighbours, "gait") + " of neighbours" : "",
        seconds,
        results.best.empty()
          ? fmt::format("Tables are in {}/.", place)
          : fmt::format("The best gait is in {0}/optimum{1}.prm, its run in {0}/best{1}/.", place, number)));
    }

    /// Writes tables, the optima with their runs, and the summary, on rank 0. @p stop: why the study is not whole.
    ExitCode
    write_results(OptimizeCases &cases,
                  OptimizeMemory &memory,
                  const std::vector<StartName> &starts,
                  const std::string &stop,
                  const StudyClock &clock,
                  const StudyFolder &folder)
    {
      const fs::path &path = folder.path;
      Log &log             = folder.log;
      memory.arrange(starts);
      OptimizeResults results(cases.names(), memory.starts());
      const auto n_neighbours =
        static_cast<std::size_t>(std::ranges::count_if(starts, [](const StartName &one) { return one.neighbour > 0; }));
      bool runs_are_good = true;
      for (const std::size_t best : results.best)
      {
        const auto [summary, is_good] = run_optimum(cases, results.starts[best], folder);
        results.runs.push_back(summary);
        runs_are_good = runs_are_good && is_good;
      }
      write_file(path / "optima.csv", csv(optimum_table(results, path)));
      const Ending end         = ending_of(results, runs_are_good, stop, clock);
      const std::string status = !stop.empty() ? "stopped" : end.code == ExitCode::finished ? "finished" : "failed";
      const double seconds     = clock.seconds(); // without pictures
      write_file(path / "summary.json",
                 optimize_json(results, status, end.reason, end.warning, seconds, folder.options.command_line));
      for (const std::string &line : in_words(results, cases))
        log.line(line);
      if (!results.best.empty())
        draw("optimize", path, log);
      if (!end.warning.empty())
        log.warn(end.warning);
      report(cases, results, n_neighbours, seconds, folder);
      return end.code;
    }

    /// Start of a case: its scenes, variables, and the model of its gaits.
    struct CaseStart
    {
      std::unique_ptr<SceneFamily> scenes;
      std::vector<double> x;
      std::unique_ptr<GaitModel> model;

      /// @p accuracy replaces that of the file.
      CaseStart(OptimizeCases &cases, const unsigned long number, const std::optional<double> accuracy = {})
        : scenes(cases.family(number))
        , x(scenes->start(0))
      {
        if (accuracy)
          scenes->form.declarations.set("Accuracy", to_text(*accuracy));
        model = make_gait_model(*scenes, x);
      }
    };

    void
    introduce(const OptimizeCases &cases, const GaitModel &model, const std::vector<std::string> &notes, Log &log)
    {
      log.line(in_words(cases, model));
      for (const std::string &note : notes)
        log.line(note);
    }

    /// Number to check: its value, and its derivative by a variable.
    struct Checked
    {
      std::string name;
      std::function<double(const GaitValues &)> value;
      std::function<double(const GaitValues &, std::size_t)> derivative;
    };

    void
    add_extremes(const std::string &name,
                 const GaitValues &here,
                 LimitedValues GaitValues::*block,
                 std::vector<Checked> &list)
    {
      const std::vector<double> &values = (here.*block).values;
      const auto [least, most]          = std::ranges::minmax_element(values);
      for (const auto place : {least, most})
      {
        const auto p = static_cast<std::size_t>(place - values.begin());
        list.push_back({fmt::format("{} {}", place == least ? "smallest" : "largest", name),
                        [=](const GaitValues &there) { return (there.*block).values[p]; },
                        [=](const GaitValues &there, const std::size_t i) { return (there.*block).gradients[i][p]; }});
      }
    }

    /// Numbers that the study wants or limits.
    std::vector<Checked>
    numbers_to_check(const GaitValues &here, const GaitWishes &wishes)
    {
      std::vector<Checked> list;
      for (std::size_t k = 0; k < gait_numbers.size(); ++k)
        if (wishes.numbers[k])
          list.push_back({gait_numbers[k].words,
                          [k](const GaitValues &there) { return there.numbers[k]; },
                          [k](const GaitValues &there, const std::size_t i) { return there.gradients[k][i]; }});
      if (wishes.strain && std::ranges::find(here.strain_by_differences, true) == here.strain_by_differences.end())
        add_extremes("strain", here, &GaitValues::strain, list);
      if (wishes.stress)
        add_extremes("stress", here, &GaitValues::stress, list);
      if (wishes.stress_rate)
        add_extremes("stress rate", here, &GaitValues::stress_rate, list);
      return list;
    }

    /// Largest deviation of a gradient from differences, relative to the number or to its largest derivative.
    double
    deviation_of(const Checked &number,
                 const GaitValues &here,
                 const std::vector<double> &differences,
                 const std::vector<std::size_t> &variables,
                 const std::function<double(std::size_t)> &scale)
    {
      double size = std::abs(number.value(here)), largest = 0.;
      for (const std::size_t i : variables)
      {
        size    = std::max(size, std::abs(differences[i] * scale(i)));
        largest = std::max(largest, std::abs((number.derivative(here, i) - differences[i]) * scale(i)));
      }
      return size > 0. ? largest / size : 0.;
    }

    /// Prints the derivatives of all requested numbers, and of the limited ones where they are most extreme, at @p x
    /// beside differences of the model. Returns true if they agree to 1e-5 of the gradient's size, or, where gaits are
    /// simulated, within their accuracy; nothing if all derivatives are differences themselves.
    std::optional<bool>
    check_gradient(GaitModel &model, const std::vector<double> &x, Log &log)
    {
      const double noise     = model.noise();
      const double step      = noise > 0. ? 0.5 * std::cbrt(noise) : 1e-6,
                   tolerance = noise > 0. ? 20. * noise / step : 1e-5;
      const GaitValues here  = model.evaluate(x, /*with_gradients=*/true);
      here.require_start();
      const std::vector<Checked> list = numbers_to_check(here, model.wishes);
      std::vector<std::size_t> checked;
      for (std::size_t i = 0; i < x.size(); ++i)
        if (here.by_differences.empty() || !here.by_differences[i])
          checked.push_back(i);
        else
          log.line(
            fmt::format("{}: its derivatives are differences of simulations, since the adjoint does not cover it; "
                        "there is nothing to compare",
                        model.family.variables[i].path));
      if (checked.empty() || list.empty())
        return std::nullopt;

      // Values jump by their error where the integrator takes another step or the mesh another cell. Narrower
      // differences avoid most of these places; a wrong derivative agrees with none.
      std::vector<std::vector<double>> differences(list.size(), std::vector<double>(x.size()));
      std::vector<double> deviations(list.size(), std::numeric_limits<double>::max());
      for (double width = step; width >= step / 64. && std::ranges::max(deviations) > tolerance; width /= 8.)
      {
        std::vector<std::vector<double>> narrower(list.size(), std::vector<double>(x.size()));
        for (const std::size_t i : checked)
          for (const auto &point : model.family.stencil(x, i, width))
          {
            const GaitValues there = model.evaluate(point.x, /*with_gradients=*/false);
            if (!there.problem.empty())
              throw InputError("near the start: " + there.problem, "Optimize/Variables");
            for (std::size_t c = 0; c < list.size(); ++c)
              narrower[c][i] += point.weight * list[c].value(there);
          }
        for (std::size_t c = 0; c < list.size(); ++c)
          if (const double deviation = deviation_of(
                list[c], here, narrower[c], checked, [&](const std::size_t i) { return model.family.scale(x, i); });
              deviation < deviations[c])
          {
            deviations[c]  = deviation;
            differences[c] = narrower[c];
          }
      }
      for (std::size_t c = 0; c < list.size(); ++c)
      {
        log.line(fmt::format("{}: gradient and differences differ by {:.1e} of its size; {:.1e} is {}",
                             list[c].name,
                             deviations[c],
                             tolerance,
                             deviations[c] <= tolerance ? "allowed" : "allowed: they do NOT agree"));
        for (const std::size_t i : checked)
          log.line(fmt::format("  {:<60} {:>17.10g} {:>17.10g}",
                               model.family.variables[i].path,
                               list[c].derivative(here, i),
                               differences[c][i]));
      }
      return std::ranges::max(deviations) <= tolerance;
    }

    /// --check-gradient: checks the gradients of each case at the start; where nothing can be compared at the start
    /// (e.g. a jump at the end of the run), beside it.
    ExitCode
    check_gradients(OptimizeCases &cases, Log &log)
    {
      constexpr double accurate = 1e-7, beside = 0.0137; // differences of rough simulations are unreliable
      const double accuracy = cases.parameters().accuracy;
      bool agrees           = true;
      for (unsigned long number = 0; number < cases.size(); ++number)
      {
        CaseStart start(cases, number, std::min(accuracy, accurate));
        const SceneFamily &family = *start.scenes;
        if (number == 0)
          introduce(cases, *start.model, {}, log);
        if (cases.are_several())
          log.line("Case " + cases.in_words(number));
        auto result = check_gradient(*start.model, start.x, log);
        if (!result)
        {
          for (std::size_t i = 0; i < start.x.size(); ++i)
          {
            const double shift = beside * family.scale(start.x, i);
            start.x[i] += start.x[i] + shift <= family.variables[i].to ? shift : -shift;
          }
          log.line(fmt::format("Near the start, with all variables {:g} % of their size away:", 100. * beside));
          result = check_gradient(*start.model, start.x, log);
        }
        agrees = agrees && result.value_or(true);
        start.scenes->form.declarations.set("Accuracy", to_text(accuracy));
      }
      return agrees ? ExitCode::finished : ExitCode::self_check_failed;
    }
  } // namespace

  ExitCode
  optimize(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file)
  {
    StudyClock clock;
    Log log(rank_of(communicator) == 0, options);
    OptimizeCases cases(communicator, file);
    if (options.check_gradient)
      return file.placing_errors([&]() { return check_gradients(cases, log); });
    file.placing_errors([&]() {
      const CaseStart start(cases, 0);
      introduce(cases, *start.model, cases.notes(file), log);
      start.model->evaluate(start.x, /*with_gradients=*/false).require_start();
    });
    StudyFolder folder(
      {"optimization", OptimizeMemory::file, {"Optimize/Time limit", "Optimize/Starts"}}, options, log);
    std::unique_ptr<OptimizeMemory> memory;
    on_first_rank(communicator, [&]() {
      memory = std::make_unique<OptimizeMemory>(cases, folder, file);
      if (memory->starts().empty())
      {
        remove_runs(folder.path, "best(-[0-9]+)?");
        remove_runs(folder.path, "optimum(-[0-9]+)?[.]prm");
      }
    });
    clock.set_limit(cases.parameters().optimize.time_limit, "Optimize/Time limit");
    const SearchesMade searches =
      make_searches(communicator, cases, memory.get(), folder, [&]() { return clock.is_over(); });
    const std::string stop = clock.reason(communicator, searches.are_whole);
    return exit_code_of_first_rank(communicator, [&]() {
      folder.require_in_place();
      const ExitCode end = write_results(cases, *memory, searches.starts, stop, clock, folder);
      folder.leave();
      return end;
    });
  }

  bool
  check_optimize(MPI_Comm communicator, const ParameterFile &file, Log &log)
  {
    const Assignment *const variables = file.assignment_of("Optimize/Variables");
    if (variables == nullptr || variables->value.empty())
      return false;
    OptimizeCases cases(communicator, file);
    file.placing_errors([&]() {
      for (unsigned long number = 0; number < cases.size(); ++number)
      {
        const CaseStart start(cases, number);
        if (number == 0)
          introduce(cases, *start.model, cases.notes(file), log);
        GaitProblem problem(*start.model, start.scenes->form.parameters.optimize, start.x);
        const GaitRecord record = problem.record(problem.to_y(start.x));
        log.line(fmt::format("  The start{}: {} {:.6g}, which {}.",
                             cases.are_several() ? " with " + cases.in_words(number) : "",
                             cases.names().objective.name,
                             record.objective,
                             record.violation <= problem.admissible()
                               ? "is within all limits"
                               : fmt::format("exceeds {} by {:.3g} %", record.worst_limit, 100. * record.violation)));
      }
    });
    log.line(file.name() + " is valid: all variables and cases are admissible. Nothing was written.");
    return true;
  }
} // namespace crawler
