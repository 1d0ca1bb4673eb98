// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "run_text.h"

#include <crawler/run/batch.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace crawler::test
{
  /// Inputs of a run. The object cannot be moved, since others point to it.
  struct LaneRun
  {
    Parameters parameters;
    Scene scene;
    Numerics numerics;

    LaneRun(const Settings &settings, const std::string &integrator, const Numerics &chosen)
      : parameters(parameters_with(settings))
      , numerics(chosen)
    {
      parameters.time.integrator = integrator;
      scene                      = parameters.create_scene();
    }
    LaneRun(const LaneRun &) = delete;

    BatchRun
    entry() const
    {
      return {&scene, &parameters.time, &numerics};
    }

    /// Runs a Simulation, on the fused engine or on PETSc.
    SimulationResult
    simulate(const Engine engine, const RecordOptions &options = {.energy_balance = true}) const
    {
      TimeParameters time = parameters.time;
      time.engine         = engine;
      return Simulation(MPI_COMM_WORLD, scene, time, numerics).run({}, options);
    }
  };
  using LaneRuns = std::vector<std::unique_ptr<LaneRun>>;

  inline std::vector<BatchRun>
  entries(const LaneRuns &runs)
  {
    std::vector<BatchRun> result;
    for (const auto &run : runs)
      result.push_back(run->entry());
    return result;
  }

  /// Computes one run alone in a batch.
  inline std::optional<SimulationResult>
  run_alone(const LaneRun &run,
            const RecordOptions &options = {.energy_balance = true},
            const LaneEngine &engine     = batch_engine())
  {
    const std::array<BatchRun, 1> only = {{run.entry()}};
    return run_batch(only, options, {}, engine).front();
  }

  /// Engines that this processor supports.
  inline std::vector<const LaneEngine *>
  batch_engines()
  {
    std::vector<const LaneEngine *> result;
    for (const char *name : {"baseline", "avx2", "avx512"})
      if (const LaneEngine *engine = batch_engine(name))
        result.push_back(engine);
    return result;
  }

  /// Settings of an active stress by a formula, friction exponent @p a.
  inline Settings
  expression(const double a, const std::string &formula, const double end_time = 1., const double k = 1.)
  {
    return set("p = {}; k = {}; T = {}; expression; Active stress = {}", 1. - a, k, end_time, formula);
  }

  /// Numbers of a result except the seconds.
  inline std::vector<double>
  numbers_of(const SimulationResult &r)
  {
    std::vector<double> result = {r.time.time,
                                  r.time.step_size,
                                  static_cast<double>(r.time.steps),
                                  static_cast<double>(r.time.rejected_steps),
                                  static_cast<double>(r.time.newton_iterations),
                                  r.displacement,
                                  r.size.largest_u,
                                  r.size.unresolved(),
                                  r.size.strain,
                                  r.residuals.net_friction,
                                  r.stretch.min.value,
                                  r.stretch.min.s,
                                  r.stretch.min.t,
                                  r.stretch.max.value,
                                  r.stretch.max.s,
                                  r.stretch.max.t,
                                  static_cast<double>(r.process.mesh.changes),
                                  static_cast<double>(r.process.mesh.most_cells),
                                  r.size.largest_indicator};
    if (r.energy_balance)
      for (double EnergyBalance::*energy : EnergyBalance::energies())
        result.push_back((*r.energy_balance).*energy);
    return result;
  }

  inline std::vector<double>
  numbers_of(const Gait &gait)
  {
    std::vector<double> result = {gait.period, gait.n_strides, gait.displacement, gait.length};
    if (gait.wave)
      result.insert(result.end(), {gait.wave->speed, gait.wave->coherence});
    if (gait.energy_balance)
      for (double EnergyBalance::*energy : EnergyBalance::energies())
        result.push_back((*gait.energy_balance).*energy);
    return result;
  }

  /// True if equal to the last bit, including signs of zeros and NaN.
  inline bool
  same_bits(const std::vector<double> &a, const std::vector<double> &b)
  {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  }

  inline bool
  same_bits(const std::optional<SimulationResult> &a, const std::optional<SimulationResult> &b)
  {
    return a.has_value() == b.has_value() &&
           (!a || (a->time.status == b->time.status && a->inversion.has_value() == b->inversion.has_value() &&
                   same_bits(numbers_of(*a), numbers_of(*b)) && a->gait.has_value() == b->gait.has_value() &&
                   (!a->gait || same_bits(numbers_of(*a->gait), numbers_of(*b->gait)))));
  }
} // namespace crawler::test
