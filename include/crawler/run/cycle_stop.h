// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/energy_balance.h>

#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Floor of the displacement for relative errors, as a part of the body's largest deformation [1].
  inline constexpr double displacement_floor = 1e-4;
  /// Error of a displacement that is round-off, for each cycle, as a part of the body's largest deformation [1].
  inline constexpr double round_off_of_cycle = 1e-14;

  /// Cycles of a run that ended early because they repeat; the missing ones are extrapolated.
  struct Cycles
  {
    double period; ///< [time]
    unsigned int computed, extrapolated;
    double bound;      ///< error bound of the displacement for the extrapolation [length]
    double work_bound; ///< that of works, as a part of the exchanged work
  };

  /// Request to end a run when its cycles repeat.
  struct CycleWish
  {
    double period;              ///< period of the active stress [time]
    double accuracy;            ///< relative accuracy of the displacement; the bound takes a fifth of it at most
    double from           = 0.; ///< time at which the active stress begins to repeat [time]
    unsigned int computed = 0;  ///< cycles after which the run ends, whether they repeat or not; 0: as they repeat

    /// Returns the request with times in this unit.
    CycleWish
    in_units(const double time) const
    {
      return {period / time, accuracy, from / time, computed};
    }
  };

  struct RunParameters;
  struct Scene;

  /// Request that the entry Time/Cycle stop makes for a run; nothing if the run shall not end early or if the active
  /// stress has no period or too few of them.
  std::optional<CycleWish>
  cycle_wish(const RunParameters &parameters, const Scene &scene, bool has_pictures);

  /**
   * Watches a run with periodic actuation, from rest over (0, 1], and says when a cycle repeats the one before it
   * (doc/numerics.md, "Cycle stop"). Cycles end at 1 - j P with whole numbers j, so only whole cycles are extrapolated.
   * Each is compared with the one before it at n_phases equally spaced phases, in the mean stretches of n_pieces equal
   * pieces of the body. All lengths are in units of the body's.
   */
  class CycleStop
  {
  public:
    static constexpr unsigned int n_phases = 8, n_pieces = 64;

    /// Least number of cycles worth watching: two must be computed before one can repeat.
    static constexpr unsigned int min_cycles = 3;

    /// @p wish has its times in units of the duration; @p tolerance is that of the time integration.
    CycleStop(const CycleWish &wish, double tolerance);

    /// True if the duration, which is the unit of times, holds min_cycles.
    static bool
    fits(const CycleWish &wish);

    /// Ends of cycles, where steps must end, too; ascending, in (0, 1). Not all cycles of a long run are watched.
    const std::vector<double> &
    ends() const
    {
      return end_times_;
    }

    /// Time at which the next state is wanted, infinite if none is. States between those at ends() may be dense output.
    double
    next_time() const;
    bool
    next_is_end() const;

    /// Observes that state: @p u is the displacement at the ends of all pieces, @p displacement its mean. @p decay is
    /// k/(g L^2) with the largest friction g of the run. Returns true if the run may end here.
    bool
    observe(std::span<const double> u,
            double displacement,
            const std::optional<EnergyBalance> &energy_balance,
            double decay);

    /// True if observe() has said so.
    bool
    repeats() const
    {
      return repeats_;
    }

    /// Extrapolates displacement and energy balance, if there is one, from the state at which the run ended to its end.
    /// The period is in units of the duration.
    Cycles
    extrapolate(double &displacement, std::optional<EnergyBalance> &energy_balance) const;

    void
    exchange(Archive &archive);

  private:
    /// State at the end of a cycle.
    struct End
    {
      double displacement          = 0.;
      EnergyBalance energy_balance = {};
    };

    /// Number whose increments in the cycles to come are those of the last one.
    struct Extrapolated
    {
      double bound       = 0.; ///< error bound
      double sensitivity = 0.; ///< largest change of its increment over change of the strain at the start of the cycle
    };

    /// Root mean squares over the body of a state's strain and of its change since a cycle before, and the largest such
    /// change. Those of the first cycle are not known: 0.
    struct Change
    {
      double strain = 0., since = 0., largest = 0.;
    };

    void
    compare(std::span<const double> stretch);
    void
    judge(double decay);
    double
    decay_of_changes() const;
    double
    relative_change() const;

    const CycleWish wish_;
    const double tolerance_;
    unsigned int n_cycles_ = 0;     ///< whole cycles
    double start_          = 0.;    ///< start of the first cycle
    bool from_rest_        = false; ///< the first cycle starts with the run
    std::vector<double> end_times_;
    bool repeats_ = false;
    Extrapolated displacement_, works_;

    std::deque<std::vector<double>> stretches_; ///< stretches of the pieces, over the last cycle
    std::vector<Change> changes_;               ///< changes of all states
    std::vector<End> ends_;                     ///< the start of the first cycle, and the ends of all
    double largest_u_ = 0.;                     ///< root mean square over the body, largest over time
    double least_     = 1.;                     ///< smallest mean stretch of a piece, over time
  };
} // namespace crawler
