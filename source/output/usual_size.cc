// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/output/usual_size.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr double rare = 0.02;                            ///< of body and time
    constexpr int steps   = 8;                               ///< sizes per factor of two
    constexpr int zero    = std::numeric_limits<int>::min(); ///< step of the size 0
  }                                                          // namespace

  void
  UsualSize::add(const double time, const std::span<const double> row)
  {
    const double duration = time > last_time_ ? time - last_time_ : 0.;
    last_time_            = time;
    for (const double value : row)
    {
      const double size = std::abs(value);
      if (!std::isfinite(size))
        continue;
      largest_ = std::max(largest_, size);
      if (duration == 0.)
        continue;
      const int step = size > 0. ? static_cast<int>(std::floor(steps * std::log2(size))) + 1 : zero;
      const auto place =
        std::lower_bound(durations_.begin(), durations_.end(), step, [](const auto &one, const int wanted) {
          return one.first < wanted;
        });
      if (place != durations_.end() && place->first == step)
        place->second += duration;
      else
        durations_.insert(place, {step, duration});
    }
  }

  double
  UsualSize::value() const
  {
    double above = 0.;
    for (const auto &[step, duration] : durations_)
      above += duration;
    const double allowed = rare * above;
    for (const auto &[step, duration] : durations_)
    {
      above -= duration;
      if (above <= allowed)
        return step > zero ? std::min(largest_, std::exp2(static_cast<double>(step) / steps)) : largest_;
    }
    return largest_;
  }

  FieldRange
  UsualSize::within(const FieldRange &all) const
  {
    const double size = value();
    return {std::clamp(all.first, -size, size), std::clamp(all.second, -size, size)};
  }
} // namespace crawler
