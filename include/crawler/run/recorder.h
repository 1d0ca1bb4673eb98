// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/equation/energy_balance.h>
#include <crawler/run/cycle_stop.h>
#include <crawler/run/gait.h>
#include <crawler/run/simulation_result.h>
#include <crawler/run/sudden_changes.h>

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  class LaneRecord;

  struct Scene;

  /// Request for the last stride (SimulationResult::gait): none, if the active stress declares its period, or always.
  enum class GaitWish
  {
    none,
    declared,
    any
  };

  /// Request for the numbers that the choice of the numerics needs.
  enum class ResolutionWish
  {
    none,
    size, ///< SolutionSize::largest_u and last_u
    all   ///< all of SolutionSize, which costs as much as a short step
  };

  /// Options: numbers computed at each accepted step besides the state.
  struct RecordOptions
  {
    bool energy_balance             = false; ///< works, energies, net friction
    ResolutionWish resolution       = ResolutionWish::none;
    std::optional<CycleWish> cycles = {}; ///< end the run when its cycles repeat; not with output times
    GaitWish gait                   = GaitWish::none;
    LaneRecord *steps               = nullptr; ///< all steps of the fused engine are added to it
  };

  /**
   * Records one run from its accepted steps, whoever makes them (Simulation, batches of the lanes, reduced models):
   * extremes of the stretch, works, friction, the last stride, and the end of a run whose cycles repeat. Everything is
   * in natural units until finish().
   */
  class Recorder
  {
  public:
    /// Number of equal pieces of the body at whose ends it is sampled.
    static constexpr unsigned int n_pieces = GaitMeter::n_pieces;
    static_assert(n_pieces == CycleStop::n_pieces);

    /// Displacement at the ends of all pieces, and its mean over the body, [n_pieces + 1] and 1.
    struct BodySample
    {
      std::span<const double> u;
      double displacement;
    };
    /// Samples the body at a time of the step that has just been accepted.
    using Sampler = std::function<BodySample(double time)>;

    /// @p scene is in the @p units of the user, and must outlive this; @p tolerance is that of the time integration in
    /// natural units. A gait whose period is not declared is searched only if @p may_search.
    Recorder(const Scene &scene, const Units &units, const RecordOptions &options, double tolerance, bool may_search);

    /// Tells that the mesh is of high order and begins with cells no smaller than this, in natural units: its values in
    /// thin layers do not count. Not called otherwise.
    void
    set_smallest_cell(double size);

    /// True if the body cannot have inverted inside, since the layers of a sudden start are thinner than the cells; not
    /// before the time of the last call, or that of the last observation.
    bool
    keeps_stretch_inside(double time);

    /// Times in (0, 1), ascending, where steps have to end besides the output times.
    std::vector<double>
    step_ends() const;

    /// Time of the next sample of the body, infinite if there is none.
    double
    next_sample() const;

    // Observations, in the order in which a step makes them:

    /// Observes the extreme stretches of a state within or at the end of the step; the first call starts the run.
    void
    see_stretch(Extreme smallest, Extreme largest);
    /// Observes the works in a step of this duration, and its end, with these integrals (CellIntegrals, or those of a
    /// stage of the lanes).
    template <typename Integrals>
    void
    see_works(const double duration, const Rates &works, const Integrals &end)
    {
      result.energy_balance->add_works(works);
      result.energy_balance->elastic_energy = end.elastic_energy;
      friction_impulse_ += duration * end.abs_friction;
      net_impulse_ += duration * std::abs(end.net_friction);
      if (friction_impulse_ > 0.)
        result.residuals.net_friction = net_impulse_ / friction_impulse_;
    }
    /// Observes the end of the step, with the extreme stretches there; @p is_step_end: it is an output time or one of
    /// step_ends(). Returns true if the run may end here, since its cycles repeat.
    bool
    see_step(double time, bool is_step_end, double smallest, double largest, const Sampler &sample);

    /// Notes a jump of the active stress: the solution does not continue smoothly.
    void
    interrupt();

    /// Smallest stretch before the last one that was seen.
    const Extreme &
    smallest_before_last() const
    {
      return smallest_.before_last();
    }
    bool
    cycles_repeat() const
    {
      return cycle_stop_ && cycle_stop_->repeats();
    }

    /// Result in the user's units, of a run that has ended as result.time says; that of the end time if its cycles
    /// repeat. Must be the last call.
    SimulationResult
    finish();

    /// Exchanges the state between two steps.
    void
    exchange(Archive &archive);

    SimulationResult result; ///< result, to which the caller adds what only it knows

  private:
    void
    compare_with_end(Extreme &now, const ExtremeHistory &history);
    bool
    see_cycles(double time, bool is_step_end, const Sampler &sample);

    const Scene &scene_;
    const Units units_;
    std::optional<CycleStop> cycle_stop_;
    std::optional<GaitMeter> gait_meter_;
    std::optional<SuddenChanges> sudden_changes_;
    ExtremeHistory smallest_{ExtremeHistory::smallest}, largest_{ExtremeHistory::largest};
    bool started_            = false;
    bool were_known_         = false;                 ///< sudden_changes_ knew the extremes seen last
    double friction_impulse_ = 0., net_impulse_ = 0.; ///< int dt of both
  };

  /// Converts natural units to those of the user's @p scene. A finished run has the time of the scene's end, and with
  /// an energy balance its gait efficiency.
  SimulationResult
  in_user_units(SimulationResult result, const Scene &scene, const Units &units);
} // namespace crawler
