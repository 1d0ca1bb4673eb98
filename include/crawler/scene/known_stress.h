// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/evaluators.h>

namespace crawler
{
  /**
   * A generator that knows from the beginning when and where it repeats and jumps, and that has one evaluator for
   * values and rates: what most generators have in common. The constructor fills `facts_`.
   */
  class KnownStress : public ActiveStress
  {
  public:
    std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const override
    {
      return evaluator(points, /*rate=*/false);
    }
    std::unique_ptr<ActiveStressAtPoints>
    rate_at(const std::vector<double> &points) const override
    {
      return facts_.has_rate ? evaluator(points, /*rate=*/true) : nullptr;
    }
    std::optional<double>
    period() const override
    {
      if (!period_)
        period_ = search_period();
      return *period_;
    }
    std::optional<double>
    stride() const override
    {
      return facts_.stride ? facts_.stride : period();
    }
    std::vector<double>
    breaks_in_space() const override
    {
      return facts_.breaks_in_space;
    }
    std::vector<double>
    breaks_in_time() const override
    {
      return facts_.breaks_in_time;
    }

  protected:
    /// As the functions of these names say.
    struct Facts
    {
      std::optional<double> period, stride;                ///< [time]
      std::vector<double> breaks_in_space, breaks_in_time; ///< [length], [time]
      bool has_rate = true;
    };
    Facts facts_;

    /// The stride, which is the period too unless the stress @p starts differently, by a ramp for example.
    void
    set_stride(const std::optional<double> stride, const bool starts)
    {
      facts_.stride = stride;
      facts_.period = starts ? std::nullopt : stride;
    }

  private:
    /// Of m, or of m_t if @p rate.
    virtual std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const = 0;

    /// For a period that it takes long to find (period.h): called once, and only if it is asked for.
    virtual std::optional<double>
    search_period() const
    {
      return facts_.period;
    }

    mutable std::optional<std::optional<double>> period_; ///< once it was asked for
  };
} // namespace crawler
