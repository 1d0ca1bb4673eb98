// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/cycle_stop.h>
#include <crawler/run/run_parameters.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/cycle_stop_test.cc.
    /// Part of the wanted accuracy that the bound may take.
    constexpr double part = 0.2;
    /// Relative difference of the strains of two successive cycles below which they repeat.
    constexpr double same = 1e-3;
    /// Safety factor on the observed dependence of a cycle's displacement on its start.
    constexpr double safety = 10.;
    /// Changes of the strain below this multiple of the tolerance of the time integration are its noise.
    constexpr double noise = 10.;
    /// Limit of the remaining drift, as a part of the smallest stretch.
    constexpr double min_part = 0.1;
    /// Distance of a start from the first phase, as a part of a cycle, below which it is left out.
    constexpr double short_start = 1e-3;
    /// Largest number of cycles watched.
    constexpr unsigned int max_watched = 200;

    /// Number of whole cycles up to the end of the run, in units of its duration.
    double
    whole_cycles(const CycleWish &wish)
    {
      return std::floor((1. - wish.from) / wish.period * (1. + 1e-9));
    }
  } // namespace

  std::optional<CycleWish>
  cycle_wish(const RunParameters &parameters, const Scene &scene, const bool has_pictures)
  {
    const TimeParameters &time = parameters.time;
    if (time.cycle_stop == CycleStopMode::off ||
        (time.cycle_stop == CycleStopMode::automatic && (has_pictures || time.step_control != StepControl::adaptive)))
      return std::nullopt;
    if (!scene.is_alike_everywhere() || scene.keeps_its_centre()) // cycles are judged by the displacement
      return std::nullopt;
    const auto gait = scene.active_stress->repetition();
    if (!gait)
      return std::nullopt;
    const CycleWish wish{gait->period, parameters.accuracy, gait->from};
    return CycleStop::fits(wish.in_units(scene.end_time)) ? std::optional(wish) : std::nullopt;
  }

  bool
  CycleStop::fits(const CycleWish &wish)
  {
    return whole_cycles(wish) >= min_cycles && whole_cycles(wish) < 1e9;
  }

  CycleStop::CycleStop(const CycleWish &wish, const double tolerance)
    : wish_(wish)
    , tolerance_(tolerance)
    , n_cycles_(static_cast<unsigned int>(whole_cycles(wish)))
  {
    const double P = wish.period;
    start_         = 1. - n_cycles_ * P;
    from_rest_     = start_ <= 1e-9 * P;
    if (from_rest_)
    {
      start_ = 0.;
      ends_.emplace_back();
      compare(std::vector<double>(n_pieces, 1.));
    }
    else if (start_ < short_start * P)
    {
      start_ += P;
      --n_cycles_;
    }
    const unsigned int n_watched = std::min(n_cycles_ - 1, max_watched);
    for (unsigned int i = from_rest_ ? 1 : 0; i <= n_watched; ++i)
      end_times_.push_back(start_ + P * i);
  }

  double
  CycleStop::next_time() const
  {
    const std::size_t i = changes_.size() / n_phases, phase = changes_.size() % n_phases;
    const double time = start_ + wish_.period * (static_cast<double>(i) + static_cast<double>(phase) / n_phases);
    return repeats_ || end_times_.empty() || time > end_times_.back() * (1. + 1e-14) ? HUGE_VAL : time;
  }

  bool
  CycleStop::next_is_end() const
  {
    return changes_.size() % n_phases == 0;
  }

  bool
  CycleStop::observe(const std::span<const double> u,
                     const double displacement,
                     const std::optional<EnergyBalance> &energy_balance,
                     const double decay)
  {
    double square = 0.;
    std::vector<double> stretch(n_pieces);
    for (unsigned int i = 0; i < n_pieces; ++i)
    {
      stretch[i] = 1. + (u[i + 1] - u[i]) * n_pieces;
      least_     = std::min(least_, stretch[i]);
      square += u[i] * u[i] / n_pieces;
    }
    largest_u_        = std::max(largest_u_, std::sqrt(square));
    const bool is_end = next_is_end();
    compare(stretch);
    if (!is_end)
      return false;
    ends_.push_back({displacement, energy_balance.value_or(EnergyBalance())});
    if (ends_.size() >= 3)
      judge(decay);
    if (wish_.computed > 0)
      repeats_ = ends_.size() > wish_.computed;
    return repeats_;
  }

  void
  CycleStop::compare(const std::span<const double> stretch)
  {
    Change change;
    const bool known = stretches_.size() == n_phases;
    for (unsigned int i = 0; i < n_pieces; ++i)
    {
      change.strain += (stretch[i] - 1.) * (stretch[i] - 1.) / n_pieces;
      const double difference = known ? stretch[i] - stretches_.front()[i] : 0.;
      change.since += difference * difference / n_pieces;
      change.largest = std::max(change.largest, std::abs(difference));
    }
    change.strain = std::sqrt(change.strain);
    change.since  = std::sqrt(change.since);
    changes_.push_back(change);
    if (known)
      stretches_.pop_front();
    stretches_.emplace_back(stretch.begin(), stretch.end());
  }

  /// Largest ratio of a change in the last cycle to the one a cycle before, at all phases where both are known. Where
  /// the changes have decayed to the errors of the time integration, their ratio is that of errors; these do not
  /// accumulate, so the ratio counts as at most 1/2.
  double
  CycleStop::decay_of_changes() const
  {
    double largest         = 0.;
    const std::size_t last = changes_.size() - 1;
    for (std::size_t i = std::max<std::size_t>(last - n_phases + 1, 2 * n_phases); i <= last; ++i)
    {
      const double since = changes_[i].since, ratio = since / std::max(changes_[i - n_phases].since, 1e-300);
      largest = std::max(largest, since <= noise * tolerance_ ? std::min(ratio, 0.5) : ratio);
    }
    return largest;
  }

  /// Root mean square over the last cycle of the change of the strain since a cycle before, relative to the strain.
  double
  CycleStop::relative_change() const
  {
    double change = 0., strain = 0.;
    for (std::size_t i = changes_.size() - n_phases; i < changes_.size(); ++i)
    {
      change += changes_[i].since * changes_[i].since;
      strain += changes_[i].strain * changes_[i].strain;
    }
    return change > 0. ? std::sqrt(change / strain) : 0.;
  }

  /// Decides at the end of the second and each later cycle; the formulas are those of doc/numerics.md, "Cycle stop".
  void
  CycleStop::judge(const double decay)
  {
    const std::size_t n        = ends_.size() - 1;
    const auto left            = static_cast<double>(n_cycles_ - n);
    const double increment     = ends_[n].displacement - ends_[n - 1].displacement;
    const double before        = ends_[n - 1].displacement - ends_[n - 2].displacement;
    const double change        = changes_.back().since;
    const double change_before = changes_[changes_.size() - 1 - n_phases].since;
    constexpr double pi        = std::numbers::pi;
    const double rho           = std::max(decay_of_changes(), std::exp(-pi * pi * decay * wish_.period));
    // The @p difference is that of the last two increments.
    const auto bound = [&](const double difference, Extrapolated &number) {
      if (change_before > 0.)
        number.sensitivity = std::max(number.sensitivity, difference / change_before);
      const double next = std::max(rho * difference, number.sensitivity * change);
      number.bound      = rho < 1.
                            ? left * (n >= 3 ? std::min(next, safety * number.sensitivity * change) : next) / (1. - rho)
                            : HUGE_VAL;
    };
    const auto difference_of = [&](double EnergyBalance::*work) {
      const auto at = [&](const std::size_t cycle) { return ends_[cycle].energy_balance.*work; };
      return std::abs(at(n) - 2. * at(n - 1) + at(n - 2));
    };
    bound(std::abs(increment - before), displacement_);
    bound(std::max({difference_of(&EnergyBalance::stress_work),
                    difference_of(&EnergyBalance::dissipation),
                    difference_of(&EnergyBalance::end_work)}),
          works_);
    if (!(rho < 1.))
      return;
    // Increments are differences of displacements, which have round-off.
    displacement_.bound += left * 4. * std::numeric_limits<double>::epsilon() * largest_u_;

    const double size        = std::max({std::abs(ends_[n].displacement + left * increment),
                                         displacement_floor * largest_u_,
                                         n_cycles_ * round_off_of_cycle * largest_u_ / wish_.accuracy});
    const double drift       = changes_.back().largest * rho / (1. - rho);
    const EnergyBalance &now = ends_[n].energy_balance, &then = ends_[n - 1].energy_balance;
    const double stored = left * std::abs(now.elastic_energy - then.elastic_energy);
    const double work   = now.exchanged_work + left * (now.exchanged_work - then.exchanged_work);
    repeats_            = displacement_.bound <= part * wish_.accuracy * size && relative_change() <= same &&
               drift <= min_part * least_ && stored <= wish_.accuracy * work;
  }

  Cycles
  CycleStop::extrapolate(double &displacement, std::optional<EnergyBalance> &energy_balance) const
  {
    const std::size_t n = ends_.size() - 1;
    const auto left     = static_cast<double>(n_cycles_ - n);
    const auto go_on    = [&](double &value, const auto of) { value += left * (of(ends_[n]) - of(ends_[n - 1])); };
    go_on(displacement, [](const End &end) { return end.displacement; });
    if (energy_balance)
      for (double EnergyBalance::*integral : EnergyBalance::energies())
        if (integral != &EnergyBalance::elastic_energy) // that of the last state
          go_on((*energy_balance).*integral, [&](const End &end) { return end.energy_balance.*integral; });
    return {wish_.period,
            static_cast<unsigned int>(n),
            static_cast<unsigned int>(n_cycles_ - n),
            displacement_.bound,
            energy_balance && works_.bound > 0. ? works_.bound / energy_balance->exchanged_work : 0.};
  }

  void
  CycleStop::exchange(Archive &archive)
  {
    archive(repeats_, displacement_, works_, stretches_, changes_, ends_, largest_u_, least_);
  }
} // namespace crawler
