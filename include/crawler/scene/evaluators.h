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

  /// An evaluator by a function of the arguments of its values(), or by such a member of an object.
  template <typename Interface, typename Function, typename... Arguments>
  class EvaluatorByFunction : public Interface
  {
  public:
    explicit EvaluatorByFunction(Function function)
      : function_(std::move(function))
    {
    }
    void
    values(Arguments... arguments) override
    {
      if constexpr (std::invocable<Function &, Arguments...>)
        function_(arguments...);
      else
        function_.values(arguments...);
    }

  private:
    Function function_;
  };

  /// Makes an evaluator from a function of t [time] and of the list that receives m, or from its values().
  template <typename Function>
  std::unique_ptr<ActiveStressAtPoints>
  stress_at_points(Function function)
  {
    return std::make_unique<EvaluatorByFunction<ActiveStressAtPoints, Function, double, std::span<double>>>(
      std::move(function));
  }

  /// Makes an evaluator from a function of t, the stretch seen and the stress wanted.
  template <typename Function>
  std::unique_ptr<FeedbackAtPoints>
  feedback_at_points(Function function)
  {
    return std::make_unique<
      EvaluatorByFunction<FeedbackAtPoints, Function, double, const StretchSeen &, const FeedbackStress &>>(
      std::move(function));
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
