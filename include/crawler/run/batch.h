// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_tables.h>
#include <crawler/run/simulation.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Method of the fused engine for batches, which are in the position form.
  std::optional<LaneMethod>
  batch_method(const Scene &scene, const TimeParameters &time, const Numerics &numerics);

  /// Run of a batch. All pointers are the caller's.
  struct BatchRun
  {
    const Scene *scene;
    const TimeParameters *time;
    const Numerics *numerics;             ///< must have a batch_method()
    std::optional<CycleWish> cycles = {}; ///< request in place of that of the options
  };

  /**
   * Runs many bodies side by side by the fused engine. A result is that of Simulation::run() without observers and with
   * the same options, but for errors within the tolerance; nothing is returned for a run that the engine gives up or
   * that comes near an inversion, which is for a Simulation to compute. Results do not depend on which runs share a
   * batch. @p keep_going is asked after every step; if it says no, all runs under way are given up.
   */
  std::vector<std::optional<SimulationResult>>
  run_batch(std::span<const BatchRun> runs,
            const RecordOptions &options,
            const std::function<bool()> &keep_going = {},
            const LaneEngine &engine                = batch_engine());
} // namespace crawler
