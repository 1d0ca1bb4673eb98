// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/equation/energy_balance.h>
#include <crawler/run/cycle_stop.h>
#include <crawler/run/gait.h>
#include <crawler/run/simulation_result.h>
#include <crawler/run/sudden_changes.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  class LaneRecord;

  struct Scene;

  /// Of the last stride (SimulationResult::gait): none, if the active stress says how long it is, or in any case.
  enum class GaitWish
  {
    none,
    declared,
    any
  };

  /// What is looked at for the choice of the numerics.
  enum class ResolutionWish
  {
    none,
    size, ///< SimulationResult::largest_u
    all   ///< and SimulationResult::unresolved, strain and largest_indicator, which cost as much as a short step
  };

  /// What is computed at each accepted step besides the state.
  struct RecordOptions
  {
    bool energy_balance             = false; ///< works, energies, net friction
    ResolutionWish resolution       = ResolutionWish::none;
    std::optional<CycleWish> cycles = {}; ///< end the run when its cycles repeat; not with output times
    GaitWish gait                   = GaitWish::none;
    LaneRecord *steps               = nullptr; ///< all steps of the fused engine are added to it
  };

  /**
   * What the accepted steps of one run give, whoever makes them (Simulation, batches of the lanes, reduced models):
   * extremes of the stretch, works, friction, the last stride, and the end of a run whose cycles repeat. Everything is
   * in natural units until finish().
   */
  class Recorder
  {
  public:
    /// The body is looked at at the ends of so many equal pieces of it.
    static constexpr unsigned int n_pieces = GaitMeter::n_pieces;
    static_assert(n_pieces == CycleStop::n_pieces);

    /// The displacement at the ends of all pieces, and its mean over the body, [n_pieces + 1] and 1.
    struct BodySample
    {
      std::span<const double> u;
      double displacement;
    };
    /// The body at a time of the step that has just been accepted.
    using Sampler = std::function<BodySample(double time)>;

    /// @p scene is in the @p units of the user, and must outlive this; @p tolerance is that of the time integration in
    /// natural units. A gait whose period is not declared is looked for only if @p may_search.
    Recorder(const Scene &scene, const Units &units, const RecordOptions &options, double tolerance, bool may_search);

    /// The mesh is one of high order with cells no smaller than this, in natural units: what it shows of thin layers
    /// does not count. Not called otherwise.
    void
    set_smallest_cell(double size);

    /// Times in (0, 1), ascending, where steps have to end besides the output times.
    std::vector<double>
    step_ends() const;

    /// When the body is wanted next, infinite if it is not wanted any more.
    double
    next_sample() const;

    // In the order in which a step gives them:

    /// The extreme stretches of a state within or at the end of the step; the first call starts the run.
    void
    see_stretch(Extreme smallest, Extreme largest);
    /// int |g v| ds, and |int g v ds| where the velocity balances all forces.
    void
    see_friction(double sum_of_sizes, double size_of_sum);
    /// The end of the step, with the extreme stretches there; @p is_step_end: it is an output time or one of
    /// step_ends(). Returns true if the run may end here, since its cycles repeat.
    bool
    see_step(double time, bool is_step_end, double smallest, double largest, const Sampler &sample);

    /// The active stress jumps: what follows does not go on smoothly.
    void
    interrupt();

    /// The smallest stretch before the last one that was seen.
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

    /// The result in the user's units, of a run that has ended as result.time says; that of the end time if its cycles
    /// repeat. The last call.
    SimulationResult
    finish();

    /// The state between two steps.
    void
    exchange(Archive &archive);

    SimulationResult result; ///< whoever runs adds what only it knows

  private:
    void
    compare_with_end(Extreme &now, const ExtremeHistory &history);
    bool
    see_cycles(double time, bool is_step_end, const Sampler &sample);
    const EnergyBalance *
    energies() const;

    const Scene &scene_;
    const Units units_;
    std::optional<CycleStop> cycle_stop_;
    std::optional<GaitMeter> gait_meter_;
    std::optional<SuddenChanges> sudden_changes_;
    ExtremeHistory smallest_{ExtremeHistory::smallest}, largest_{ExtremeHistory::largest};
    bool started_            = false;
    bool were_known_         = false;                          ///< the extremes that were seen last, by sudden_changes_
    double largest_friction_ = 0., largest_net_friction_ = 0.; ///< over time
  };
} // namespace crawler
