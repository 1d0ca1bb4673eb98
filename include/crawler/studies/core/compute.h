// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/shared_choice.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/core/parameters.h>

#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// One run without files.
  struct Computed
  {
    SimulationResult result;
    NumericsChoice choice;
  };

  /// One of many runs: a scene to compute, and what came of it.
  struct Task
  {
    Parameters parameters;
    /// Of interest is the last stride, too, if the active stress says how long it is; the same for all tasks of a call.
    bool gait = false;
    std::optional<Scene> scene;
    Computed computed;
    std::exception_ptr error;    ///< what was thrown instead
    double seconds      = 0.;    ///< that it took; runs of a batch share its time
    bool is_out_of_time = false; ///< stopped by the time limit
  };

  /**
   * What `crawler run` computes for each of @p tasks, whose parameters alone are given, on this rank alone and without
   * files: choice of the numerics, simulation, self-check. Runs that fit share the lanes of the fused engine
   * (run/batch.h), where an answer does not depend on its neighbours and all cycles are computed; the others,
   * those that the engine gives up, and long ones that may end when their cycles repeat, follow one by one. Nothing is
   * thrown. No run takes longer than @p time_limit [s], and @p interrupted is asked after every step, those of pilot
   * runs too; if a pilot is stopped, the status is "stopped" and nothing else is known.
   */
  void
  compute_all(std::span<Task> tasks, double time_limit, const std::function<bool()> &interrupted);

  /// The numerics that similar scenes share (accuracy/shared_choice.h), as measured on some @p examples of them;
  /// nothing if there are none.
  std::optional<SharedChoice>
  shared_numerics(std::span<Task> examples, const std::function<bool()> &keep_going);

  /**
   * Computes scenes with the numerics that they share. Runs and the finer runs that measure their errors share the
   * lanes of the fused engine, so a point costs a hundredth of what it costs alone. Each answer has an error bound as
   * always; what does not meet its Accuracy with these numerics, or does not fit the fused engine, is left alone.
   * @p sizes: about what each displacement is [length].
   *
   * Returns which have been computed. Nothing is thrown. Runs are given up when @p interrupted says so, and after
   * @p time_limit [s] for all together, so that none takes longer.
   */
  std::vector<bool>
  compute_similar(std::span<Task> tasks,
                  const SharedChoice &shared,
                  const std::vector<double> &sizes,
                  double time_limit,
                  const std::function<bool()> &interrupted);
} // namespace crawler
