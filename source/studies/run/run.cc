// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/numerics_choice.h>
#include <crawler/accuracy/run_as_promised.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_signal.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/output/vtu_writer.h>
#include <crawler/run/batch.h>
#include <crawler/run/self_check.h>
#include <crawler/run/simulation.h>
#include <crawler/run/summary.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/core/run_files.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/run/run_reduced_model.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>
#include <petscsys.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace crawler
{
  namespace
  {
    /// n equal parts of (0, end_time].
    std::vector<double>
    equal_times(const unsigned int n, const double end_time)
    {
      std::vector<double> times;
      for (unsigned int i = 1; i <= n; ++i)
        times.push_back(i == n ? end_time : end_time * i / n);
      return times;
    }

    std::string
    describe(const Numerics &n, const Input &input)
    {
      const TimeParameters &time   = input.parameters.time;
      const std::string integrator = time.integrator != "automatic" ? time.integrator
                                     : n.integrator.empty()         ? "bdf"
                                                                    : n.integrator;
      const std::size_t ends       = first_cell_ends(input.scene, n).size();
      const std::size_t cells      = ends > 0 ? ends - 1 : n.n_cells;
      return fmt::format("Mesh: {} cells of degree {}, {} unknowns. Time: {}{}, tolerance {:.3g}.",
                         cells,
                         n.degree,
                         cells * n.degree + 1,
                         integrator,
                         integrator == "bdf"                 ? fmt::format(" of order {}", time.order)
                         : lane_method(input.scene, time, n) ? " (fused engine)"
                                                             : "",
                         n.tolerance);
    }

    /// A rank that has failed alone, for want of memory perhaps, ends the run of all.
    void
    agree_on_failure(MPI_Comm communicator, TimeOutcome &outcome)
    {
      const int n = static_cast<int>(size_of(communicator));
      int speaker = outcome.status.empty() ? n : static_cast<int>(rank_of(communicator));
      MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, communicator);
      if (speaker == n)
        return;
      const auto texts        = gather(outcome.reason + "\n" + outcome.message, communicator);
      const std::string text  = broadcast(texts.empty() ? "" : texts[static_cast<std::size_t>(speaker)], communicator);
      const std::size_t split = text.find('\n');
      outcome.status          = "failed";
      outcome.reason          = text.substr(0, split);
      outcome.message         = text.substr(split + 1);
    }

    /// PETSc options that were not read are most likely misspelt.
    void
    report_unused_options(Log &log)
    {
      PetscInt n   = 0;
      char **names = nullptr, **values = nullptr;
      PetscOptionsLeftGet(nullptr, &n, &names, &values);
      for (PetscInt i = 0; i < n; ++i)
        log.warn(fmt::format("warning: nothing used the PETSc option -{}", names[i]));
      PetscOptionsLeftRestore(nullptr, &n, &names, &values);
    }
  } // namespace

  void
  report_plan(Log &log, const Input &input, const ModelChoice &model, const NumericsChoice &choice)
  {
    report_scene(log, input);
    log.line(model.explanation);
    log.line(describe(choice.numerics, input));
    log.line("  (" + choice.explanation + ")");
  }

  ExitCode
  run(MPI_Comm communicator, const CommandOptions &options)
  {
    const StopSignal stop_signal; // from here on a signal ends the run in order
    const auto start = std::chrono::steady_clock::now();
    const bool first = rank_of(communicator) == 0;
    Log log(first, options.quiet);
    Input input                    = read_input(communicator, options.file, options.overrides);
    const Parameters &parameters   = input.parameters;
    const OutputParameters &output = parameters.output;
    const auto folder              = output_folder(options.output, options.file);
    on_first_rank(communicator, [&]() {
      require_usable(folder, options.overwrite);
      require_no_study(folder);
      return "";
    });

    SimulationResult result;
    bool shared              = false; // the cells, by all ranks
    const auto write_summary = [&]() {
      result.model = parameters.model;
      write_file(folder / "summary.json", summary_json(result, size_of(communicator), options.command_line));
    };
    // What a part of the work throws is how the run ends, with all that an end has.
    const auto guarded = [&](const auto &work) {
      try
      {
        if (result.time.status.empty())
          work();
      }
      catch (...)
      {
        result.time = failure_of(std::current_exception());
        if (!shared)
          return;
        std::filesystem::create_directories(folder);
        write_summary(); // by whoever failed, since the others may be waiting
        throw;
      }
    };
    std::optional<ModelChoice> model;
    std::optional<NumericsChoice> chosen;
    guarded([&]() { model = choose_model(input); });
    agree_on_failure(communicator, result.time);
    if (model && !model->needs_mesh())
      return run_reduced_model(communicator, options, input, *model, stop_signal, start, log);
    guarded([&]() {
      input.parameters.model = model->model;
      // The linear level (a = 0) is computed by what follows, as the nonlinear one.
      PilotProgress pilots(log);
      chosen = choose_numerics(MPI_COMM_SELF, parameters, input.scene, [&]() {
        pilots.step();
        return !stop_signal.arrived_anywhere(MPI_COMM_SELF);
      });
    });
    if (stop_signal.arrived_anywhere(communicator))
    {
      log.warn("stopped by a signal during the pilot runs; nothing was written");
      return ExitCode::stopped;
    }
    agree_on_failure(communicator, result.time);
    // Either all ranks share the cells, or each computes the whole body and the first one writes.
    shared = size_of(communicator) > 1 && chosen && chosen->numerics.formulation == Formulation::position &&
             parameters.discretization.shares(chosen->numerics.n_cells);
    const MPI_Comm computing = shared ? communicator : MPI_COMM_SELF;
    const auto keep_going    = [&]() { return !stop_signal.arrived_anywhere(computing); };
    std::unique_ptr<Simulation> simulation;
    const auto build = [&](const Numerics &numerics) {
      simulation = std::make_unique<Simulation>(computing, input.scene, parameters.time, numerics);
    };
    guarded([&]() { build(chosen->numerics); });

    // Everything is in order, or as good as it will be: from here on there are files.
    on_first_rank(communicator, [&]() {
      begin_files(log, input, folder);
      return "";
    });
    if (chosen)
      report_plan(log, input, *model, *chosen);
    if (!options.petsc_options.empty())
      log.line("PETSc options, stronger than these settings: " + options.petsc_options);

    const bool writes           = shared || first;
    const auto create_observers = [&]() {
      std::vector<std::unique_ptr<Observer>> observers;
      if (writes && output.n_snapshots > 0)
      {
        observers.push_back(std::make_unique<VtuWriter>(folder));
        if (output.kymograph)
          observers.push_back(std::make_unique<KymographWriter>(input.scene.end_time, folder));
      }
      if (writes && output.statistics)
        observers.push_back(
          std::make_unique<StatisticsWriter>(input.scene.body.length, first, folder, output.energy_balance));
      if (writes && !options.quiet)
        observers.push_back(std::make_unique<Progress>(log, input.scene));
      return observers;
    };
    const double setup_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    unsigned int n_runs        = 0;
    TimeOutcome latest;
    const Simulation::Options run_options = {.energy_balance = output.energy_balance,
                                             .resolution     = false,
                                             .cycles         = cycle_wish(parameters, input.scene, output.n_snapshots),
                                             .gait           = Simulation::GaitWish::any};
    const auto simulate                   = [&](const NumericsChoice &choice) {
      if (choice.is_family)
        build(choice.numerics);
      else if (++n_runs > 1)
      {
        log.line((latest.status == "failed" ? latest.reason + ": " + latest.message
                                                              : "The error is larger than Accuracy asks for") +
                 ": once more, finer.");
        build(choice.numerics);
        if (writes)
          on_first_rank(computing, [&]() {
            remove_fields(folder);
            return "";
          });
        log.line(describe(choice.numerics, input));
      }
      SimulationResult run = simulation->run(
        equal_times(output.n_snapshots, parameters.time.end_time), run_options, create_observers(), keep_going);
      latest = run.time;
      return run;
    };
    guarded([&]() {
      Answer answer = run_as_promised(
        computing, parameters, input.scene, *chosen, simulate, run_options, /*writes=*/true, keep_going);
      result = std::move(answer.result);
      if (answer.choice.is_family)
        log.line("  (" + answer.choice.explanation + ")");
      result.estimate_seconds = answer.estimate_seconds;
      result.refinements      = answer.refinements;
    });
    result.setup_seconds = setup_seconds;
    if (result.time.status == "stopped" && result.time.reason.empty())
    {
      result.time.reason  = "signal";
      result.time.message = fmt::format("stopped by a signal at t = {:.6g}", result.time.time);
    }
    check_identities(result, parameters);
    if (result.time.status == "finished" && parameters.error_estimate && !std::isfinite(result.error->total))
      log.warn("the error of the displacement is not known: the second run, which measures it, did not finish");
    report_unused_options(log);

    on_first_rank(communicator, [&]() {
      write_summary();
      return "";
    });
    // The first rank speaks for all: a signal may have stopped some only.
    int code = static_cast<int>(report_end(log, result, folder, output.n_snapshots > 0));
    MPI_Bcast(&code, 1, MPI_INT, 0, communicator);
    return static_cast<ExitCode>(code);
  }
} // namespace crawler
