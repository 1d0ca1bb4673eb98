// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/run/simulation_result.h>
#include <crawler/studies/core/input.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace crawler
{
  class Kymograph;
  class Statistics;

  /// What a run gives besides files.
  struct RunInMemory
  {
    SimulationResult result;
    std::unique_ptr<Kymograph> kymograph;   ///< null if it is not wanted, or if the run broke off before
    std::unique_ptr<Statistics> statistics; ///< the same
    std::vector<std::string> notes = {};    ///< notes_on_choice()
  };

  /// Which fields a kymograph is to have in place of those that the input asks for.
  struct WantedFields
  {
    std::vector<double> times;  ///< [time]
    std::vector<double> points; ///< parts of the length, increasing
  };

  /// What else is to be computed of a run on a mesh that has finished.
  using Afterwards = std::function<void(const Input &input, const NumericsChoice &choice, SimulationResult &result)>;

  /**
   * Computes what `crawler run` does on one rank, with the same bits, and keeps what that writes to files. The
   * kymograph has what is @p wanted, if that is said. How a run ends is its status; what
   * the user has to mend is thrown. @p interrupted is asked after every step. MPI and PETSc must have been started
   * unless the level needs no mesh.
   */
  RunInMemory
  run_in_memory(Input input,
                const ModelChoice &model,
                const std::optional<WantedFields> &wanted,
                const std::function<bool()> &interrupted,
                const Afterwards &afterwards = {});
} // namespace crawler
