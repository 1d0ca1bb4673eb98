// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/cubic_spline.h>
#include <crawler/base/parabola.h>
#include <crawler/run/gait.h>
#include <crawler/scene/active_stress.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Displacements below this count as zero.
    constexpr double nothing = 1e-12;
    /// Samples of a run whose period is not known, and those of them that are searched for one.
    constexpr unsigned int n_unknown = 1024, n_searched = n_unknown / 2;
    /// Mean square of the change of the stretch, relative to the largest such, below which it repeats.
    constexpr double repeats = 1e-3;
    /// Change of the stretch between successive samples, relative to the largest, below which they are close enough.
    constexpr double smooth = 0.05;
    /// Steps from one sample to the next, on average, beyond which the samples may show a slow alias: steps follow the
    /// motion, some in each period.
    constexpr unsigned int max_steps_of_sample = 3;

    double
    square(const double x)
    {
      return x * x;
    }

    EnergyBalance
    difference(const EnergyBalance &later, const EnergyBalance &earlier)
    {
      EnergyBalance result = later;
      for (double EnergyBalance::*energy : EnergyBalance::energies())
        result.*energy -= earlier.*energy;
      return result;
    }
  } // namespace

  Gait
  Gait::in_units(const Units &units) const
  {
    Gait gait = *this;
    gait.period *= units.time;
    gait.displacement *= units.length;
    gait.length *= units.length;
    if (gait.wave)
      gait.wave->speed *= units.velocity();
    if (gait.energy_balance)
      gait.energy_balance = gait.energy_balance->scaled(units.energy());
    return gait;
  }

  std::optional<double>
  Gait::wave_speed() const
  {
    return wave && wave->travels() ? std::optional(wave->speed) : std::nullopt;
  }

  std::optional<double>
  Gait::slip() const
  {
    const auto c = wave_speed();
    return c ? std::optional(1. - std::abs(speed() / *c)) : std::nullopt;
  }

  std::optional<double>
  Gait::cost_of_transport(const double energy) const
  {
    return std::abs(body_lengths()) > nothing && std::isfinite(energy) ? std::optional(energy / std::abs(displacement))
                                                                       : std::nullopt;
  }

  const char *
  Gait::direction() const
  {
    if (!wave || std::abs(body_lengths()) <= nothing)
      return "none";
    if (!wave->travels())
      return "standing";
    return wave->speed * displacement > 0. ? "prograde" : "retrograde";
  }

  std::optional<double>
  stride_of(const ActiveStress &stress, const double duration)
  {
    const auto gait = stress.repetition();
    if (!gait || (gait->from > 0. && gait->from + 2. * gait->period > duration * (1. + 1e-12)))
      return std::nullopt;
    return gait->period / duration;
  }

  GaitMeter::GaitMeter(const std::optional<double> period, const bool ends_early)
    : period_(period)
    , ends_early_(ends_early)
  {
    if (!period_)
      n_samples_ = n_unknown;
    else
    {
      const double strides = std::floor(1. / *period_ * (1. + 1e-9));
      n_samples_           = n_phases * static_cast<unsigned long>(ends_early ? strides : std::min(strides, 1.));
    }
  }

  double
  GaitMeter::time_of(const unsigned long number) const
  {
    const auto back = static_cast<double>(n_samples_ - number);
    return period_ ? std::max(1. - back * *period_ / n_phases, 0.) : 1. - back / static_cast<double>(n_unknown);
  }

  double
  GaitMeter::next_time() const
  {
    return n_samples_ == 0 || next_ > n_samples_ ? HUGE_VAL : time_of(next_);
  }

  std::vector<double>
  GaitMeter::times() const
  {
    std::vector<double> all;
    for (unsigned long i = 0; n_samples_ > 0 && i <= n_samples_; ++i)
      all.push_back(time_of(i));
    return all;
  }

  std::optional<double>
  GaitMeter::stride_start() const
  {
    if (!period_ || ends_early_ || n_samples_ == 0 || time_of(0) == 0.)
      return std::nullopt;
    return time_of(0);
  }

  void
  GaitMeter::see(const std::span<const double> u, const double displacement)
  {
    Sample sample{next_time(), displacement, std::vector<double>(n_pieces)};
    for (unsigned int i = 0; i < n_pieces; ++i)
      sample.stretch[i] = 1. + (u[i + 1] - u[i]) * n_pieces;
    ++next_;
    if (period_ && samples_.size() > n_phases)
      samples_.erase(samples_.begin());
    samples_.push_back(std::move(sample));
  }

  void
  GaitMeter::see_extremes(const double smallest, const double largest)
  {
    smallest_.add({smallest, smallest});
    largest_.add({largest, largest});
  }

  bool
  GaitMeter::keeps_step(const double time) const
  {
    constexpr double same = 1e-9; // part of a stride; first steps of stiff bodies are shorter
    if (!steps_.empty() && time - steps_.back().time <= (period_ ? same * *period_ : 0.))
      return false;
    const double strides = period_ ? (1. - time) / *period_ : 0.;
    return period_ ? std::abs(strides - std::round(strides)) <= same : time >= 0.4;
  }

  void
  GaitMeter::see_step(const double time, const double displacement, const std::optional<EnergyBalance> &energy_balance)
  {
    if (!keeps_step(time))
      return;
    if (period_ && steps_.size() >= 2)
      steps_.erase(steps_.begin());
    steps_.push_back({time, displacement, energy_balance, smallest_, largest_});
    smallest_ = largest_ = {};
  }

  /// Finds the wave; the steps tell what the samples may have missed.
  std::optional<StretchWave>
  GaitMeter::wave(const std::vector<std::vector<double>> &stretch, const double period) const
  {
    Range smallest, largest;
    for (const StepEnd &step : steps_)
      if (step.time > 1. - period + 1e-9)
      {
        smallest.add(step.smallest);
        largest.add(step.largest);
      }
    return measure_wave(stretch, period, std::max(smallest.to - smallest.from, largest.to - largest.from));
  }

  std::optional<Gait>
  GaitMeter::gait() const
  {
    return period_ ? declared_gait() : found_gait();
  }

  std::optional<Gait>
  GaitMeter::declared_gait() const
  {
    if (samples_.size() <= n_phases || steps_.size() < 2)
      return std::nullopt;
    const StepEnd &from = steps_[steps_.size() - 2], &to = steps_.back();
    if (std::abs(to.time - from.time - *period_) > 1e-9 || std::abs(samples_.back().time - to.time) > 1e-9)
      return std::nullopt;
    std::vector<std::vector<double>> stretch;
    for (unsigned int j = 1; j <= n_phases; ++j)
      stretch.push_back(samples_[j].stretch);
    Gait gait{*period_, true, 1. / *period_, to.displacement - from.displacement, wave(stretch, *period_)};
    if (from.energy_balance && to.energy_balance)
      gait.energy_balance = difference(*to.energy_balance, *from.energy_balance);
    return gait;
  }

  /// Period in steps of the samples: the first shift at which the stretch repeats better than at its neighbours.
  std::optional<double>
  GaitMeter::find_period() const
  {
    if (steps_.size() > max_steps_of_sample * n_searched)
      return std::nullopt;
    const std::size_t first = samples_.size() - n_searched;
    std::vector<double> change(n_searched / 2 + 1, 0.);
    for (std::size_t shift = 1; shift < change.size(); ++shift)
    {
      for (std::size_t j = first; j + shift < samples_.size(); ++j)
        for (unsigned int i = 0; i < n_pieces; ++i)
          change[shift] += square(samples_[j + shift].stretch[i] - samples_[j].stretch[i]);
      change[shift] /= static_cast<double>(samples_.size() - shift - first) * n_pieces;
    }
    const double largest = *std::max_element(change.begin(), change.end());
    if (!(largest > square(1e-6)))
      return std::nullopt;
    // Samples too far apart do not show what happens between them.
    if (change[1] > smooth * largest)
      return std::nullopt;
    for (std::size_t j = 2; j + 1 < change.size(); ++j)
      if (change[j] <= change[j - 1] && change[j] <= change[j + 1])
      {
        const auto x           = static_cast<double>(j);
        const auto [vertex, y] = parabola_vertex(x - 1., change[j - 1], x, change[j], x + 1., change[j + 1]);
        if (y < repeats * largest)
          return vertex;
      }
    return std::nullopt;
  }

  std::optional<Gait>
  GaitMeter::found_gait() const
  {
    if (next_ <= n_samples_ || samples_.size() < n_unknown)
      return std::nullopt;
    const auto shift = find_period();
    if (!shift)
      return std::nullopt;
    const double period = *shift / n_unknown, start = 1. - period;

    std::vector<double> times, values;
    for (std::size_t j = samples_.size() - n_searched; j < samples_.size(); ++j)
      times.push_back(samples_[j].time);
    const CubicSpline in_time(times);
    const auto interpolate = [&](const CubicSpline &spline, const auto &of, const double t) {
      values.clear();
      for (std::size_t j = 0; j < spline.size(); ++j)
        values.push_back(of(j));
      return spline.place(t).value(values, spline.curvatures(values));
    };
    const std::size_t first = samples_.size() - n_searched;
    const double moved      = samples_.back().displacement -
                         interpolate(
                           in_time, [&](const std::size_t j) { return samples_[first + j].displacement; }, start);
    std::vector<std::vector<double>> stretch(n_phases, std::vector<double>(n_pieces));
    for (unsigned int i = 0; i < n_pieces; ++i)
    {
      values.clear();
      for (std::size_t j = first; j < samples_.size(); ++j)
        values.push_back(samples_[j].stretch[i]);
      const auto M = in_time.curvatures(values);
      for (unsigned int phase = 0; phase < n_phases; ++phase)
        stretch[phase][i] = in_time.place(start + period * (phase + 1) / n_phases).value(values, M);
    }
    Gait gait{period, false, 1. / period, moved, wave(stretch, period)};
    if (steps_.size() >= 4 && steps_.front().time < start && steps_.back().energy_balance)
    {
      times.clear();
      for (const StepEnd &step : steps_)
        times.push_back(step.time);
      const CubicSpline at_steps(times);
      EnergyBalance before;
      for (double EnergyBalance::*energy : EnergyBalance::energies())
        before.*energy = interpolate(
          at_steps, [&](const std::size_t j) { return (*steps_[j].energy_balance).*energy; }, start);
      gait.energy_balance = difference(*steps_.back().energy_balance, before);
    }
    return gait;
  }
} // namespace crawler
