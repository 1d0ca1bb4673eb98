// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/numerics_choice.h>
#include <crawler/drivers/parameters.h>
#include <crawler/drivers/simulation.h>

#include <exception>
#include <functional>
#include <optional>
#include <span>

namespace crawler
{
  /// One run without files.
  struct Computed
  {
    SimulationResult result;
    NumericsChoice choice;
  };

  /**
   * What `crawler run` computes for @p scene (made from @p parameters), on this rank alone and without files: choice of
   * the numerics, simulation, self-check. @p keep_going is asked after every step, those of
   * pilot runs too; if it stops one of these, the status is "stopped" and nothing else is known.
   */
  Computed
  compute(const Parameters &parameters, const Scene &scene, const std::function<bool()> &keep_going);

  /// One of many runs: a scene to compute, and what came of it.
  struct Task
  {
    Parameters parameters;
    std::optional<Scene> scene;
    Computed computed;
    std::exception_ptr error;    ///< what was thrown instead
    double seconds      = 0.;    ///< that it took; runs of a batch share its time
    bool is_out_of_time = false; ///< stopped by the time limit
  };

  /**
   * What compute() gives for all @p tasks, whose parameters alone are given, on this rank. Runs that fit share the
   * lanes of the fused engine (drivers/batch.h), where an answer does not depend on its neighbours; the others,
   * those that the engine gives up, and long ones that may end when their cycles repeat, follow one by one. A batch
   * computes all cycles, so its answers differ from those of compute() by errors within Accuracy. Nothing is thrown. No
   * run takes longer than @p time_limit [s].
   */
  void
  compute_all(std::span<Task> tasks, double time_limit, const std::function<bool()> &interrupted);
} // namespace crawler
