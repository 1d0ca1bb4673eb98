// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/numerics.h>
#include <crawler/run/simulation_parts.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// Method of the fused engine by which a Simulation computes; nothing if there is none.
  std::optional<LaneMethod>
  lane_method(const Scene &scene, const TimeParameters &time, const Numerics &numerics);

  /**
   * One crawler: builds mesh, equation and time integration in this order, connects them, and changes the mesh on the
   * way where requested. Computes in natural units (scene.h); inputs and results are in the scene's. Can run several
   * times, which reuses everything as long as the mesh did not change.
   */
  class Simulation
  {
  public:
    Simulation(MPI_Comm communicator, const Scene &scene, const TimeParameters &time, const Numerics &numerics);
    ~Simulation();

    /// Runs from rest. On request it ends when its cycles repeat (cycle_stop.h); the result is that of the end time all
    /// the same. @p pictures: what observers see besides the ends of steps. @p keep_going is asked after every step;
    /// runs in its journal are not computed again, and the journal gets the states and the result of this one.
    SimulationResult
    run(const PictureTimes &pictures,
        const RecordOptions &options,
        const Observers &observers  = {},
        const KeepGoing &keep_going = {});

    /// Present mesh, of length 1.
    const Discretization &
    discretization() const
    {
      return mesh_.assembler->discretization;
    }
    const Units &
    units() const
    {
      return units_;
    }

  private:
    using Ending    = simulation_parts::Ending;
    using Run       = simulation_parts::Run;
    using Diagnosis = simulation_parts::Diagnosis;

    void
    build_first();
    void
    build(std::unique_ptr<Discretization> discretization);
    bool
    is_adaptive() const
    {
      return numerics_.mesh.tolerance > 0.;
    }
    void
    choose_stepper();
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
    std::span<const double>
    state_within(double t);
    Rates
    rates_within(double t);
    bool
    integrate_step(const Step &step, const Rates &at_end);
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
    TimeOutcome
    integrate();
    Ending
    integrate_part();
    Ending
    look_at(const Step &part, const Step &step);
    bool
    goes_on_after(Ending ending, TimeOutcome &outcome);
    TimeOutcome
    failure_while_integrating();
    std::string
    identity(const RecordOptions &options, bool has_pictures) const;
    void
    exchange(Archive &archive);
    void
    exchange_mesh(Archive &archive);
    void
    take_up();
    void
    keep_state(bool stops, const Step &step);
    SimulationResult
    finish();
    void
    show_step(const Step &step, std::span<const double> y);
    bool
    show_pictures_within(const Step &step, double until, const EnergyBalance &at_start);
    void
    show_pictures_before_inversion(const Step &step);
    void
    show_row_after_jump();
    void
    show(const StateNumbers &natural,
         std::span<const double> y,
         std::span<const double> v,
         bool is_step_end,
         const PictureTimes::Time *picture);
    SimulationResult &
    result()
    {
      return run_->recorder.result;
    }

    const Scene &physical_scene_;
    const Units units_;
    TimeSegments segments_;
    const Scene scene_;                ///< in natural units
    const Numerics numerics_;          ///< in natural units
    TimeParameters time_;              ///< in natural units
    const std::vector<double> breaks_; ///< breaks in space
    const MPI_Comm communicator_;

    simulation_parts::OnMesh mesh_;
    simulation_parts::Integrators integrators_;
    simulation_parts::Past past_;
    std::optional<Run> run_;
    std::vector<double> y_, v_;      ///< the present state and its velocity
    simulation_parts::State inside_; ///< state within a step
  };
} // namespace crawler
