// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/run/simulation_result.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/core/input.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class Kymograph;
  class Statistics;

  /// Time/Wall time limit [s], for the sentence that says what stopped a run.
  std::string
  wall_time_limit_in_words(double limit);

  /// Results of a run without files.
  struct RunInMemory
  {
    SimulationResult result;
    std::shared_ptr<Kymograph> kymograph;   ///< null if it is not wanted, or if the run broke off before
    std::shared_ptr<Statistics> statistics; ///< null in the same cases
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

  /**
   * Runs of a parameter file with other numbers, of which only the fields at some times and places are wanted, as a fit
   * compares them with data. The file is read once, and a run has no estimate of its error, no gait and no energies: it
   * takes a third of the time of a run in memory, or less if it has the numerics of a similar one.
   */
  class FieldRuns
  {
  public:
    /// @p paths: entries with other numbers. Throws InputError, as read_input() does.
    FieldRuns(ParameterFile file, std::vector<std::string> paths);
    FieldRuns(const FieldRuns &) = delete;

    /**
     * Run with other @p numbers, in the sequence of the entries. If @p is_similar it has the level and numerics of the
     * last run that was not, so that their differences are smooth; fields_wanted() is asked for the length of the body.
     * @p start is called before the first run on a mesh. Throws InputError.
     */
    RunInMemory
    run(const std::vector<double> &numbers,
        bool is_similar,
        const std::function<WantedFields(const Scene &)> &fields_wanted,
        const std::function<void()> &start,
        const std::function<bool()> &interrupted);

  private:
    const std::vector<std::string> paths_;
    Form form_;
    Input input_;
    std::optional<ModelChoice> model_; ///< of the last run that was not similar to another one
    std::optional<NumericsChoice> numerics_;
  };
} // namespace crawler
