// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/row_file.h>
#include <crawler/base/stop_signal.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/pictures.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/core/study_folder.h>
#include <crawler/studies/optimize/gradient_check.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/optimize/optimize_results.h>
#include <crawler/studies/optimize/scene_family.h>
#include <crawler/studies/run/run.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    /// A limit of work and a start.
    struct Part
    {
      std::optional<double> work;
      unsigned long start;

      fs::path
      file(const fs::path &folder) const
      {
        return folder / "starts" / fmt::format("{}{}.json", work ? fmt::format("work-{:.17g}-", *work) : "", start);
      }
    };

    std::vector<Part>
    parts_of(const OptimizeParameters &parameters)
    {
      std::vector<std::optional<double>> limits(parameters.work.begin(), parameters.work.end());
      if (limits.empty())
        limits.emplace_back();
      std::vector<Part> parts;
      for (const auto &limit : limits)
        for (unsigned long start = 0; start < parameters.n_starts; ++start)
          parts.push_back({limit, start});
      return parts;
    }

    /// What is in the folder already, of @p parts.
    bool
    is_done(const Part &part, const fs::path &folder)
    {
      const fs::path file = part.file(folder);
      return fs::exists(file) && !unpack_start(read_whole_file(file)).was_interrupted;
    }

    void
    begin_or_resume(MPI_Comm communicator, StudyFolder &folder, const ParameterFile &file, const std::string &effective)
    {
      on_first_rank(communicator, [&]() -> std::string {
        const fs::path starts = folder.path() / "starts";
        if (folder.begin(file.text(), effective))
          folder.resume(
            differences(read_whole_file(folder.path() / "parameters.prm"), effective, folder.kind().free_entries));
        else
        {
          fs::remove_all(starts);
          fs::create_directories(starts);
        }
        return "";
      });
    }

    /// The optimum as a parameter file, and its run in a folder of its own. Returns the summary of the run.
    std::string
    run_optimum(SceneFamily &family,
                const StartResult &start,
                const std::string &number,
                const fs::path &folder,
                const CommandOptions &options)
    {
      const Parameters parameters = family.parameters(start.best.x);
      std::ostringstream text;
      family.form().declarations.print_prm(text);
      const fs::path file = folder / ("optimum" + number + ".prm"), place = folder / ("best" + number);
      write_file(file, text.str());
      CommandOptions one = options;
      one.file           = file.string();
      one.output         = place.string();
      one.overrides      = {};
      one.overwrite = one.quiet = true;
      one.resume                = false;
      if (parameters.create_scene().active_stress->feedback() == nullptr)
        one.overrides.push_back("Output/Active stress table=129, 513");
      fs::create_directories(place);
      run(MPI_COMM_SELF, one);
      return fs::exists(place / "summary.json") ? read_whole_file(place / "summary.json") : "{}";
    }

    /// Tables, the optima with their runs, and the summary, by rank 0. Returns the exit code.
    ExitCode
    write_results(SceneFamily &family,
                  const std::vector<Part> &parts,
                  const CommandOptions &options,
                  const std::string &effective,
                  const bool is_whole,
                  const std::string &reason,
                  const double begin,
                  const fs::path &folder,
                  Log &log)
    {
      std::vector<StartResult> starts;
      for (const Part &part : parts)
        if (fs::exists(part.file(folder)))
          starts.push_back(unpack_start(read_whole_file(part.file(folder))));
      const OptimizeResults results(
        family.form().parameters.optimize, family.variables(), family.form().declarations, std::move(starts));
      const Table evaluations = evaluation_table(results), of_starts = start_table(results);
      write_file(folder / "results.csv", csv(evaluations));
      write_hdf5(folder / "results.h5", "optimize", evaluations, provenance(effective, options.command_line));
      write_file(folder / "starts.csv", csv(of_starts));
      std::vector<std::string> summaries;
      bool is_admissible = !results.best.empty(), has_converged = !results.best.empty();
      for (std::size_t i = 0; i < results.best.size(); ++i)
      {
        const StartResult &best = results.starts[results.best[i]];
        is_admissible           = is_admissible && best.is_admissible();
        has_converged           = has_converged && best.has_converged;
        summaries.push_back(
          run_optimum(family, best, results.best.size() > 1 ? fmt::format("-{}", i + 1) : "", folder, options));
      }
      const std::string status = !is_whole ? "stopped" : is_admissible && has_converged ? "finished" : "failed";
      const std::string why    = !is_whole        ? reason
                                 : !is_admissible ? "limits_exceeded"
                                 : !has_converged ? "optimiser_not_converged"
                                                  : "";
      write_file(folder / "summary.json",
                 optimize_json(results, summaries, status, why, now() - begin, options.command_line));
      for (const std::string &line : in_words(results, summaries))
        log.line(line);
      if (!results.best.empty())
        draw("optimize.py", folder, log);
      if (!is_whole)
        log.warn(
          fmt::format("stopped by {}; --resume goes on", reason == "signal" ? "a signal" : "Optimize/Time limit"));
      else if (status == "failed")
        log.warn(
          why == "limits_exceeded"
            ? "no gait that keeps to all limits was found; the limits may contradict each other, or the start is "
              "far from them"
            : "the optimiser did not converge; the lines above say why");
      log.line(fmt::format("{} evaluations from {} start{}, {:.1f} s. The best gait is in {}/optimum{}.prm, its run in "
                           "{}/best{}/.",
                           std::get<std::vector<double>>(evaluations.front().values).size(),
                           results.starts.size(),
                           results.starts.size() == 1 ? "" : "s",
                           now() - begin,
                           folder.string(),
                           results.best.size() > 1 ? "-N" : "",
                           folder.string(),
                           results.best.size() > 1 ? "-N" : ""));
      return !is_whole ? ExitCode::stopped : status == "finished" ? ExitCode::finished : ExitCode::numerical_failure;
    }
  } // namespace

  ExitCode
  optimize(MPI_Comm communicator, const CommandOptions &options)
  {
    const StopSignal stop_signal; // from here on a signal ends the study in order
    const double begin = now();
    Log log(rank_of(communicator) == 0, options.quiet);
    const ParameterFile file = read_file(communicator, options.file, options.overrides);
    Form form(file);
    std::ostringstream text;
    form.declarations.print_prm(text);
    const std::string effective = text.str();
    std::optional<SceneFamily> family;
    std::vector<Part> parts;
    try
    {
      form.parameters.create_scene();
      family.emplace(form, read_variables(form));
      parts            = parts_of(form.parameters.optimize);
      const auto start = start_values(form.parameters.optimize, family->variables(), 0);
      const auto model = make_gait_model(*family, start, []() { return false; });
      log.line(fmt::format("Optimisation of the {}: {} variable{}, {} start{}{}; {}.",
                           form.parameters.optimize.objective,
                           family->variables().size(),
                           family->variables().size() == 1 ? "" : "s",
                           form.parameters.optimize.n_starts,
                           form.parameters.optimize.n_starts == 1 ? "" : "s",
                           form.parameters.optimize.work.size() > 1
                             ? fmt::format(" for each of {} limits of work", form.parameters.optimize.work.size())
                             : "",
                           model->description()));
      if (options.check_gradient)
        return check_gradient(*model, *family, GaitProblem::wishes(form.parameters.optimize), start, log)
                 ? ExitCode::finished
                 : ExitCode::self_check_failed;
      model->evaluate(start, /*with_gradients=*/false).require_start();
    }
    catch (const InputError &error)
    {
      throw file.with_place(error);
    }
    const OptimizeParameters own = form.parameters.optimize;
    const fs::path path          = output_folder(options.output, options.file);
    StudyFolder folder({"optimization", {"starts"}, {"Optimize/Time limit", "Optimize/Starts"}}, path, options, log);
    begin_or_resume(communicator, folder, file, effective);

    const std::function<bool()> interrupted = [&]() {
      return stop_signal.arrived_anywhere(MPI_COMM_SELF) || (own.time_limit && now() - begin > *own.time_limit);
    };
    const auto n_missing =
      static_cast<unsigned long>(std::ranges::count_if(parts, [&](const Part &part) { return !is_done(part, path); }));
    const bool is_whole      = share_work(communicator,
                                     {parts.size(),
                                           n_missing,
                                           "starts",
                                           interrupted,
                                           [&](const unsigned long number, const auto &stops, const auto &see) {
                                        const Part &part = parts[number];
                                        if (is_done(part, path))
                                          return true;
                                        const StartResult result = search(*family, part.work, part.start, stops);
                                        write_file(part.file(path), pack(result));
                                        see(1, result.has_converged ? 0 : 1);
                                        return !result.was_interrupted;
                                      }},
                                     log);
    const std::string reason = is_whole ? "" : stop_signal.arrived_anywhere(communicator) ? "signal" : "time_limit";
    const std::string code   = on_first_rank(communicator, [&]() {
      const ExitCode end = write_results(*family, parts, options, effective, is_whole, reason, begin, path, log);
      folder.leave();
      return fmt::format("{}", static_cast<int>(end));
    });
    return static_cast<ExitCode>(std::stoi(code));
  }
} // namespace crawler
