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
      const auto found = repetition();
      return found && found->from == 0. ? std::optional(found->period) : std::nullopt;
    }
    std::optional<Repetition>
    repetition() const override
    {
      if (!repetition_)
        repetition_ = search_repetition();
      return *repetition_;
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
      std::optional<Repetition> repetition;
      std::vector<double> breaks_in_space, breaks_in_time; ///< [length], [time]
      bool has_rate = true;
    };
    Facts facts_;

  private:
    /// Of m, or of m_t if @p rate.
    virtual std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const = 0;

    /// For a repetition that it takes long to find (period.h): called once, and only if it is asked for.
    virtual std::optional<Repetition>
    search_repetition() const
    {
      return facts_.repetition;
    }

    mutable std::optional<std::optional<Repetition>> repetition_; ///< once it was asked for
  };
} // namespace crawler
