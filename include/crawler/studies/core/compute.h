// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>
#include <crawler/accuracy/shared_choice.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/core/parameters.h>

#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// Task among many: a scene to compute, and its outcome.
  struct Task
  {
    Parameters parameters;
    /// True if the last stride is wanted, too, provided that the active stress gives its length; equal for all tasks of
    /// a call.
    bool gait = false;
    std::optional<Scene> scene;
    Answer computed;
    std::exception_ptr error;    ///< exception thrown instead of a result
    double seconds      = 0.;    ///< wall time [s]; runs of a batch share its time
    bool is_out_of_time = false; ///< stopped by the time limit
    bool has_answer     = false; ///< the answer was found in the lanes, and is as accurate as requested
  };

  /// Reason of a point that took longer than the time limit.
  inline const std::string time_limit_reason = "time_limit";

  /// Outcome of a task, in a word, and why.
  struct PointStatus
  {
    std::string status, reason, message;
  };
  /// Throws FileError, which ends a study.
  PointStatus
  status_of(const Task &task);

  /// Reason in words why a task has no answer; empty if it has one. Throws FileError.
  std::string
  problem_of(const Task &task);

  /**
   * Computes for each of @p tasks, of which only the parameters are given, what `crawler run` computes, on this rank
   * alone and without files: choice of the numerics, simulation, self-check. Runs that fit share the lanes of the fused
   * engine (run/batch.h), where an answer does not depend on its neighbours and all cycles are computed; the others,
   * those that the engine gives up, and long ones that may end when their cycles repeat, follow one by one. Nothing is
   * thrown. No run takes longer than @p time_limit [s]. @p interrupted is called after every step, also of pilot runs;
   * if a pilot run is stopped, the status is "stopped" and nothing else is known.
   */
  void
  compute_all(std::span<Task> tasks, double time_limit, const std::function<bool()> &interrupted);

  /// Numerics that similar scenes share (accuracy/shared_choice.h), as measured on some @p examples of them; nothing if
  /// there are none.
  std::optional<SharedChoice>
  shared_numerics(std::span<Task> examples, const std::function<bool()> &keep_going);

  /**
   * Computes scenes with the numerics that they share. Runs, and the finer runs that measure their errors, share the
   * lanes of the fused engine, so a point costs a hundredth of a run alone. Each answer has an error bound as always,
   * if errors are to be estimated; scenes that miss their Accuracy with these numerics, whose displacement is far below
   * its size in @p sizes (an estimate) [length], or that do not fit the fused engine, are left out.
   *
   * Returns true for each scene that has been computed. Nothing is thrown. All runs end when @p interrupted returns
   * true or when @p time_limit [s] has passed for all together, so that none takes longer.
   */
  std::vector<bool>
  compute_similar(std::span<Task> tasks,
                  const SharedChoice &shared,
                  const std::vector<double> &sizes,
                  double time_limit,
                  const std::function<bool()> &interrupted);
} // namespace crawler
