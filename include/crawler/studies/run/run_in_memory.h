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

  /// Results of a run without files.
  struct RunInMemory
  {
    SimulationResult result;
    std::unique_ptr<Kymograph> kymograph;   ///< null if it is not wanted, or if the run broke off before
    std::unique_ptr<Statistics> statistics; ///< null in the same cases
    std::vector<std::string> notes = {};    ///< notes_on_choice()
    std::optional<NumericsChoice> numerics; ///< those that were chosen or given, of a run on a mesh
  };

  /// Fields of a kymograph in place of those that the input asks for.
  struct WantedFields
  {
    std::optional<std::vector<double>> times = {};    ///< [time]; unset: those of the input
    std::vector<double> points               = {};    ///< positions, as parts of the length, increasing
    bool is_all                              = false; ///< nothing else is wanted: no gait
    std::optional<NumericsChoice> numerics   = {};    ///< numerics that were chosen for a similar scene
  };

  /// Further computations on a finished run on a mesh.
  using Afterwards = std::function<void(const Input &input, const NumericsChoice &choice, SimulationResult &result)>;

  /**
   * Computes what `crawler run` does on one rank, with the same bits, and keeps in memory what that writes to files.
   * The kymograph has the fields @p wanted, if they are given. The @p input gets the level @p model. The end of a run
   * is its status; errors that the user has to mend are thrown. @p interrupted is called after every step. MPI and
   * PETSc must have been started unless the level needs no mesh.
   */
  RunInMemory
  run_in_memory(Input &input,
                const ModelChoice &model,
                WantedFields wanted,
                const std::function<bool()> &interrupted,
                const Afterwards &afterwards = {});
} // namespace crawler
