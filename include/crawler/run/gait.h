// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/energy_balance.h>
#include <crawler/run/stretch_wave.h>
#include <crawler/scene/units.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  class ActiveStress;

  /// Last stride of a run (doc/theory.md, "Gait numbers").
  struct Gait
  {
    double period;                                    ///< [time]
    bool is_declared;                                 ///< by the active stress; otherwise it was found in the stretch
    double n_strides;                                 ///< number of strides that fit into the run
    double displacement;                              ///< displacement of the centre of mass in this stride [length]
    std::optional<StretchWave> wave;                  ///< nothing if the stretch hardly changes, or too fast
    std::optional<EnergyBalance> energy_balance = {}; ///< works of this stride [energy], if there is an energy balance

    /// Converts natural units to the user's.
    Gait
    in_units(const Units &units) const;

    double length = 1.; ///< length of the body [length]
    std::optional<double> efficiency =
      {}; ///< share of the largest displacement with this dissipation (gait_efficiency.h) [1]

    void
    exchange(auto &archive)
    {
      archive(period, is_declared, n_strides, displacement, wave, energy_balance, length, efficiency);
    }

    double
    speed() const
    {
      return displacement / period;
    }
    double
    body_lengths() const ///< displacement in a stride [1]
    {
      return displacement / length;
    }
    /// Energy per distance [force]; nothing if the body does not move.
    std::optional<double>
    cost_of_transport(double energy) const;
    /// Speed of the wave [length/time]; nothing if no wave travels.
    std::optional<double>
    wave_speed() const;
    /// Slip 1 - (speed of the body)/(speed of the wave) [1]; nothing if no wave travels.
    std::optional<double>
    slip() const;
    /// Direction: "prograde" if the wave travels as the body does, "retrograde" if against it, "standing" if neither;
    /// "none" if there is no wave or the body does not move.
    const char *
    direction() const;
  };

  /// Period of the gait that an active stress drives at the end of a run of this @p duration [time], in units of the
  /// duration; nothing unless the stress declares it and has repeated it twice by then.
  std::optional<double>
  stride_of(const ActiveStress &stress, double duration);

  /**
   * Watches a run over (0, 1] and describes its last stride. A known period (of the active stress, or of the limit that
   * it approaches) is used as it is; otherwise one is looked for in the stretch in the second half of the run: the
   * smallest shift by which the stretch repeats, at least twice. All lengths are in units of the body's.
   */
  class GaitMeter
  {
  public:
    static constexpr unsigned int n_pieces = 64, n_phases = 32;

    /// @p period is in units of the duration; one longer than that counts as none. @p ends_early: the run may end with
    /// any of the strides that end at 1 - j P.
    GaitMeter(std::optional<double> period, bool ends_early);

    /// Time at which the next state is wanted, infinite if none is; dense output is good enough.
    double
    next_time() const;

    /// Times at which a state is wanted.
    std::vector<double>
    times() const;

    /// Time at which a step should end, so that the energy balance is known there; nothing if any will do.
    std::optional<double>
    stride_start() const;

    /// Observes that state: @p u is the displacement at the ends of all pieces, @p displacement its mean.
    void
    see(std::span<const double> u, double displacement);

    /// Observes the smallest and the largest stretch at the end of a step, before see_step() does.
    void
    see_extremes(double smallest, double largest);

    /// True if the end of a step at this time matters: only those are shown to see_step().
    bool
    keeps_step(double time) const;

    /// Observes the end of a step, with its energy balance if there is one.
    void
    see_step(double time, double displacement, const std::optional<EnergyBalance> &energy_balance);

    /// Last stride, in natural units; nothing if there was none.
    std::optional<Gait>
    gait() const;

    void
    exchange(Archive &archive)
    {
      archive(n_samples_, next_, samples_, steps_, smallest_, largest_);
    }

  private:
    struct Sample
    {
      double time, displacement;
      std::vector<double> stretch;

      void
      exchange(Archive &archive)
      {
        archive(time, displacement, stretch);
      }
    };
    /// Range of a number.
    struct Range
    {
      double from = HUGE_VAL, to = -HUGE_VAL;

      void
      add(const Range &other)
      {
        from = std::min(from, other.from);
        to   = std::max(to, other.to);
      }
    };
    struct StepEnd
    {
      double time, displacement;
      std::optional<EnergyBalance> energy_balance;
      Range smallest, largest; ///< stretches since the previous step end

      void
      exchange(auto &archive)
      {
        archive(time, displacement, energy_balance, smallest, largest);
      }
    };

    double
    time_of(unsigned long number) const;
    std::optional<Gait>
    declared_gait() const;
    std::optional<Gait>
    found_gait() const;
    std::optional<double>
    find_period() const;
    std::optional<StretchWave>
    wave(const std::vector<std::vector<double>> &stretch, double period) const;

    const std::optional<double> period_;
    const bool ends_early_;
    unsigned long n_samples_ = 0, next_ = 0; ///< number of all samples, and index of the next one
    std::vector<Sample> samples_;            ///< those of the last n_phases if the period is known, otherwise all
    std::vector<StepEnd> steps_;             ///< ends of strides if the period is known, otherwise of the second half
    Range smallest_, largest_;               ///< stretches since the last of steps_
  };
} // namespace crawler
