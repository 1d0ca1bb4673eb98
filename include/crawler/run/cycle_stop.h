// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/energy_balance.h>

#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// A run that ended early because its cycles repeat; the others are extrapolated.
  struct Cycles
  {
    double period; ///< [time]
    unsigned int computed, extrapolated;
    double bound; ///< of the error of the displacement that comes from the extrapolation [length]
  };

  /// The wish to end a run when its cycles repeat.
  struct CycleWish
  {
    double period;    ///< of the active stress [time]
    double accuracy;  ///< of the displacement, relative; the bound takes a fifth of it at most
    double from = 0.; ///< when the active stress begins to repeat [time]

    /// With times in this unit.
    CycleWish
    in_units(const double time) const
    {
      return {period / time, accuracy, from / time};
    }
  };

  struct RunParameters;
  struct Scene;

  /// What the entry Time/Cycle stop means for a run with so many output times; nothing if it shall not end early or if
  /// the active stress has no period of which there are enough.
  std::optional<CycleWish>
  cycle_wish(const RunParameters &parameters, const Scene &scene, bool has_pictures);

  /**
   * Watches a run with periodic actuation, from rest over (0, 1], and says when a cycle repeats the one before it
   * (doc/numerics.md, "Cycle stop"). Cycles end at 1 - j P with whole numbers j, so none of those that are extrapolated
   * is a part of one. Each is compared with the one before it at n_phases equally spaced phases, in the mean stretches
   * of n_pieces equal pieces of the body. All lengths are in units of the body's.
   */
  class CycleStop
  {
  public:
    static constexpr unsigned int n_phases = 8, n_pieces = 64;

    /// Fewer cycles are not worth the trouble: two must be computed before one can repeat.
    static constexpr unsigned int fewest_cycles = 3;

    /// @p wish: its times are in units of the duration. @p tolerance: of the time integration.
    CycleStop(const CycleWish &wish, double tolerance);

    /// Does the duration, which is the unit of times, hold fewest_cycles?
    static bool
    fits(const CycleWish &wish);

    /// When cycles end, where steps have to end, too; ascending, in (0, 1). Not all cycles of a long run are watched.
    const std::vector<double> &
    ends() const
    {
      return end_times_;
    }

    /// When the next state is wanted, infinite if none is; is it one of ends()? States between these may be dense
    /// output.
    double
    next_time() const;
    bool
    next_is_end() const;

    /// Sees that state: @p u is the displacement at the ends of all pieces, @p displacement its
    /// mean, @p energy balance may be null. @p decay is k/(g L^2) with the largest friction g of the run. Returns true
    /// if the run may end here.
    bool
    observe(std::span<const double> u, double displacement, const EnergyBalance *energy_balance, double decay);

    /// Has observe() said so?
    bool
    repeats() const
    {
      return repeats_;
    }

    /// From the state at which the run ended to its end: displacement and, if it is not null, the energy balance. The
    /// period is in units of the duration.
    Cycles
    extrapolate(double &displacement, EnergyBalance *energy_balance) const;

    void
    exchange(Archive &archive);

  private:
    /// At the end of a cycle.
    struct End
    {
      double displacement          = 0.;
      EnergyBalance energy_balance = {};
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
    unsigned int n_cycles_ = 0;     ///< whole ones
    double start_          = 0.;    ///< of the first cycle
    bool from_rest_        = false; ///< it starts with the run
    std::vector<double> end_times_;
    bool repeats_ = false;
    double bound_ = 0.;

    std::deque<std::vector<double>> stretches_; ///< of the pieces, over the last cycle
    /// Of each state: root mean square over the body of the strain, of its change since a cycle before, and the largest
    /// such change. The changes of the first cycle are not known.
    std::vector<double> strains_, changes_, largest_changes_;
    std::vector<End> ends_;   ///< the start of the first cycle, and the ends of all
    double largest_u_   = 0.; ///< root mean square over the body, largest over time
    double least_       = 1.; ///< smallest mean stretch of a piece, over time
    double sensitivity_ = 0.; ///< largest change of the displacement in a cycle over change of the strain at its start
  };
} // namespace crawler
