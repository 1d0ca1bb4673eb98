// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/model_choice.h>
#include <crawler/accuracy/numerics_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/stop_signal.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/run/run_checkpoint.h>
#include <crawler/studies/run/run_stops.h>

#include <mpi.h>

#include <memory>
#include <optional>

namespace crawler
{
  /// `crawler run`, from the parameter file to the files and the exit code (all functions are collective). An exception
  /// in a part of the computation becomes the end of the run, with all files of an end.
  class RunStudy
  {
  public:
    RunStudy(MPI_Comm communicator, const CommandOptions &options, ParameterFile file);

    ExitCode
    run();

  private:
    /// Division of the work: either all ranks share the cells, or each computes the whole body and the first one
    /// writes.
    struct Sharing
    {
      bool is_shared  = false;
      MPI_Comm ranks  = MPI_COMM_SELF; ///< ranks that compute together
      bool has_output = false;         ///< true if this rank takes part in writing
    };

    // Steps before the files exist.
    bool
    begin();
    void
    choose_level();
    void
    choose_mesh_and_steps();
    void
    build(const NumericsChoice &choice);
    void
    begin_output();

    // Computation without or with a mesh.
    void
    compute_without_mesh();
    void
    compute_on_mesh();
    SimulationResult
    simulate(const NumericsChoice &choice);
    void
    announce_next_try(const NumericsChoice &choice);
    Simulation::Observers
    observers();

    // Steps at the end.
    ExitCode
    finish();
    void
    name_stop();
    void
    add_what_follows();
    void
    write_summary();
    void
    leave_folder();

    bool
    is_stopped();
    void
    stop(const std::string &when);
    template <typename Work>
    void
    guarded(const Work &work);
    bool
    keep_states(const std::string &all);

    const StopSignal stop_signal_; ///< ends the run in an orderly way when a signal arrives
    const double begin_;
    const MPI_Comm communicator_;
    const CommandOptions &options_;
    const bool is_first_;
    Log log_;
    Input input_;
    const std::filesystem::path folder_;
    std::optional<FolderLock> lock_;
    RunCheckpoint checkpoint_;
    bool goes_on_ = false, has_files_ = false;
    RunJournal journal_;
    RunStops stops_;

    std::optional<ModelChoice> model_;
    std::optional<NumericsChoice> choice_; ///< numerics of a level with a mesh
    Sharing sharing_;
    PictureTimes pictures_;
    std::optional<Scene> scene_with_fronts_;
    std::unique_ptr<Simulation> simulation_;
    std::optional<WaitProgress> other_runs_; ///< progress of runs without one of their own
    unsigned int n_runs_ = 0;
    SimulationResult result_;
  };
} // namespace crawler
