// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace crawler
{
  // Evaluators of active stresses and feedback at points, made of functions that keep whatever does not depend
  // on time.

  /// An evaluator by a function of the arguments of its values().
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
      function_(arguments...);
    }

  private:
    Function function_;
  };

  /// Makes an evaluator from a function of t [time] and of the list that receives m.
  template <typename Function>
  std::unique_ptr<ActiveStressAtPoints>
  stress_at_points(Function function)
  {
    return std::make_unique<EvaluatorByFunction<ActiveStressAtPoints, Function, double, std::span<double>>>(
      std::move(function));
  }

  /**
   * Makes an evaluator of a sum of waves, which keeps the sines and cosines at the points: factors(i, t) are the
   * constant part of wave i and the factors of sin(q_i s) and cos(q_i s).
   */
  template <typename Factors>
  std::unique_ptr<ActiveStressAtPoints>
  waves_at_points(const std::vector<double> &q, const std::vector<double> &points, Factors factors)
  {
    std::vector<double> sine, cosine; // [wave][point]
    for (const double q_i : q)
      for (const double s : points)
      {
        sine.push_back(std::sin(q_i * s));
        cosine.push_back(std::cos(q_i * s));
      }
    return stress_at_points([n = q.size(), sine, cosine, factors](const double t, const std::span<double> m) {
      std::fill(m.begin(), m.end(), 0.);
      for (std::size_t i = 0; i < n; ++i)
      {
        const auto [constant, of_sine, of_cosine] = factors(i, t);
        const std::size_t first                   = i * m.size();
        for (std::size_t p = 0; p < m.size(); ++p)
          m[p] += constant + of_cosine * cosine[first + p] + of_sine * sine[first + p];
      }
    });
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

  /**
   * Common base of most generators: repetition and jumps are known at construction, and one evaluator gives values and
   * rates. The constructor fills `facts_`.
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
        repetition_ = facts_.search ? facts_.search() : facts_.repetition;
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
    const StretchFeedback *
    feedback() const override
    {
      return facts_.feedback ? &*facts_.feedback : nullptr;
    }
    const ActiveStress *
    prescribed_strain() const override
    {
      return facts_.prescribed_strain.get();
    }

    /// The stress with smooth fronts in place of jumps that move along the body, @p part (above 0, at most 1) as wide
    /// as the widest that fit; null if there are none (the default).
    virtual std::unique_ptr<const ActiveStress>
    with_fronts([[maybe_unused]] double part) const
    {
      return nullptr;
    }

  protected:
    /// Results of the member functions of the same names.
    struct Facts
    {
      std::optional<Repetition> repetition;
      std::function<std::optional<Repetition>()> search; ///< instead, if it takes long: called once, and only if needed
      std::vector<double> breaks_in_space, breaks_in_time; ///< [length], [time]
      bool has_rate = true;
      std::optional<StretchFeedback> feedback;
      std::shared_ptr<const ActiveStress> prescribed_strain;
    };
    Facts facts_;

  private:
    /// Makes an evaluator of m, or of m_t if @p rate.
    virtual std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const = 0;

    mutable std::optional<std::optional<Repetition>> repetition_; ///< set by the first request
  };

  /// An active stress, or a strain, made of functions.
  class StressByFunctions : public KnownStress
  {
  public:
    using Make  = std::function<std::unique_ptr<ActiveStressAtPoints>(const std::vector<double> &points, bool rate)>;
    using Bound = std::function<std::optional<Bounds>(const Box &box)>;

    explicit StressByFunctions(Make make, Bound bound = {})
      : make_(std::move(make))
      , bound_(std::move(bound))
    {
    }

    std::optional<Bounds>
    bounds(const Box &box) const override
    {
      return bound_ ? bound_(box) : std::nullopt;
    }

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, const bool rate) const override
    {
      return make_(points, rate);
    }

    const Make make_;
    const Bound bound_;
  };
} // namespace crawler
