// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <concepts>
#include <functional>
#include <utility>

namespace crawler
{
  // Evaluators of active stresses and feedback at points, made of functions that keep whatever does not depend
  // on time.

  /// Makes an evaluator from a function of t [time] and of the list that receives m, or from its values().
  template <typename Function>
  std::unique_ptr<ActiveStressAtPoints>
  stress_at_points(Function function)
  {
    struct AtPoints : public ActiveStressAtPoints
    {
      explicit AtPoints(Function function)
        : function(std::move(function))
      {
      }
      void
      values(const double t, const std::span<double> m) override
      {
        if constexpr (std::invocable<Function &, double, std::span<double>>)
          function(t, m);
        else
          function.values(t, m);
      }
      Function function;
    };
    return std::make_unique<AtPoints>(std::move(function));
  }

  /// Makes an evaluator from a function of t, the stretch seen and the stress wanted.
  template <typename Function>
  std::unique_ptr<FeedbackAtPoints>
  feedback_at_points(Function function)
  {
    struct AtPoints : public FeedbackAtPoints
    {
      explicit AtPoints(Function function)
        : function(std::move(function))
      {
      }
      void
      values(const double t, const StretchSeen &seen, const FeedbackStress &m) override
      {
        function(t, seen, m);
      }
      Function function;
    };
    return std::make_unique<AtPoints>(std::move(function));
  }

  /// A feedback whose properties are known at construction.
  class KnownFeedback : public StretchFeedback
  {
  public:
    /// Results of the member functions of the same names.
    struct Facts
    {
      bool uses_rate  = false;
      double distance = 0., delay = 0., sensor_length = 0.; ///< [length], [time], [length]
    };
    using Make = std::function<std::unique_ptr<FeedbackAtPoints>(const std::vector<double> &points)>;

    KnownFeedback(const Facts &facts, Make make)
      : facts_(facts)
      , make_(std::move(make))
    {
    }

    std::unique_ptr<FeedbackAtPoints>
    at(const std::vector<double> &points) const override
    {
      return make_(points);
    }
    bool
    uses_rate() const override
    {
      return facts_.uses_rate;
    }
    double
    distance() const override
    {
      return facts_.distance;
    }
    double
    delay() const override
    {
      return facts_.delay;
    }
    double
    sensor_length() const override
    {
      return facts_.sensor_length;
    }

  private:
    const Facts facts_;
    const Make make_;
  };
} // namespace crawler
