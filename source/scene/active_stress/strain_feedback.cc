// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/formula/formula_gradient.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/active_stress/strain_feedback.h>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    const std::string section = "Active stress/Strain feedback/", formula_entry = section + "Active stress";

    /// Numbers of the variables of the formula.
    enum Variable : unsigned int
    {
      s,
      t,
      w,
      w_t,
      w_near,
      w_delayed
    };
    const std::vector<std::string> names = {"s", "t", "w", "w_t", "w_near", "w_delayed"};

    class FormulaFeedback : public FeedbackAtPoints
    {
    public:
      FormulaFeedback(const std::shared_ptr<const Formula> &formula, const std::vector<double> &points)
        : points_(points)
        , gradient_(formula)
      {
      }

      void
      values(const double time, const StretchSeen &seen, const FeedbackStress &m) override
      {
        const std::span<const double> arguments[] = {
          points_, {&time, 1}, seen.stretch, seen.rate, seen.near, seen.delayed};
        const std::span<double> derivatives[] = {{}, {}, m.m_w, m.m_rate, m.m_near};
        gradient_.evaluate(arguments, m.m, derivatives);
      }

    private:
      const std::vector<double> points_;
      FormulaGradient gradient_;
    };

    /// A body that is neither stretched nor moved.
    class AtRest : public ActiveStressAtPoints
    {
    public:
      AtRest(std::unique_ptr<FeedbackAtPoints> feedback, const std::size_t n)
        : feedback_(std::move(feedback))
        , one_(n, 1.)
        , zero_(n, 0.)
      {
      }

      void
      values(const double time, const std::span<double> m) override
      {
        feedback_->values(time, {one_, zero_, one_, one_}, {m, {}, {}, {}});
      }

    private:
      const std::unique_ptr<FeedbackAtPoints> feedback_;
      const std::vector<double> one_, zero_;
    };
  } // namespace

  class StrainFeedback::Feedback : public StretchFeedback
  {
  public:
    Feedback(std::shared_ptr<const Formula> formula, const double distance, const double delay, const double sensor)
      : formula_(std::move(formula))
      , distance_(distance)
      , delay_(delay)
      , sensor_length_(sensor)
    {
    }

    std::unique_ptr<FeedbackAtPoints>
    at(const std::vector<double> &points) const override
    {
      return std::make_unique<FormulaFeedback>(formula_, points);
    }
    bool
    uses_rate() const override
    {
      return formula_->uses(w_t);
    }
    double
    distance() const override
    {
      return formula_->uses(w_near) ? distance_ : 0.;
    }
    double
    delay() const override
    {
      return formula_->uses(w_delayed) ? delay_ : 0.;
    }
    double
    sensor_length() const override
    {
      return formula_->uses(w_near) ? sensor_length_ : 0.;
    }

  private:
    const std::shared_ptr<const Formula> formula_;
    const double distance_, delay_, sensor_length_;

    friend class StrainFeedback;
  };

  void
  StrainFeedbackParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Strain feedback");
    declarations.text(
      "Active stress",
      active_stress,
      "a formula of s, t, w, w_t, w_near, w_delayed",
      "The active stress: s is the material coordinate, t the time, w the stretch, w_t its rate, w_near "
      "the stretch at s + Distance (or at the end of the body) and w_delayed that at t - Delay; "
      "functions as in Expression.",
      "force");
    declarations.text("Constants", constants, "a list name=number, name=number", "Constants that the formula may use.");
    declarations.number("Distance",
                        distance,
                        any_number(),
                        "From s to the place whose stretch is w_near; positive towards s = L.",
                        "length");
    declarations.number("Sensor length",
                        sensor_length,
                        Range{0., std::numeric_limits<double>::infinity(), true, false},
                        "If positive, w_near is the mean stretch of the piece of this length around that place; at "
                        "the ends of the body the piece is moved inside. 0: the stretch at the place.",
                        "length");
    declarations.number("Delay",
                        delay,
                        Range{0., std::numeric_limits<double>::infinity(), true, false},
                        "How long ago the stretch was w_delayed; before t = 0 it was the initial one. Steps are not "
                        "longer than this.",
                        "time");
    declarations.leave();
  }

  StrainFeedback::StrainFeedback(const StrainFeedbackParameters &parameters, const double length, const double end_time)
    : length_(length)
    , end_time_(end_time)
  {
    auto formula = read_formula(
      {"active stress", parameters.active_stress, parameters.constants, formula_entry, section + "Constants", names},
      length,
      end_time);
    const double sensor = parameters.sensor_length;
    if (formula->uses(w_near) && !(sensor == 0. || (sensor >= 1e-6 * length && sensor <= length)))
      throw InputError(
        fmt::format("the formula uses w_near and Sensor length is {:g}, but 0, or a number from 1e-6 L to "
                    "L, L = {:g}, is expected",
                    sensor,
                    length),
        section + "Sensor length");
    if (formula->uses(w_near) &&
        !((parameters.distance != 0. || sensor > 0.) && std::abs(parameters.distance) < length))
      throw InputError(fmt::format("the formula uses w_near and Distance is {:g}, but a number other than 0 between -L "
                                   "and L, L = {:g}, or a Sensor length, is expected",
                                   parameters.distance,
                                   length),
                       section + "Distance");
    if (formula->uses(w_delayed) && !(parameters.delay >= 1e-6 * end_time))
      throw InputError(
        fmt::format("the formula uses w_delayed and Delay is {:g}, but at least 1e-6 of the End time, {:g}, "
                    "is expected",
                    parameters.delay,
                    end_time),
        section + "Delay");
    feedback_ = std::make_shared<const Feedback>(std::move(formula), parameters.distance, parameters.delay, sensor);

    constexpr unsigned int n = 16;
    std::vector<double> points(n + 1), m(n + 1);
    for (unsigned int i = 0; i <= n; ++i)
      points[i] = length * i / n;
    const auto at_rest = at(points);
    for (unsigned int j = 0; j <= n; ++j)
    {
      at_rest->values(end_time * j / n, m);
      for (unsigned int i = 0; i <= n; ++i)
        if (!std::isfinite(m[i]))
          throw InputError(
            fmt::format("the formula \"{}\" gives {} for a body at rest with the stretch 1 at s = {}, t = "
                        "{}; a finite number is expected",
                        parameters.active_stress,
                        m[i],
                        points[i],
                        end_time * j / n),
            formula_entry);
    }
  }

  StrainFeedback::~StrainFeedback() = default;

  std::unique_ptr<ActiveStressAtPoints>
  StrainFeedback::at(const std::vector<double> &points) const
  {
    return std::make_unique<AtRest>(feedback_->at(points), points.size());
  }

  std::vector<double>
  StrainFeedback::breaks_in_space() const
  {
    constexpr int most    = 20; // more are not worth a cell each
    const double distance = feedback_->distance(), sensor = feedback_->sensor_length();
    std::vector<double> places;
    if (sensor * most >= length_)
    {
      // The near stretch has kinks where the sensor comes to an end of the body, and smoother ones where an end of the
      // sensor comes to those.
      for (const double kink : {0.5 * sensor - distance, length_ - 0.5 * sensor - distance})
        if (kink > 0. && kink < length_)
          for (const double place : {kink, kink - distance - 0.5 * sensor, kink - distance + 0.5 * sensor})
            if (place > 0. && place < length_)
              places.push_back(place);
      return places;
    }
    if (distance == 0. || std::abs(distance) * most < length_)
      return places;
    for (int i = 1; std::abs(i * distance) < length_; ++i)
      places.push_back(distance > 0. ? length_ - i * distance : -i * distance);
    return places;
  }

  std::vector<double>
  StrainFeedback::breaks_in_time() const
  {
    constexpr int most = 6; // each is smoother than the one before
    std::vector<double> times;
    for (int i = 1; i <= most && feedback_->delay() > 0. && i * feedback_->delay() < end_time_; ++i)
      times.push_back(i * feedback_->delay());
    return times;
  }

  const StretchFeedback *
  StrainFeedback::feedback() const
  {
    return feedback_.get();
  }
} // namespace crawler
