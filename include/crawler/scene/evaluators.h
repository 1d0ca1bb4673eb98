// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <concepts>
#include <functional>
#include <utility>

namespace crawler
{
  // Evaluators of active stresses, strains and feedback at points, made of functions that keep whatever does not depend
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

  /// A strain by evaluators that write it as they would an active stress.
  class StrainByEvaluators : public StrainHistory
  {
  public:
    /// Evaluators of the strain [1] and of its rate [1/time].
    using Evaluators = std::pair<std::unique_ptr<ActiveStressAtPoints>, std::unique_ptr<ActiveStressAtPoints>>;
    using Make       = std::function<Evaluators(const std::vector<double> &points)>;
    using Bound      = std::function<std::optional<FieldBounds>(const SpaceTimeBox &box)>;

    explicit StrainByEvaluators(Make make, Bound bound = {})
      : make_(std::move(make))
      , bound_(std::move(bound))
    {
    }

    std::unique_ptr<StrainAtPoints>
    at(const std::vector<double> &points) const override
    {
      struct AtPoints : public StrainAtPoints
      {
        explicit AtPoints(Evaluators both)
          : both(std::move(both))
        {
        }
        void
        strain(const double t, const std::span<double> e) override
        {
          both.first->values(t, e);
        }
        void
        rate(const double t, const std::span<double> e_t) override
        {
          both.second->values(t, e_t);
        }
        const Evaluators both;
      };
      return std::make_unique<AtPoints>(make_(points));
    }

    std::optional<FieldBounds>
    bounds(const SpaceTimeBox &box) const override
    {
      return bound_ ? bound_(box) : std::nullopt;
    }

  private:
    const Make make_;
    const Bound bound_;
  };
} // namespace crawler
