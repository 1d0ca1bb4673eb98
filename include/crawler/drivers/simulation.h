// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/discretization/assembler.h>
#include <crawler/discretization/graded_mesh.h>
#include <crawler/discretization/mesh_marking.h>
#include <crawler/discretization/position_form.h>
#include <crawler/discretization/stretch_form.h>
#include <crawler/drivers/cycle_stop.h>
#include <crawler/drivers/displacement_error.h>
#include <crawler/drivers/gait.h>
#include <crawler/drivers/number_errors.h>
#include <crawler/drivers/stress_watch.h>
#include <crawler/fused/fused_stepper.h>
#include <crawler/fused/linear_stepper.h>
#include <crawler/observers/observer.h>
#include <crawler/time/time_stepper.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// The numerical settings of one simulation; numerics_choice.h chooses those that the user leaves open.
  struct Numerics
  {
    unsigned int degree                = 0;
    unsigned int n_cells               = 0;  ///< of the first mesh
    double tolerance                   = 0.; ///< [length]
    double initial_step                = 0.; ///< [time]
    std::vector<StepLimit> step_limits = {}; ///< of adaptive steps [time]
    double least_event = 0.; ///< an event of the active stress within a step, if it is this large, is stepped over
                             ///< again [force]; 0: not looked for
    Formulation formulation = Formulation::position;
    MeshLimits mesh         = {};    ///< of an adaptive mesh
    bool linear             = false; ///< the rung for a = 0: radau, position form, uniform mesh
    std::string integrator  = "";    ///< what an automatic integrator is (time/integrators.h); empty: bdf
    Grading grading         = {};    ///< of the first mesh, which has n_cells cells without it
    double layer            = 0.;    ///< of the stretch form: see layered_cell_ends() [length]; 0: none
    unsigned int parts      = 1;     ///< of the stretch form, into which each of n_cells is divided
    bool other_rule         = false; ///< of the stretch form, see stretch_method()
    bool jumps_move         = false; ///< the active stress jumps at places that move through the cells
  };

  /// In natural units.
  Numerics
  in_units(Numerics numerics, const Units &units);

  /// The ends of the cells of the first mesh, for a body of length 1: at the breaks in space, and graded as wished.
  /// Empty if they are n_cells of one size.
  std::vector<double>
  first_cell_ends(const Scene &scene, const Numerics &numerics);

  /// What one simulation gives.
  struct SimulationResult
  {
    TimeOutcome time; ///< its status is "inverted" too

    /// Of the centre of mass, (1/L) int u ds [length]; not a number if nobody looked before the run broke off.
    double displacement = std::numeric_limits<double>::quiet_NaN();
    /// How: an integrator of time/integrators.h; petsc, fused, or "fused, petsc" where the fused engine gave up.
    std::string integrator, engine;
    std::optional<DisplacementError> error; ///< of the displacement
    std::optional<NumberErrors> errors;     ///< of other numbers, if a finer run measured them
    double largest_u  = 0.;                 ///< root mean square of u over the body, largest over time [length]
    double unresolved = 0.;                 ///< Resolution: largest highest_mode over largest strain, if looked at
    double strain     = 0.; ///< largest int (w - 1)^2 ds over time, if the resolution is looked at [length]
    std::optional<Ledger> ledger;
    bool jumps_move     = false; ///< the ledger's integrals in time are not those of a smooth active stress
    double net_friction = 0.;    ///< largest |int g v ds| over largest int |g v| ds, both over time [1]

    using Extreme = crawler::Extreme;
    Extreme min_stretch, max_stretch;
    std::optional<Extreme> inversion; ///< where and when the body inverted; value is the stretch there
    /// What is lost together with it: in the stretch form, from the first to the last of these places [length].
    std::optional<std::pair<double, double>> inverted_places;
    std::optional<double> inversion_error; ///< of the time when it inverted, where that was measured [time]

    std::optional<Gait> gait;              ///< the last stride, if that is looked at and there is one
    std::optional<double> gait_efficiency; ///< of the whole run (gait.h), if it is known [1]
    std::optional<Cycles> cycles;          ///< if the run ended because they repeat; all above is that of the end time

    Formulation formulation   = Formulation::position;
    unsigned int mesh_changes = 0, most_cells = 0; ///< of an adaptive mesh
    /// The last mesh; nothing if there was none.
    struct Mesh
    {
      unsigned int n_cells, degree;
      std::size_t n_unknowns;
      bool is_shared; ///< by several ranks
    };
    std::optional<Mesh> mesh;
    double largest_indicator = 0.; ///< largest sum of the error indicators of an accepted state [length]
    double setup_seconds = 0., solve_seconds = 0., output_seconds = 0.;
    double estimate_seconds  = 0.; ///< that the error took (error_estimate.h)
    unsigned int refinements = 0;  ///< tries before this one, whose errors were too large
  };

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
      bool ledger                     = false; ///< works, energies, net friction
      bool resolution                 = false; ///< SimulationResult::unresolved
      std::optional<CycleWish> cycles = {};    ///< end the run when its cycles repeat; not with frames
      GaitWish gait                   = GaitWish::none;
    };

    Simulation(MPI_Comm communicator, const Scene &scene, const TimeParameters &time, const Numerics &numerics);
    ~Simulation();

    /// Runs from rest. If that is wished it ends when its cycles repeat (cycle_stop.h); the result is that of the end
    /// time all the same. @p frames are times in (0, T] where steps must end. @p keep_going is asked after every step.
    SimulationResult
    run(const std::vector<double> &frames,
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
    fused_fits() const;
    void
    choose_stepper();
    void
    build_linear_stepper();
    void
    build_fused_stepper();
    void
    build_petsc_stepper();
    void
    go_on_with_petsc(const TimeOutcome &outcome);
    void
    count_part(const TimeOutcome &outcome);
    void
    begin_piece();
    std::vector<double>
    frames_of_piece();
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
    TimePieces pieces_;
    const Scene scene_;                  ///< in natural units
    const Numerics numerics_;            ///< in natural units
    TimeParameters time_;                ///< in natural units
    std::vector<StepLimit> step_limits_; ///< of adaptive steps, in natural units
    const MPI_Comm communicator_;

    std::unique_ptr<Discretization> discretization_;
    std::unique_ptr<Assembler> assembler_;
    PositionForm *position_    = nullptr; ///< the assembler, if the form is that
    StretchForm *stretch_form_ = nullptr;
    // Who integrates; built when they are needed.
    std::unique_ptr<TimeStepper> petsc_stepper_;
    std::unique_ptr<FusedStepper> fused_stepper_;
    std::unique_ptr<LinearStepper> linear_stepper_;
    TimeIntegration *stepper_ = nullptr; ///< one of them
    bool fused_gave_up_       = false;
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
    double delay_           = 0.;       ///< of the feedback [natural units]; 0: nobody asks for the past
    StretchHistory history_;
    std::shared_ptr<const std::vector<Cell>> history_cells_; ///< of the present mesh
    // The last state that was accepted, to which a change of mesh may go back.
    std::vector<double> accepted_;
    double accepted_time_ = 0., next_step_ = 0.;
    TimeOutcome before_;         ///< counts of the parts of the run before the last change of mesh
    Step latest_{};              ///< that was tried, with the counts of the whole run
    std::vector<double> frames_; ///< in physical units
    std::size_t next_frame_ = 0;
    bool ends_at_frame_     = false; ///< does the present piece?
    std::optional<CycleStop> cycle_stop_;
    std::optional<GaitMeter> gait_meter_;
    std::optional<StressWatch> watch_;
    std::optional<double> hidden_frame_; ///< one of frames_ that nobody has asked for
    unsigned int mesh_number_ = 0, tiny_steps_ = 0;
    unsigned long n_failures_ = 0;     ///< of the active stress before this run
    bool started_             = false; ///< a state has been accepted
  };
} // namespace crawler
