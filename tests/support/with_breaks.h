// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <memory>
#include <utility>
#include <vector>

namespace crawler::test
{
  /// Active stress that declares its discontinuities.
  class WithBreaks : public ActiveStress
  {
  public:
    WithBreaks(std::shared_ptr<const ActiveStress> stress, std::vector<double> in_space, std::vector<double> in_time)
      : stress_(std::move(stress))
      , in_space_(std::move(in_space))
      , in_time_(std::move(in_time))
    {
    }

    std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const override
    {
      return stress_->at(points);
    }
    std::vector<double>
    breaks_in_space() const override
    {
      return in_space_;
    }
    std::vector<double>
    breaks_in_time() const override
    {
      return in_time_;
    }
    std::optional<double>
    period() const override
    {
      return stress_->period();
    }

  private:
    const std::shared_ptr<const ActiveStress> stress_;
    const std::vector<double> in_space_, in_time_;
  };
} // namespace crawler::test
