// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/assembler.h>
#include <crawler/equation/end_power.h>
#include <crawler/equation/position_form.h>
#include <crawler/equation/stretch_form.h>
#include <crawler/lanes/lane_stepper.h>
#include <crawler/mesh/mesh_marking.h>
#include <crawler/output/observer.h>
#include <crawler/run/output_times.h>
#include <crawler/run/recorder.h>
#include <crawler/run/run_journal.h>
#include <crawler/run/state_velocity.h>
#include <crawler/run/step_limiter.h>
#include <crawler/time/petsc_stepper.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Parts of a Simulation's state (simulation.h).
namespace crawler::simulation_parts
{
  /// Reason why a part of a run ends.
  enum class Ending
  {
    none,    ///< no end yet
    stepper, ///< no other step: end time reached, or the integration failed
    lost,    ///< the state must not be used, and the diagnosis says why
    cycles,  ///< cycles repeat
    stopped, ///< on request
    mesh,    ///< the mesh has to be changed
    retry,   ///< the active stress had an event within the step
    jump     ///< the active stress jumps
  };

  /// Equation on the present mesh.
  struct OnMesh
  {
    std::unique_ptr<Discretization> discretization;
    std::unique_ptr<Assembler> assembler;
    PositionForm *position = nullptr; ///< the assembler, if it has this form
    StretchForm *stretch   = nullptr;
    std::unique_ptr<StateVelocity> velocity;
    std::unique_ptr<EndPower> end_power;
    bool is_first = false; ///< the mesh is that of the start
    // Of an adaptive mesh:
    std::vector<double> indicators;  ///< indicators of all cells for the latest state
    std::vector<CellChange> changes; ///< changes that are wanted
  };

  /// Time integrators; built when they are needed.
  struct Integrators
  {
    std::unique_ptr<Stepper> petsc;
    std::unique_ptr<LaneStepper> lanes;
    Stepper *present = nullptr; ///< one of them
  };

  /// Past of the body, for a feedback with delay.
  struct Past
  {
    double delay = 0.; ///< 0: the feedback does not see it
    StretchHistory history;
    std::shared_ptr<const std::vector<Cell>> cells; ///< cells of the present mesh
  };

  /// State and its velocity.
  struct State
  {
    std::vector<double> y, v;
  };

  /// Last accepted state, to which a change of mesh may go back.
  struct Accepted
  {
    std::vector<double> y;
    double time = 0., next_step = 0.;
    bool is_there = false;

    void
    exchange(Archive &archive)
    {
      archive(y, time, next_step, is_there);
    }
  };

  /// Numbers of the state that a step has reached, in natural units.
  inline StateNumbers
  numbers_of(const Step &step, const CellIntegrals &sums, const StretchRange &stretch, const EnergyBalance &energies)
  {
    return {step, sums.displacement, stretch, sums.velocity, energies, sums.net_friction};
  }

  /// Diagnosis that replaces the time stepper's account of the end.
  struct Diagnosis
  {
    Status status;
    std::string reason, message;
  };

  /// State of one run().
  struct Run
  {
    RecordOptions options;
    const Observers &observers;
    const KeepGoing &keep_going;
    RunJournal *journal; ///< null if there is none
    Recorder recorder;
    OutputTimes output_times;
    StepLimiter limiter;
    Accepted accepted = {};
    StateNumbers state{}; ///< numbers of the state under examination; its step has the counts of the whole run
    bool lanes_gave_up        = false;
    RateQuadrature quadrature = {}; ///< quadrature of works
    TimeOutcome before{};           ///< counts and end of the parts of the run before the present one
    std::optional<Diagnosis> diagnosis = {};
    unsigned int tiny_steps            = 0;
    unsigned long n_failures           = 0; ///< failures of the active stress before this run
  };
} // namespace crawler::simulation_parts
