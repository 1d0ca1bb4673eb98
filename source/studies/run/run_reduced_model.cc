// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_signal.h>
#include <crawler/equation/crawler_equation.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/output/vtu_writer.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/run/summary.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/run_files.h>
#include <crawler/studies/run/run_reduced_model.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

namespace crawler
{
  namespace
  {
    /// The fields of a state in the user's units, at @p points in natural ones.
    Fields
    physical_fields(const ReducedFields &state,
                    const std::vector<double> &points,
                    const Scene &scene,
                    const Units &units)
    {
      const std::size_t n = points.size();
      Fields fields;
      fields.active_stress = state.active_stress;
      fields.velocity      = state.velocity;
      fields.friction_force.resize(n);
      for (std::size_t i = 0; i < n; ++i)
      {
        fields.displacement.push_back(state.displacement[i] * units.length);
        fields.position.push_back(points[i] * units.length + fields.displacement[i]);
        fields.stretch.push_back(1. + state.strain[i]);
        fields.elastic_stress.push_back(units.force *
                                        equation::body_force(state.strain[i], 0., scene.body.elastic_modulus));
        fields.active_stress[i] *= units.force;
        fields.velocity[i] *= units.velocity();
      }
      scene.friction->values(fields.stretch, fields.friction_force);
      for (std::size_t i = 0; i < n; ++i)
        fields.friction_force[i] =
          equation::friction_force(fields.friction_force[i], state.velocity[i]) * units.force / units.length;
      return fields;
    }

    std::vector<double>
    equidistant(const unsigned int n)
    {
      std::vector<double> points(n);
      for (unsigned int i = 0; i < n; ++i)
        points[i] = static_cast<double>(i) / (n - 1);
      return points;
    }

    /// Writes the output times of a level as a run with a mesh does, at equidistant points: one cell, the whole body.
    bool
    write_pictures(const ReducedModel &level,
                   const Input &input,
                   const std::filesystem::path &folder,
                   const StopSignal &signal)
    {
      const OutputParameters &output = input.parameters.output;
      const Units &units             = level.reduced_scene().units();
      const auto points              = equidistant(KymographWriter::n_points);
      // Without snapshots the table alone has its rows as often as there would be snapshots by default.
      const unsigned int n = output.n_snapshots > 0 ? output.n_snapshots : OutputParameters().n_snapshots;
      VtuWriter pictures(folder);
      KymographWriter kymograph(input.scene.end_time, folder);
      std::optional<StatisticsWriter> statistics;
      if (output.statistics)
        statistics.emplace(input.scene.body.length, true, folder, output.energy_balance);
      unsigned int number = 0;
      bool stopped        = false;
      level.replay(equidistant(n + 1), points, [&](const double t, const ReducedModel::State &state) {
        const double time = number == n ? input.scene.end_time : input.scene.end_time * number / n;
        const Step step{time, number == 0 ? 0. : input.scene.end_time / n, number, true, 0, 0};
        const Fields fields = physical_fields(state.fields, points, level.reduced_scene().scene(), units);
        if (output.n_snapshots > 0)
        {
          pictures.write(
            time, number, {{0., units.length}}, static_cast<unsigned int>(points.size()), fields, MPI_COMM_SELF);
          kymograph.add(time, fields);
        }
        const auto stretch_at = [&](const StrainExtreme &e) { return StretchAt{1. + e.strain, e.s * units.length}; };
        if (statistics)
          statistics->write({step,
                             state.displacement * units.length,
                             {stretch_at(state.smallest), stretch_at(state.largest)},
                             state.velocity * units.velocity(),
                             state.energies.scaled(units.energy()),
                             state.net_friction * units.force});
        ++number;
        stopped = signal.arrived_anywhere(MPI_COMM_SELF);
        return !stopped && t <= 1.;
      });
      if (statistics)
        statistics->end();
      if (output.n_snapshots > 0 && output.kymograph)
        kymograph.end();
      return !stopped;
    }
  } // namespace

  ExitCode
  run_reduced_model(MPI_Comm communicator,
                    const CommandOptions &options,
                    const Input &input,
                    const ModelChoice &choice,
                    const StopSignal &stop_signal,
                    const std::chrono::steady_clock::time_point start,
                    Log &log)
  {
    const OutputParameters &output = input.parameters.output;
    const auto folder              = output_folder(options.output, options.file);
    int code                       = 0;
    on_first_rank(communicator, [&]() {
      using Clock             = std::chrono::steady_clock;
      const auto seconds_from = [](const Clock::time_point from) {
        return std::chrono::duration<double>(Clock::now() - from).count();
      };
      begin_files(log, input, folder);
      report_scene(log, input);
      log.line(choice.explanation);

      Parameters parameters = input.parameters;
      parameters.model      = choice.model;
      const double setup    = seconds_from(start);
      SimulationResult result;
      result.model = choice.model;
      try
      {
        ReducedModel level(input.scene, choice.model);
        result = level.compute(
          parameters.accuracy, output.energy_balance, [&]() { return !stop_signal.arrived_anywhere(MPI_COMM_SELF); });
        result.setup_seconds = setup;
        level.describe_gait(result);
        if (std::isfinite(result.net_friction)) // the series has no balance to check
          check_identities(result, parameters);
        log.line(level.description());

        const auto before = Clock::now();
        if (result.error && (output.n_snapshots > 0 || output.statistics) &&
            !write_pictures(level, input, folder, stop_signal))
          result.time.status = "stopped";
        result.output_seconds = seconds_from(before);
      }
      catch (...)
      {
        result.time = failure_of(std::current_exception());
      }
      if (result.time.status == "stopped")
      {
        result.time.reason  = "signal";
        result.time.message = "stopped by a signal";
      }
      write_file(folder / "summary.json", summary_json(result, size_of(communicator), options.command_line));
      code = static_cast<int>(report_end(log, result, folder, output.n_snapshots > 0 && result.error));
      return "";
    });
    MPI_Bcast(&code, 1, MPI_INT, 0, communicator);
    return static_cast<ExitCode>(code);
  }

  ExitCode
  check_reduced_model(const Input &input, const ModelChoice &choice, Log &log)
  {
    report_scene(log, input);
    log.line(choice.explanation);
    log.line("No mesh and no time steps are needed.");
    log.line(input.file.name() + " is in order; nothing was run, and nothing was written.");
    return ExitCode::finished;
  }
} // namespace crawler
