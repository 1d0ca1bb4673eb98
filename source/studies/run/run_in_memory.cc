// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/moving_fronts.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/base/clock.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/parameters/plain_text.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/run/reduced_pictures.h>
#include <crawler/studies/run/run_in_memory.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace crawler
{
  namespace
  {
    /// Makes new tables for a run, or for the next attempt.
    Observers
    begin_tables(const OutputParameters &output, const WantedFields &wanted, RunInMemory &run)
    {
      Observers tables;
      if (!wanted.points.empty())
        tables.push_back(run.kymograph = std::make_shared<Kymograph>(wanted.points));
      if (output.statistics)
        tables.push_back(run.statistics = std::make_shared<Statistics>(output.energy_balance));
      return tables;
    }

    void
    compute_without_mesh(const Input &input,
                         const WantedFields &wanted,
                         const std::function<bool()> &keep_going,
                         const Afterwards &afterwards,
                         RunInMemory &run)
    {
      const OutputParameters &output = input.parameters.output;
      run.notes                      = notes_on_choice(input, input.parameters.model);
      ReducedModel level(input.scene, input.parameters.model);
      run.result = level.compute(input.parameters.accuracy, output.energy_balance, keep_going, /*gait=*/!wanted.is_all);
      check_identities(run.result, input.parameters);
      if (afterwards && run.result.time.status == Status::finished)
        afterwards(input, {}, run.result);
      if (!run.result.error || (wanted.points.empty() && !output.statistics))
        return;
      show_pictures(level,
                    wanted.times ? PictureTimes({}, *wanted.times, input.scene.end_time) : times_without_mesh(input),
                    wanted.points.empty() ? Kymograph::equidistant() : wanted.points,
                    begin_tables(output, wanted, run),
                    keep_going);
    }

    void
    compute_on_mesh(const Input &input,
                    const WantedFields &wanted,
                    const std::function<bool()> &keep_going,
                    const Afterwards &afterwards,
                    RunInMemory &run)
    {
      const Parameters &parameters = input.parameters;
      const PictureTimes pictures  = wanted.times ? PictureTimes({}, *wanted.times, input.scene.end_time)
                                                  : picture_times(parameters.output, input.scene);
      auto &chosen = run.numerics = wanted.numerics;
      if (!chosen)
      {
        chosen = choose_numerics({parameters, input.scene, keep_going});
        if (chosen && !pictures.is_empty())
          prepare_for_pictures(*chosen, parameters);
      }
      if (!chosen)
      {
        run.result.time.status = Status::stopped;
        return;
      }
      run.notes                   = notes_on_choice(input, parameters.model, &chosen->numerics);
      const RecordOptions options = {.energy_balance = parameters.output.energy_balance,
                                     .cycles         = cycle_wish(parameters, input.scene, !pictures.is_empty()),
                                     .gait           = wanted.is_all ? GaitWish::none : GaitWish::any};
      const auto simulate         = [&](const NumericsChoice &choice) {
        const Scene scene      = shown_scene(choice, input.scene);
        const Observers tables = begin_tables(parameters.output, wanted, run);
        return Simulation(MPI_COMM_SELF, scene, parameters.time, choice.numerics)
          .run(pictures, options, tables, keep_going);
      };
      Answer answer =
        run_to_accuracy({parameters, input.scene, keep_going}, *chosen, simulate, options, /*writes=*/true);
      run.result = std::move(answer.result);
      check_identities(run.result, parameters);
      if (afterwards && run.result.time.status == Status::finished)
        afterwards(input, answer.choice, run.result);
    }
  } // namespace

  std::string
  wall_time_limit_in_words(const double limit)
  {
    return fmt::format("Time/Wall time limit, {:g} s,", limit);
  }

  RunInMemory
  run_in_memory(Input &input,
                const ModelChoice &model,
                WantedFields wanted,
                const std::function<bool()> &interrupted,
                const Afterwards &afterwards)
  {
    RunInMemory run;
    input.parameters.model         = model.model;
    const OutputParameters &output = input.parameters.output;
    const double begin             = now();
    const auto limit               = input.parameters.time.wall_time_limit;
    bool is_out_of_time            = false;
    const auto keep_going          = [&]() {
      is_out_of_time = is_out_of_time || (limit && now() - begin >= *limit);
      return !is_out_of_time && !interrupted();
    };
    if (!wanted.times && output.has_snapshots() && output.kymograph)
      wanted.points = Kymograph::equidistant();
    try
    {
      if (model.needs_mesh())
        compute_on_mesh(input, wanted, keep_going, afterwards, run);
      else
        compute_without_mesh(input, wanted, keep_going, afterwards, run);
    }
    catch (...)
    {
      run.result.time = failure_of(std::current_exception());
    }
    run.result.process.model = model.model;
    TimeOutcome &end         = run.result.time;
    const bool is_cut        = end.status == Status::stopped ||
                        (end.status == Status::finished && run.result.error && !std::isfinite(run.result.error->total));
    if (is_out_of_time && is_cut)
    {
      end.status  = Status::stopped;
      end.reason  = "time_limit";
      end.message = fmt::format("stopped by {} at t = {:.6g}", wall_time_limit_in_words(*limit), end.time);
    }
    return run;
  }

  FieldRuns::FieldRuns(ParameterFile file, std::vector<std::string> paths)
    : paths_(std::move(paths))
    , form_(file)
    , input_(read_input(std::move(file), /*command=*/"fit"))
  {
  }

  RunInMemory
  FieldRuns::run(const std::vector<double> &numbers,
                 const bool is_similar,
                 const std::function<WantedFields(const Scene &)> &fields_wanted,
                 const std::function<void()> &start,
                 const std::function<bool()> &interrupted)
  {
    input_.file.placing_errors([&]() {
      for (std::size_t i = 0; i < paths_.size(); ++i)
        form_.declarations.set(paths_[i], to_text(numbers.at(i)));
      Parameters &parameters           = input_.parameters;
      parameters                       = form_.parameters;
      parameters.error_estimate        = false;
      parameters.output.energy_balance = false;
      input_.scene                     = parameters.create_scene();
    });
    if (!is_similar || !model_)
    {
      model_    = choose_model(input_);
      numerics_ = std::nullopt;
    }
    if (model_->needs_mesh())
      start();
    WantedFields wanted = fields_wanted(input_.scene);
    wanted.is_all       = true;
    wanted.numerics     = numerics_;
    RunInMemory run     = run_in_memory(input_, *model_, wanted, interrupted);
    if (!numerics_)
      numerics_ = run.numerics;
    return run;
  }
} // namespace crawler
