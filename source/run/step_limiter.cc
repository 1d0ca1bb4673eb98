// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/step_limiter.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  StepLimiter::StepLimiter(const std::vector<StepLimit> &limits,
                           const double longest,
                           const ActiveStress &stress,
                           const double min_event)
    : limits_(limits)
    , watch_(min_event > 0. ? std::optional<StressWatch>(std::in_place, stress, 1., min_event)
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
