// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/assembler.h>
#include <crawler/equation/end_power.h>
#include <crawler/equation/position_form.h>
#include <crawler/equation/stretch_form.h>
#include <crawler/lanes/lane_stepper.h>
#include <crawler/mesh/mesh_marking.h>
#include <crawler/output/observer.h>
#include <crawler/run/numerics.h>
#include <crawler/run/output_times.h>
#include <crawler/run/recorder.h>
#include <crawler/run/run_journal.h>
#include <crawler/run/state_velocity.h>
#include <crawler/run/step_limiter.h>
#include <crawler/time/petsc_stepper.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /**
   * One crawler: builds mesh, equation and time integration in this order, connects them, and changes the mesh on the
   * way where requested. Computes in natural units (scene.h); inputs and results are in the scene's. Can run several
   * times, which reuses everything as long as the mesh did not change.
   */
  class Simulation
  {
  public:
    using GaitWish  = crawler::GaitWish;
    using Options   = RecordOptions;
    using Observers = std::vector<std::unique_ptr<Observer>>;

    Simulation(MPI_Comm communicator, const Scene &scene, const TimeParameters &time, const Numerics &numerics);
    ~Simulation();

    /// Runs from rest. On request it ends when its cycles repeat (cycle_stop.h); the result is that of the end time all
    /// the same. @p pictures: what observers see besides the ends of steps. @p keep_going is asked after every step;
    /// runs in its journal are not computed again, and the journal gets the states and the result of this one.
    SimulationResult
    run(const PictureTimes &pictures,
        const Options &options,
        const Observers &observers  = {},
        const KeepGoing &keep_going = {});

    /// Present mesh, of length 1.
    const Discretization &
    discretization() const
    {
      return mesh_.assembler->discretization();
    }
    const Units &
    units() const
    {
      return units_;
    }

  private:
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
      std::unique_ptr<EndPower> end_power; ///< created once it is needed
      bool is_first = false;               ///< the mesh is that of the start
    };

    /// Time integrators; built when they are needed.
    struct Integrators
    {
      std::unique_ptr<PetscStepper> petsc;
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

    /// Diagnosis that replaces the time stepper's account of the end.
    struct Diagnosis
    {
      Status status;
      std::string reason, message;
    };

    /// State of one run().
    struct Run
    {
      Options options;
      const Observers &observers;
      const KeepGoing &keep_going;
      RunJournal *journal; ///< null if there is none
      Recorder recorder;
      OutputTimes output_times;
      StepLimiter limiter;
      Accepted accepted = {};
      StretchRange stretch{};     ///< range of the state under examination
      std::vector<double> breaks; ///< breaks in space
      CellIntegrals integrals{};
      bool lane_samples            = false; ///< the extremes and rates that they see in the stages of steps are used
      bool lanes_gave_up           = false;
      RateQuadrature quadrature    = {}; ///< quadrature of works
      EnergyBalance balance_before = {}; ///< energy balance at the start of the latest step
      Resolution largest{};              ///< largest over time, if computed
      TimeOutcome before{};              ///< counts of the parts of the run before the last change of mesh
      Step latest{};                     ///< last step that was tried, with the counts of the whole run
      std::optional<Diagnosis> diagnosis = {};
      unsigned int tiny_steps            = 0;
      std::vector<CellChange> changes    = {};
      std::vector<double> indicators     = {};    ///< indicators of all cells of an adaptive mesh, at present
      unsigned long n_failures           = 0;     ///< failures of the active stress before this run
      double part_start                  = 0.;    ///< time at which the present integrator has started
      bool goes_on                       = false; ///< continues within a part that was left
    };

    void
    build_first();
    void
    build(std::unique_ptr<Discretization> discretization);
    bool
    is_adaptive() const
    {
      return numerics_.mesh.tolerance > 0.;
    }
    bool
    lanes_fit() const;
    void
    choose_stepper();
    void
    go_on_with_petsc(const TimeOutcome &outcome);
    void
    count_part(const TimeOutcome &outcome);
    void
    begin_segment();
    void
    change();
    void
    balance_state();
    bool
    stress_failed();
    Ending
    see(const Step &step, std::span<const double> y);
    Ending
    ending_after(const Step &step, std::span<const double> y);
    Ending
    examine(const Step &step, std::span<const double> y);
    bool
    finds_velocity(double t, double size, std::span<const double> y, std::vector<double> &v);
    void
    explain_no_velocity(double t);
    void
    look_at_resolution(const Step &step, std::span<const double> y);
    bool
    stagnates(const Step &step);
    bool
    mesh_is_good(const Step &step, std::span<const double> y);
    bool
    compute_integrals(const Step &step, std::span<const double> y);
    Rates
    rates(double t, const CellIntegrals &sums, std::span<const double> y, std::span<const double> v);
    bool
    integrate_step(const Step &step, const Rates &at_end);
    bool
    can_sample_lanes() const;
    bool
    samples_lanes(const Step &step) const;
    StretchRange
    stretch_of_lanes() const;
    void
    see_stretch_of_lanes(unsigned int i);
    void
    take_stage_of_lanes(const Step &step, unsigned int i);
    void
    sample_lanes(const Step &step);
    void
    keep_history(const Step &step, std::span<const double> y);
    void
    look_at_extremes(double t, const StretchRange &range);
    bool
    wants_coarser_mesh(const Step &step);
    double
    lost_stretch() const;
    bool
    end_inverts(double from, double to);
    void
    locate_inversion(const Step &step);
    void
    explain_failure();
    bool
    law_failed();
    void
    inverted_at_end(double s, double t, const std::string &reason);
    void
    inverted_inside(double value, double s, double t);
    void
    under_resolved(double value, double s, double t);
    TimeOutcome
    integrate();
    Ending
    integrate_part();
    Ending
    look_at(const Step &part, const Step &step);
    Step
    with_counts_before(Step step) const;
    TimeOutcome
    outcome_of_parts() const;
    bool
    goes_on_after(Ending ending, TimeOutcome &outcome);
    TimeOutcome
    failure_while_integrating();
    std::string
    identity(const Options &options, bool has_pictures) const;
    void
    exchange(Archive &archive);
    void
    exchange_mesh(Archive &archive);
    std::string
    together(const Archive &own) const;
    std::string
    own_part(const std::string &together) const;
    void
    take_up();
    void
    keep_state(bool stops, const Step &step);
    SimulationResult
    finish();
    /// State that observers see.
    struct Shown
    {
      const Step &step; ///< with the time of the state
      std::span<const double> y, v;
      const CellIntegrals &integrals;
      const StretchRange &stretch;
      const EnergyBalance &energy_balance;
      bool is_step_end;
      const PictureTimes::Time *picture; ///< null if the state is none
    };
    void
    show_step(const Step &step, std::span<const double> y);
    bool
    show_pictures_within(const Step &step, double until);
    void
    show_pictures_before_inversion(const Step &step);
    void
    show_row_after_jump();
    void
    show(const Shown &shown);
    SimulationResult &
    result()
    {
      return run_->recorder.result;
    }

    const Scene &physical_scene_;
    const Units units_;
    TimeSegments segments_;
    const Scene scene_;       ///< in natural units
    const Numerics numerics_; ///< in natural units
    TimeParameters time_;     ///< in natural units
    const MPI_Comm communicator_;

    OnMesh mesh_;
    unsigned int mesh_number_ = 0;
    Integrators integrators_;
    Past past_;
    std::optional<Run> run_;
    std::vector<double> y_, v_;               ///< the present state and its velocity
    std::vector<double> y_inside_, v_inside_; ///< state within a step
  };
} // namespace crawler
