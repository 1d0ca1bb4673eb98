// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/step_limiter.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  StressWatch::StressWatch(const ActiveStress &stress, const double least)
    : stress_(stress.at({0., 1., 0.2837, 0.6142}))
    , least_(least)
  {
  }

  bool
  StressWatch::is_calm(const double from, const double to)
  {
    constexpr double golden = 0.6180339887498949;
    Values start            = end_, end;
    if (end_time_ != from)
      stress_->values(from, start);
    std::array<double, n_inside> x; // one in each third of the step
    for (unsigned int i = 0; i < n_inside; ++i)
    {
      random_ = std::fmod(random_ + golden, 1.);
      x[i]    = (i + 0.1 + 0.8 * random_) / n_inside;
      stress_->values(from + x[i] * (to - from), inside_[i]);
    }
    stress_->values(to, end);
    // Value in the middle from the polynomial through the others.
    const double y = x[1], a = x[0], b = x[2];
    const double of_start = (y - a) * (y - b) * (y - 1.) / (-a * b),
                 of_end   = y * (y - a) * (y - b) / ((1. - a) * (1. - b)),
                 of_a     = y * (y - b) * (y - 1.) / (a * (a - b) * (a - 1.)),
                 of_b     = y * (y - a) * (y - 1.) / (b * (b - a) * (b - 1.));
    double largest        = 0.;
    for (unsigned int p = 0; p < n_places; ++p)
    {
      largest_              = std::max(largest_, std::abs(end[p]));
      const double expected = of_start * start[p] + of_end * end[p] + of_a * inside_[0][p] + of_b * inside_[2][p];
      largest               = std::max(largest, std::abs(inside_[1][p] - expected));
    }
    if (largest > std::max(least_, min_event * largest_))
      return false;
    end_time_ = to;
    end_      = end;
    return true;
  }

  StepLimiter::StepLimiter(const std::vector<StepLimit> &limits,
                           const double longest,
                           const ActiveStress &stress,
                           const double min_event)
    : limits_(limits)
    , watch_(min_event > 0. ? std::optional<StressWatch>(std::in_place, stress, min_event)
                            : std::optional<StressWatch>())
  {
    if (limits_.empty())
      limits_.push_back({0., HUGE_VAL});
    for (StepLimit &limit : limits_)
      limit.longest = std::min(limit.longest, longest);
  }

  double
  StepLimiter::longest_step(const double t) const
  {
    const auto after =
      std::find_if(limits_.begin(), limits_.end(), [t](const StepLimit &limit) { return limit.from > t; });
    return after == limits_.begin() ? HUGE_VAL : std::prev(after)->longest;
  }

  bool
  StepLimiter::passed_over_event(const double from, const double to)
  {
    constexpr double shortest = 1e-6, part = 0.125;
    if (!watch_ || to - from <= shortest || watch_->is_calm(from, to))
      return false;
    const StepLimit later{to, longest_step(to)};
    const auto begin =
      std::find_if(limits_.begin(), limits_.end(), [from](const StepLimit &limit) { return limit.from > from; });
    const auto after = std::find_if(begin, limits_.end(), [to](const StepLimit &limit) { return limit.from > to; });
    limits_.insert(limits_.erase(begin, after), {{from, part * (to - from)}, later});
    return true;
  }

  void
  StepLimiter::restart()
  {
    if (watch_)
      watch_->restart();
  }
} // namespace crawler
