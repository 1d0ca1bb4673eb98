// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/compute.h>

#include <vector>

namespace crawler
{
  /**
   * Computes scenes that are similar, as neighbours on an axis of a sweep, with one choice of the numerics for all: the
   * finest of those that `crawler run` would choose for the first, the middle and the last of them. Runs and the finer
   * runs that measure their errors share the lanes of the fused engine, so a point costs a hundredth of what it costs
   * alone. Each answer has an error bound as always; what does not meet its Accuracy with these numerics, or does not
   * fit the fused engine, is left alone.
   *
   * @p wanted: which tasks to compute, as many as @p tasks; the others are there for the choice of the numerics only,
   * so that an answer does not depend on which are wanted. Returns which have been computed. Nothing is thrown. Runs
   * are given up when @p interrupted says so, and after @p time_limit [s] for all together, so that none takes longer.
   */
  std::vector<bool>
  compute_similar(std::span<Task> tasks,
                  const std::vector<bool> &wanted,
                  double time_limit,
                  const std::function<bool()> &interrupted);
} // namespace crawler
