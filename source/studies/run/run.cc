// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/numerics_choice.h>
#include <crawler/accuracy/run_as_promised.h>
#include <crawler/accuracy/swept_error.h>
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_place.h>
#include <crawler/base/stop_signal.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/snapshot_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/run/batch.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/run/simulation.h>
#include <crawler/run/summary.h>
#include <crawler/scene/moving_jumps.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/core/run_files.h>
#include <crawler/studies/run/reduced_pictures.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/run/run_checkpoint.h>
#include <crawler/studies/run/run_stops.h>
#include <crawler/studies/run/sensitivity_files.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>
#include <petscsys.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace crawler
{
  namespace
  {
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
      int speaker = outcome.status == Status::none ? n : static_cast<int>(rank_of(communicator));
      MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, communicator);
      if (speaker == n)
        return;
      const auto texts        = gather(outcome.reason + "\n" + outcome.message, communicator);
      const std::string text  = broadcast(texts.empty() ? "" : texts[static_cast<std::size_t>(speaker)], communicator);
      const std::size_t split = text.find('\n');
      outcome.status          = Status::failed;
      outcome.reason          = text.substr(0, split);
      outcome.message         = text.substr(split + 1);
    }

    void
    report_resumption(Log &log, const Resumption &resumption, const std::filesystem::path &folder)
    {
      for (const std::string &note : resumption.notes)
        log.warn("warning: " + note);
      switch (resumption.kind)
      {
        case Resumption::begins:
          log.line(
            fmt::format("There is no state in \"{}\" with which the run could go on: it begins.", folder.string()));
          break;
        case Resumption::goes_on:
          log.line("The run goes on from the state in restart.dat.");
          break;
        case Resumption::is_whole:
          log.line(fmt::format("The run in \"{}\" is complete; nothing was computed.", folder.string()));
          break;
      }
    }

    /// The sensitivities of a run that has ended, into its result and its folder. Returns false if a stop came before
    /// all were known.
    bool
    differentiate(Log &log,
                  const Input &input,
                  const NumericsChoice &choice,
                  const std::filesystem::path &folder,
                  const std::function<bool()> &is_stopped,
                  SimulationResult &result)
    {
      WaitProgress progress(log, "runs for the sensitivities");
      if (result.time.status != Status::finished)
      {
        log.warn("there are no sensitivities, since the run did not end as it should");
        return true;
      }
      write_sensitivities(add_sensitivities(input,
                                            choice,
                                            result,
                                            [&]() {
                                              progress.step();
                                              return !is_stopped();
                                            }),
                          folder,
                          input.parameters.units);
      return !is_stopped() ||
             std::ranges::all_of(result.sensitivities, [](const auto &one) { return one.value.has_value(); });
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
    for (const std::string &note : notes_on_choice(input, model.model, &choice.numerics))
      log.line(note);
  }

  ExitCode
  run(MPI_Comm communicator, const CommandOptions &options)
  {
    return run_input(communicator, options, read_file(communicator, options.file, options.overrides));
  }

  ExitCode
  run_input(MPI_Comm communicator, const CommandOptions &options, ParameterFile file)
  {
    const StopSignal stop_signal; // from here on a signal ends the run in order
    if (options.resume && options.overwrite)
      throw InputError("--resume and --overwrite contradict each other; one of them is expected");
    const double begin = now();
    const bool first   = rank_of(communicator) == 0;
    Log log(first, options);
    Input input                    = read_input(std::move(file));
    const Parameters &parameters   = input.parameters;
    const OutputParameters &output = parameters.output;
    const auto folder              = output_folder(options.output, options.file);
    std::optional<FolderLock> lock;
    RunCheckpoint checkpoint;
    Resumption resumption;
    on_first_rank(communicator, [&]() {
      require_usable(folder, options.overwrite || options.resume);
      checkpoint = checkpoint_of(input, options);
      if (options.resume)
      {
        lock.emplace(folder, /*overwrite=*/true);
        resumption = resumption_of(folder, checkpoint);
      }
      return "";
    });
    if (options.resume)
    {
      Archive known(broadcast(archived(resumption), communicator));
      known(resumption);
      report_resumption(log, resumption, folder);
      if (resumption.kind == Resumption::is_whole)
        return ExitCode::finished;
    }
    bool has_files = false;
    RunJournal journal(
      parameters.time.checkpoint_interval, !first ? RunJournal::Write() : [&](const std::string &all) {
        if (!has_files)
          return false;
        lock->require_in_place();
        checkpoint.journal = all;
        write_checkpoint(folder, checkpoint);
        reach(StopPlace::state);
        return true;
      });
    const bool goes_on = resumption.kind == Resumption::goes_on;
    if (goes_on)
      journal.load(resumption.journal);
    RunStops stops(stop_signal, parameters.time.wall_time_limit, begin, folder / stop_file_name);

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
        if (result.time.status == Status::none)
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
    {
      lock.reset();
      CommandOptions its_options = options;
      its_options.overwrite      = options.overwrite || options.resume;
      return run_reduced_model(communicator, its_options, input, *model, stop_signal, begin, log);
    }
    guarded([&]() {
      input.parameters.model = model->model;
      WaitProgress pilots(log, pilot_runs);
      const auto goes_on_with_pilots = [&]() {
        pilots.step();
        reach(StopPlace::pilot);
        return !stops.arrived_anywhere(MPI_COMM_SELF);
      };
      chosen = choose_numerics(MPI_COMM_SELF, parameters, input.scene, KeepGoing(goes_on_with_pilots, &journal));
      if (chosen && output.has_snapshots())
        prepare_for_pictures(*chosen, parameters);
    });
    if (stops.arrived_anywhere(communicator))
    {
      log.warn(fmt::format("stopped {} during the pilot runs; nothing was written", stops.in_words()));
      return ExitCode::stopped;
    }
    agree_on_failure(communicator, result.time);
    // Either all ranks share the cells, or each computes the whole body and the first one writes.
    shared = size_of(communicator) > 1 && chosen && chosen->numerics.formulation == Formulation::position &&
             parameters.discretization.shares(chosen->numerics.n_cells);
    const MPI_Comm computing = shared ? communicator : MPI_COMM_SELF;
    std::optional<WaitProgress> other_runs; // those without a progress of their own
    const auto continues = [&]() {
      if (other_runs)
        other_runs->step();
      return !stops.arrived_anywhere(computing);
    };
    const KeepGoing keep_going(continues, &journal);
    std::unique_ptr<Simulation> simulation;
    std::optional<Scene> scene_with_fronts;
    const auto build = [&](const NumericsChoice &choice) {
      simulation.reset();
      if (choice.front_part > 0.)
        scene_with_fronts = with_fronts(input.scene, choice.front_part);
      simulation = std::make_unique<Simulation>(
        computing, scene_with_fronts ? *scene_with_fronts : input.scene, parameters.time, choice.numerics);
    };
    guarded([&]() { build(*chosen); });

    // Everything is in order, or as good as it will be: from here on there are files.
    on_first_rank(communicator, [&]() {
      if (!lock)
        lock.emplace(folder, options.overwrite);
      begin_files(log, input, folder, goes_on);
      has_files = true;
      return "";
    });
    if (chosen)
      report_plan(log, input, *model, *chosen);
    if (!options.petsc_options.empty())
      log.line("PETSc options, stronger than these settings: " + options.petsc_options);

    const bool writes           = shared || first;
    const double length         = input.scene.body.length;
    const PictureTimes pictures = picture_times(output, input.scene);
    const auto create_observers = [&]() {
      std::vector<std::unique_ptr<Observer>> observers;
      if (writes && output.has_snapshots())
      {
        observers.push_back(
          std::make_unique<SnapshotWriter>(output.snapshot_format, folder, length, pictures.n_snapshots() + 1));
        if (output.kymograph)
          observers.push_back(
            std::make_unique<KymographWriter>(length, input.scene.end_time, input.scene.ground.profile, folder));
      }
      if (writes && output.statistics)
        observers.push_back(
          std::make_unique<StatisticsWriter>(length, first, folder, output.energy_balance, input.parameters.units));
      if (writes && !options.quiet)
        observers.push_back(std::make_unique<RunProgress>(log, input.scene));
      return observers;
    };
    const double setup_seconds = now() - begin;
    unsigned int n_runs        = 0;
    TimeOutcome latest;
    const Simulation::Options run_options = {.energy_balance = output.energy_balance,
                                             .cycles = cycle_wish(parameters, input.scene, output.has_snapshots()),
                                             .gait   = Simulation::GaitWish::any};
    const auto simulate                   = [&](const NumericsChoice &choice) {
      if (++n_runs > 1)
      {
        log.line((latest.status == Status::failed ? latest.reason + ": " + latest.message
                                                                    : "The error is larger than Accuracy asks for") +
                 ": once more, " + (choice.is_family ? "in the stretch form." : "finer."));
        if (writes)
          on_first_rank(computing, [&]() {
            if (journal.was_written()) // older states need the files that are removed
            {
              remove_checkpoints(folder);
              journal.write();
            }
            remove_fields(folder);
            return "";
          });
      }
      const bool is_of_other_form = chosen->is_of_several_runs() && !choice.is_of_several_runs();
      if (n_runs > 1 || choice.is_of_several_runs() || is_of_other_form)
        build(choice);
      if (!choice.is_of_several_runs() && (n_runs > 1 || is_of_other_form))
        log.line(describe(choice.numerics, input));
      if (is_of_other_form)
        log.line("  (" + choice.explanation + ")");
      other_runs.reset();
      SimulationResult run = simulation->run(pictures, run_options, create_observers(), keep_going);
      other_runs.emplace(log, "other runs measure the error");
      latest = run.time;
      return run;
    };
    other_runs.emplace(log, "runs on other meshes come before");
    guarded([&]() {
      Answer answer = run_as_promised(
        computing, parameters, input.scene, *chosen, simulate, run_options, /*writes=*/true, keep_going);
      result = std::move(answer.result);
      if (answer.choice.is_of_several_runs())
        log.line("  (" + answer.choice.explanation + ")");
      chosen                  = answer.choice;
      result.estimate_seconds = answer.estimate_seconds;
      result.refinements      = answer.refinements;
    });
    result.setup_seconds = setup_seconds;
    if (result.time.status == Status::stopped && result.time.reason.empty())
    {
      result.time.reason  = stops.reason();
      result.time.message = fmt::format("stopped {} at t = {:.6g}", stops.in_words(), result.time.time);
    }
    if (result.time.status == Status::finished && parameters.error_estimate && result.error &&
        !std::isfinite(result.error->total) && stops.arrived_anywhere(MPI_COMM_SELF))
    {
      result.time.status = Status::stopped;
      result.time.reason = stops.reason();
      result.time.message =
        fmt::format("stopped {} after the end of the run, before its error was known", stops.in_words());
    }
    check_identities(result, parameters);
    if (first && !shared && chosen)
      sweep_error(parameters, input.scene, *chosen, result, continues);
    other_runs.reset();
    if (first && !input.sensitivities.empty())
    {
      const auto is_stopped = [&]() { return stops.arrived_anywhere(MPI_COMM_SELF); }; // by this rank alone
      if (!differentiate(log, input, chosen.value_or(NumericsChoice()), folder, is_stopped, result))
      {
        result.time.status = Status::stopped;
        result.time.reason = stops.reason();
        result.time.message =
          fmt::format("stopped {} after the end of the run, before all sensitivities were known", stops.in_words());
      }
    }
    if (result.time.status == Status::finished && parameters.error_estimate && !std::isfinite(result.error->total))
      log.warn("the error of the displacement is not known: the second run, which measures it, did not finish");
    report_unused_options(log);

    on_first_rank(communicator, [&]() {
      lock->require_in_place();
      const bool is_for_later = result.time.status == Status::stopped && stops.arrived_anywhere(MPI_COMM_SELF);
      if (is_for_later)
        journal.write();
      write_summary();
      if (!is_for_later) // until now a kill loses nothing
        remove_checkpoints(folder);
      if (is_for_later && journal.was_written())
        log.line("The state of the run is in restart.dat: the same command with --resume goes on with it.");
      return "";
    });
    // A signal may have stopped some ranks only.
    return exit_code_of_first_rank(communicator, [&]() {
      return report_end(log,
                        result,
                        input.parameters.units,
                        folder,
                        output.has_snapshots() ? animation_file(output.snapshot_format) : "");
    });
  }

  namespace
  {
    /// Writes the output times of a level as a run with a mesh does. Returns false if it was interrupted.
    bool
    write_pictures(const ReducedModel &level,
                   const Input &input,
                   const std::filesystem::path &folder,
                   const StopSignal &signal)
    {
      const OutputParameters &output = input.parameters.output;
      const double length            = input.scene.body.length;
      const PictureTimes times       = times_without_mesh(input);
      std::optional<SnapshotWriter> snapshots;
      if (output.has_snapshots())
        snapshots.emplace(output.snapshot_format, folder, length, times.n_snapshots() + 1);
      KymographWriter kymograph(length, input.scene.end_time, input.scene.ground.profile, folder);
      std::optional<StatisticsWriter> statistics;
      if (output.statistics)
        statistics.emplace(length, true, folder, output.energy_balance, input.parameters.units);
      const bool whole = show_pictures(
        level,
        times,
        {snapshots ? [&](const Frame &frame) { snapshots->write(frame); } : std::function<void(const Frame &)>(),
         output.has_snapshots() ? &kymograph : nullptr,
         statistics ? &*statistics : nullptr},
        [&]() { return !signal.arrived_anywhere(MPI_COMM_SELF); });
      if (statistics)
        statistics->end();
      if (snapshots)
        snapshots->end();
      if (output.has_snapshots() && output.kymograph)
        kymograph.end();
      return whole;
    }
  } // namespace

  ExitCode
  run_reduced_model(MPI_Comm communicator,
                    const CommandOptions &options,
                    const Input &input,
                    const ModelChoice &choice,
                    const StopSignal &stop_signal,
                    const double begin,
                    Log &log)
  {
    const OutputParameters &output = input.parameters.output;
    const auto folder              = output_folder(options.output, options.file);
    return exit_code_of_first_rank(communicator, [&]() {
      const FolderLock lock(folder, options.overwrite);
      begin_files(log, input, folder);
      report_scene(log, input);
      log.line(choice.explanation);
      for (const std::string &note : notes_on_choice(input, choice.model))
        log.line(note);

      Parameters parameters = input.parameters;
      parameters.model      = choice.model;
      const double setup    = now() - begin;
      SimulationResult result;
      result.model = choice.model;
      try
      {
        ReducedModel level(input.scene, choice.model);
        result = level.compute(
          parameters.accuracy, output.energy_balance, [&]() { return !stop_signal.arrived_anywhere(MPI_COMM_SELF); });
        result.setup_seconds = setup;
        level.describe_gait(result);
        check_identities(result, parameters);
        log.line(level.description());
        const auto is_stopped = [&]() { return stop_signal.arrived_anywhere(MPI_COMM_SELF); };
        if (!input.sensitivities.empty() && !differentiate(log, input, {}, folder, is_stopped, result))
          result.time.status = Status::stopped;

        const Stopwatch output_watch;
        if (result.error && (output.has_snapshots() || output.statistics) &&
            !write_pictures(level, input, folder, stop_signal))
          result.time.status = Status::stopped;
        result.output_seconds = output_watch.seconds();
      }
      catch (...)
      {
        result.time = failure_of(std::current_exception());
      }
      if (result.time.status == Status::stopped)
      {
        result.time.reason  = "signal";
        result.time.message = "stopped by a signal";
      }
      lock.require_in_place();
      write_file(folder / "summary.json", summary_json(result, size_of(communicator), options.command_line));
      return report_end(log,
                        result,
                        input.parameters.units,
                        folder,
                        output.has_snapshots() && result.error ? animation_file(output.snapshot_format) : "");
    });
  }

  ExitCode
  check_reduced_model(const Input &input, const ModelChoice &choice, Log &log)
  {
    report_scene(log, input);
    log.line(choice.explanation);
    for (const std::string &note : notes_on_choice(input, choice.model))
      log.line(note);
    log.line("No mesh and no time steps are needed.");
    log.line(input.file.name() + " is in order; nothing was run, and nothing was written.");
    return ExitCode::finished;
  }
} // namespace crawler
