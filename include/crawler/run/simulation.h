// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/equation/assembler.h>
#include <crawler/equation/end_power.h>
#include <crawler/equation/position_form.h>
#include <crawler/equation/stretch_form.h>
#include <crawler/lanes/lane_stepper.h>
#include <crawler/lanes/linear_stepper.h>
#include <crawler/mesh/mesh_marking.h>
#include <crawler/output/observer.h>
#include <crawler/run/cycle_stop.h>
#include <crawler/run/numerics.h>
#include <crawler/run/simulation_result.h>
#include <crawler/run/stress_watch.h>
#include <crawler/time/time_stepper.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /**
   * One crawler: builds mesh, equation and time integration in this order, connects them, and changes the mesh
   * on the way where that is asked for. It computes in natural units (scene.h); what goes in and comes out
   * is in the scene's. It can run several times; that reuses everything as long as the mesh did not change.
   */
  class Simulation
  {
  public:
    /// Of the last stride (SimulationResult::gait): none, if the active stress says how long it is, or in any case.
    enum class GaitWish
    {
      none,
      declared,
      any
    };
    /// What is computed at each accepted step besides the state.
    struct Options
    {
      bool energy_balance             = false; ///< works, energies, net friction
      bool resolution                 = false; ///< SimulationResult::unresolved
      std::optional<CycleWish> cycles = {};    ///< end the run when its cycles repeat; not with output times
      GaitWish gait                   = GaitWish::none;
    };

    Simulation(MPI_Comm communicator, const Scene &scene, const TimeParameters &time, const Numerics &numerics);
    ~Simulation();

    /// Runs from rest. If that is wished it ends when its cycles repeat (cycle_stop.h); the result is that of the end
    /// time all the same. @p output_times are times in (0, T] where steps must end. @p keep_going is asked after every
    /// step.
    SimulationResult
    run(const std::vector<double> &output_times,
        const Options &options,
        const std::vector<std::unique_ptr<Observer>> &observers = {},
        const std::function<bool()> &keep_going                 = {});

    /// The present mesh, of length 1.
    const Discretization &
    discretization() const
    {
      return assembler_->discretization();
    }
    const Units &
    units() const
    {
      return units_;
    }

  private:
    /// Why a run is interrupted.
    enum class Request
    {
      none,
      mesh,   ///< change the mesh by changes_
      retry,  ///< the active stress did something within the step
      restart ///< the active stress jumps
    };

    void
    build_first();
    void
    build(std::unique_ptr<Discretization> discretization);
    bool
    lanes_fit() const;
    void
    choose_stepper();
    void
    build_linear_stepper();
    void
    build_lane_stepper();
    void
    build_petsc_stepper();
    void
    go_on_with_petsc(const TimeOutcome &outcome);
    void
    count_part(const TimeOutcome &outcome);
    void
    begin_segment();
    std::vector<double>
    output_times_of_segment();
    void
    change();
    void
    settle();
    bool
    stress_failed();
    bool
    examine(const Step &step, std::span<const double> y);
    bool
    keeps_rate() const;
    bool
    velocity(double t, double size, std::span<const double> y, std::vector<double> &v);
    void
    keep_rate(double t, std::span<const double> y_dot);
    bool
    mesh_is_good(const Step &step, std::span<const double> y);
    double
    longest_step(double t) const;
    bool
    passed_over_event(const Step &step);
    bool
    cycle_repeats(const Step &step, std::span<const double> y);
    void
    prepare_gait();
    void
    watch_gait(const Step &step, std::span<const double> y);
    bool
    compute_integrals(const Step &step, std::span<const double> y);
    RateQuadrature::Rates
    rates(double t, const CellIntegrals &sums, std::span<const double> y, std::span<const double> v);
    RateQuadrature::Rates
    integrate_step(const Step &step, const RateQuadrature::Rates &at_end);
    void
    keep_history(const Step &step, std::span<const double> y);
    void
    look_at_extremes(double t, const StretchRange &range, bool is_first);
    void
    look_for_coarser_mesh(const Step &step);
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
    integrate(const std::vector<std::unique_ptr<Observer>> &observers, const std::function<bool()> &keep_going);
    TimeOutcome
    failure_while_integrating();
    void
    show(const Step &step, std::span<const double> y, const std::vector<std::unique_ptr<Observer>> &observers);
    double
    physical_time(const Step &step) const;
    SimulationResult
    in_physical_units() const;

    const Scene &physical_scene_;
    const Units units_;
    TimeSegments pieces_;
    const Scene scene_;                  ///< in natural units
    const Numerics numerics_;            ///< in natural units
    TimeParameters time_;                ///< in natural units
    std::vector<StepLimit> step_limits_; ///< of adaptive steps, in natural units
    const MPI_Comm communicator_;

    std::unique_ptr<Discretization> discretization_;
    std::unique_ptr<Assembler> assembler_;
    std::unique_ptr<EndPower> end_power_; ///< once it is needed
    PositionForm *position_    = nullptr; ///< the assembler, if the form is that
    StretchForm *stretch_form_ = nullptr;
    // Who integrates; built when they are needed.
    std::unique_ptr<TimeStepper> petsc_stepper_;
    std::unique_ptr<LaneStepper> lane_stepper_;
    std::unique_ptr<LinearStepper> linear_stepper_;
    TimeIntegration *stepper_ = nullptr; ///< one of them
    bool lanes_gave_up_       = false;
    bool as_at_start_         = false; ///< the mesh is that of the start

    // The state of one run().
    struct Diagnosis
    {
      std::string status, reason, message;
    };

    Options options_;
    bool has_observers_ = false;
    SimulationResult result_;
    std::optional<Diagnosis> diagnosis_; ///< replaces what the time stepper says
    Request request_ = Request::none;
    std::vector<CellChange> changes_;
    std::vector<double> indicators_; ///< of all cells, for the present state of an adaptive mesh
    RateQuadrature quadrature_;
    Resolution largest_{}; ///< over time, if looked at
    CellIntegrals integrals_;
    double largest_friction_ = 0., largest_net_friction_ = 0.; ///< over time, int |g v| ds and |int g v ds|
    StretchRange stretch_;
    ExtremeHistory min_history_{ExtremeHistory::smallest}, max_history_{ExtremeHistory::largest};
    std::vector<double> y_, v_;
    std::vector<double> y_inside_, v_inside_; ///< of a state within a step
    struct Rate
    {
      double time = -1.;
      std::vector<double> y_dot;
    };
    std::vector<Rate> rates_;           ///< of the latest residuals, where they are kept
    double relaxation_time_ = HUGE_VAL; ///< of the present mesh, at least
    double delay_           = 0.;       ///< of the feedback [natural units]; 0: it does not see the past
    StretchHistory history_;
    std::shared_ptr<const std::vector<Cell>> history_cells_; ///< of the present mesh
    // The last state that was accepted, to which a change of mesh may go back.
    std::vector<double> accepted_;
    double accepted_time_ = 0., next_step_ = 0.;
    TimeOutcome before_;               ///< counts of the parts of the run before the last change of mesh
    Step latest_{};                    ///< that was tried, with the counts of the whole run
    std::vector<double> output_times_; ///< in physical units
    std::size_t next_output_time_ = 0;
    bool ends_at_output_time_     = false; ///< does the present piece?
    std::optional<CycleStop> cycle_stop_;
    std::optional<GaitMeter> gait_meter_;
    std::optional<StressWatch> watch_;
    std::optional<double> hidden_output_time_; ///< one of output_times_ that nobody has asked for
    unsigned int mesh_number_ = 0, tiny_steps_ = 0;
    unsigned long n_failures_ = 0;     ///< of the active stress before this run
    bool started_             = false; ///< a state has been accepted
  };
} // namespace crawler
