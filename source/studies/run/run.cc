// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/model_choice.h>
#include <crawler/accuracy/moving_fronts.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/base/archive.h>
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_place.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/snapshot_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/run/simulation.h>
#include <crawler/run/summary.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/core/sensitivities.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/run/reduced_pictures.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/run/run_files.h>
#include <crawler/studies/run/run_in_memory.h>
#include <crawler/studies/run/run_memory.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace crawler
{
  namespace
  {
    /// Ends the run of all if a rank has failed alone, e.g. for lack of memory.
    void
    agree_on_failure(MPI_Comm communicator, TimeOutcome &outcome)
    {
      const std::string text = first_text(outcome.status == Status::none ? "" : archived(outcome), communicator);
      if (text.empty())
        return;
      Archive archive(text);
      archive(outcome);
    }

    /// Progress of a run: a bar, or a line at every tenth of the duration.
    class RunProgress : public Observer
    {
    public:
      RunProgress(Log &log, const Scene &scene)
        : log_(log)
        , end_time_(scene.end_time)
        , bar_(log, /*between_lines=*/HUGE_VAL)
      {
      }

      void
      observe(const Snapshot &snapshot) override
      {
        if (!snapshot.is_step_end || snapshot.step.number == 0)
          return;
        const Step &step          = snapshot.step;
        const StretchRange &range = snapshot.stretch;
        const double done         = step.time / end_time_;
        if (bar_.is_due())
          bar_.show(std::min(done, 1.),
                    fmt::format("t = {:.4g}  displacement {:.6g}  stretch {:.3g} to {:.3g}",
                                step.time,
                                snapshot.displacement,
                                range.min.value,
                                range.max.value));
        if (10. * done < next_tenth_)
          return;
        while (next_tenth_ <= 10. * done)
          ++next_tenth_;
        log_.progress(fmt::format(
          "  {:3.0f} %  t = {:<10.4g} step {:<6} size {:<9.3g} displacement {:<14.8g} stretch {:.3g} to {:.3g}",
          100. * done,
          step.time,
          step.number,
          step.size,
          snapshot.displacement,
          range.min.value,
          range.max.value));
      }

    private:
      Log &log_;
      const double end_time_;
      ProgressBar bar_;
      unsigned int next_tenth_ = 1;
    };

    /// `crawler run`, from the parameter file to the files and the exit code (all functions are collective). An
    /// exception in a part of the computation becomes the end of the run, with all files of an end.
    class RunStudy
    {
    public:
      RunStudy(MPI_Comm communicator, const CommandOptions &options, ParameterFile file)
        : communicator_(communicator)
        , options_(options)
        , is_first_(rank_of(communicator) == 0)
        , log_(is_first_, options)
        , input_(read_input(std::move(file)))
        , memory_(communicator, input_, options)
        , pictures_(picture_times(input_.parameters.output, input_.scene))
      {
        const auto limit = input_.parameters.time.wall_time_limit;
        clock_.set_limit(limit, wall_time_limit_in_words(limit.value_or(0.)));
        clock_.set_stop_file(memory_.folder / stop_file_name);
      }

      ExitCode
      run()
      {
        if (!memory_.begin(log_))
          return ExitCode::finished;
        guarded([&]() {
          model_                  = choose_model(input_);
          input_.parameters.model = model_->model;
        });
        agree_on_failure(communicator_, result_.time);
        const bool has_mesh = !model_ || model_->needs_mesh();
        if (has_mesh)
        {
          choose_mesh_and_steps();
          if (is_true_anywhere(clock_.is_over(), communicator_))
          {
            log_.warn(clock_.in_words(clock_.reason()) + " during the pilot runs; nothing was written");
            return ExitCode::stopped;
          }
          agree_on_failure(communicator_, result_.time);
          sharing_.is_shared = size_of(communicator_) > 1 && choice_ &&
                               choice_->numerics.formulation == Formulation::position &&
                               input_.parameters.discretization.shares(choice_->numerics.n_cells);
          if (sharing_.is_shared)
            sharing_.ranks = communicator_;
          guarded([&]() { build(*choice_); });
        }
        sharing_.has_output = sharing_.is_shared || is_first_;
        begin_output();
        const double setup = result_.process.seconds.setup = clock_.seconds();
        if (has_mesh)
          compute_on_mesh();
        else if (is_first_)
          compute_without_mesh();
        result_.process.seconds.setup = setup;
        return finish();
      }

    private:
      /// Division of the work: either all ranks share the cells, or each computes the whole body and the first one
      /// writes.
      struct Sharing
      {
        bool is_shared  = false;
        MPI_Comm ranks  = MPI_COMM_SELF; ///< ranks that compute together
        bool has_output = false;         ///< true if this rank takes part in writing
      };

      // Steps before the files exist.
      void
      choose_mesh_and_steps()
      {
        guarded([&]() {
          WaitProgress pilots(log_, pilot_runs);
          const auto goes_on = [&]() {
            pilots.step();
            reach(StopPlace::pilot);
            return !is_stopped();
          };
          choice_ = choose_numerics({input_.parameters, input_.scene, KeepGoing(goes_on, &memory_.journal)});
          if (choice_ && input_.parameters.output.has_snapshots())
            prepare_for_pictures(*choice_, input_.parameters);
        });
      }

      void
      build(const NumericsChoice &choice)
      {
        simulation_.reset();
        shown_scene_ = shown_scene(choice, input_.scene);
        simulation_ =
          std::make_unique<Simulation>(sharing_.ranks, *shown_scene_, input_.parameters.time, choice.numerics);
      }

      /// Makes the files, now that nothing in the input can be refused any more.
      void
      begin_output()
      {
        on_first_rank(communicator_, [&]() { memory_.begin_files(log_); });
        if (model_)
          report_plan(log_, input_, *model_, choice_ ? &*choice_ : nullptr);
        announce_petsc_options(options_, log_);
      }

      // Computation without or with a mesh.
      /// Computes a level that needs no mesh on the first rank, and writes the files of any run.
      void
      compute_without_mesh()
      {
        guarded([&]() {
          const OutputParameters &output = input_.parameters.output;
          const auto keep_going          = [&]() { return !is_stopped(); };
          ReducedModel level(input_.scene, model_->model);
          result_ = level.compute(input_.parameters.accuracy, output.energy_balance, keep_going, /*gait=*/true);
          log_.line(level.description());
          const Stopwatch watch;
          if (result_.error && (output.has_snapshots() || output.statistics) &&
              !show_pictures(level, times_without_mesh(input_), Kymograph::equidistant(), observers(), keep_going))
            result_.time.status = Status::stopped;
          result_.process.seconds.output = watch.seconds();
        });
      }

      void
      compute_on_mesh()
      {
        const Parameters &parameters   = input_.parameters;
        const OutputParameters &output = parameters.output;
        other_runs_.emplace(log_, "runs on other meshes come first");
        guarded([&]() {
          const KeepGoing keep_going(
            [&]() {
              if (other_runs_)
                other_runs_->step();
              return !is_true_anywhere(clock_.is_over(), sharing_.ranks);
            },
            &memory_.journal);
          const RecordOptions options = {.energy_balance = output.energy_balance,
                                         .cycles         = cycle_wish(parameters, input_.scene, output.has_snapshots()),
                                         .gait           = GaitWish::any};
          Answer answer               = run_to_accuracy(
            {parameters, input_.scene, keep_going, sharing_.ranks},
            *choice_,
            [&](const NumericsChoice &choice) {
              announce_next_try(choice);
              SimulationResult run = simulation_->run(pictures_, options, observers(), keep_going);
              other_runs_.emplace(log_, "other runs measure the error");
              result_.time = run.time;
              return run;
            },
            options,
            /*writes=*/true);
          result_ = std::move(answer.result);
          if (answer.choice.is_of_several_runs())
            log_.line("  (" + answer.choice.explanation + ")");
          choice_ = answer.choice;
        });
      }

      /// Announces the runs of an answer one after the other: the first one has been built and announced.
      void
      announce_next_try(const NumericsChoice &choice)
      {
        const TimeOutcome &latest   = result_.time;
        const bool is_again         = latest.status != Status::none;
        const bool is_of_other_form = choice_->is_of_several_runs() && !choice.is_of_several_runs();
        if (is_again)
        {
          log_.line((latest.status == Status::failed ? latest.reason + ": " + latest.message
                                                     : "The error is larger than Accuracy asks for") +
                    ": running again, " + (choice.is_family ? "in the stretch form." : "finer."));
          if (sharing_.has_output)
            on_first_rank(sharing_.ranks, [&]() { memory_.forget_fields(); });
        }
        if (is_again || choice.is_of_several_runs() || is_of_other_form)
          build(choice);
        if (!choice.is_of_several_runs() && (is_again || is_of_other_form))
          log_.line(in_words(choice.numerics, input_));
        if (is_of_other_form)
          log_.line("  (" + choice.explanation + ")");
        other_runs_.reset();
      }

      Observers
      observers()
      {
        const OutputParameters &output = input_.parameters.output;
        const double length            = input_.scene.body.length;
        Observers observers;
        if (!sharing_.has_output)
          return observers;
        if (output.has_snapshots())
          observers.push_back(output.snapshot_format == SnapshotFormat::xdmf
                                ? xdmf_files(memory_.folder, length, pictures_.n_snapshots() + 1)
                                : vtu_files(memory_.folder, length));
        if (output.has_snapshots() && output.kymograph)
          observers.push_back(std::make_shared<KymographWriter>(
            length, input_.scene.end_time, input_.scene.ground.profile, memory_.folder));
        if (output.statistics)
          observers.push_back(std::make_shared<StatisticsWriter>(
            is_first_, memory_.folder, output.energy_balance, input_.parameters.units));
        if (!options_.quiet)
          observers.push_back(std::make_shared<RunProgress>(log_, input_.scene));
        return observers;
      }

      // Steps at the end.
      ExitCode
      finish()
      {
        name_stop();
        check_identities(result_, input_.parameters);
        add_what_follows();
        warn_of_unused_petsc_options(communicator_, options_, log_);
        on_first_rank(communicator_, [&]() {
          memory_.require_in_place();
          const bool is_complete = !(choice_ && result_.time.status == Status::stopped && is_stopped());
          if (!is_complete)
            memory_.journal.write();
          write_summary();
          memory_.leave(log_, is_complete); // a kill before this loses nothing
        });
        // Signals may have stopped some ranks only.
        return exit_code_of_first_rank(communicator_, [&]() {
          const OutputParameters &output = input_.parameters.output;
          const bool has_pictures        = output.has_snapshots() && (choice_ || !model_ || result_.error);
          return report_end(log_,
                            result_,
                            input_.parameters.units,
                            memory_.folder,
                            has_pictures ? animation_file(output.snapshot_format) : "");
        });
      }

      void
      name_stop()
      {
        if (result_.time.status == Status::stopped && result_.time.reason.empty())
          stop(choice_ ? fmt::format("at t = {:.6g}", result_.time.time) : "before the end");
        if (result_.time.status == Status::finished && input_.parameters.error_estimate && result_.error &&
            !std::isfinite(result_.error->total) && is_stopped())
          stop("after the end of the run, before its error was known");
      }

      /// Adds the sensitivities of a run that has ended.
      void
      add_what_follows()
      {
        other_runs_.reset();
        if (is_first_ && !input_.sensitivities.empty() && result_.time.status != Status::finished)
          log_.warn("there are no sensitivities, since the run did not end normally");
        else if (is_first_ && !input_.sensitivities.empty())
        {
          WaitProgress progress(log_, "runs for the sensitivities");
          const auto goes_on = [&]() {
            progress.step();
            return !is_stopped();
          };
          write_sensitivities(add_sensitivities(input_, choice_.value_or(NumericsChoice()), result_, goes_on),
                              memory_.folder,
                              input_.parameters.units);
          if (is_stopped() &&
              !std::ranges::all_of(result_.sensitivities, [](const auto &one) { return one.value.has_value(); }))
            stop("after the end of the run, before all sensitivities were known");
        }
        if (choice_ && result_.time.status == Status::finished && input_.parameters.error_estimate &&
            !std::isfinite(result_.error->total))
          log_.warn("the error of the displacement is not known: the second run, which measures it, did not finish");
      }

      void
      write_summary()
      {
        result_.process.model = input_.parameters.model;
        write_file(memory_.folder / "summary.json",
                   summary_json(result_, size_of(communicator_), options_.command_line));
      }

      /// Decides on this rank alone. Levels without a mesh cannot be resumed, so only a signal stops them.
      bool
      is_stopped()
      {
        return model_ && !model_->needs_mesh() ? clock_.has_signal() : clock_.is_over();
      }

      void
      stop(const std::string &when)
      {
        result_.time.status  = Status::stopped;
        result_.time.reason  = clock_.reason();
        result_.time.message = clock_.in_words(clock_.reason()) + " " + when;
      }

      /// Performs @p work unless the run has ended.
      template <typename Work>
      void
      guarded(const Work &work)
      {
        try
        {
          if (result_.time.status == Status::none)
            work();
        }
        catch (...)
        {
          result_.time = failure_of(std::current_exception());
          if (!sharing_.is_shared)
            return;
          std::filesystem::create_directories(memory_.folder);
          write_summary(); // by the rank that failed, since the others may be waiting
          throw;
        }
      }

      StudyClock clock_;
      const MPI_Comm communicator_;
      const CommandOptions &options_;
      const bool is_first_;
      Log log_;
      Input input_;
      RunMemory memory_;

      std::optional<ModelChoice> model_;
      std::optional<NumericsChoice> choice_; ///< numerics of a level with a mesh
      Sharing sharing_;
      PictureTimes pictures_;
      std::optional<Scene> shown_scene_;
      std::unique_ptr<Simulation> simulation_;
      std::optional<WaitProgress> other_runs_; ///< progress of runs without one of their own
      SimulationResult result_;
    };
  } // namespace

  ExitCode
  run(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file)
  {
    return RunStudy(communicator, options, file).run();
  }

  ExitCode
  run_for_study(CommandOptions options,
                const std::filesystem::path &file,
                const std::vector<std::string> &overrides,
                const std::filesystem::path &place)
  {
    options.file      = file.string();
    options.output    = place.string();
    options.overrides = overrides;
    options.overwrite = options.quiet = true;
    options.resume                    = false;
    std::filesystem::create_directories(place);
    return run(MPI_COMM_SELF, options, read_file(MPI_COMM_SELF, options.file, overrides));
  }
} // namespace crawler
