// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/formula/formula_breaks.h>
#include <crawler/formula/formula_gradient.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/active_stress/strain_feedback.h>
#include <crawler/scene/breaks.h>

#include <fmt/format.h>

#include <cmath>

namespace crawler
{
  namespace
  {
    const std::string strain_feedback_section = "Active stress/Strain feedback/",
                      formula_entry           = strain_feedback_section + "Active stress";

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

    std::unique_ptr<FeedbackAtPoints>
    formula_feedback(const std::shared_ptr<const Formula> &formula, const std::vector<double> &points)
    {
      return feedback_at_points([points, gradient = FormulaGradient(formula)](
                                  const double time, const StretchSeen &seen, const FeedbackStress &m) mutable {
        const std::span<const double> arguments[] = {
          points, {&time, 1}, seen.stretch, seen.rate, seen.near, seen.delayed};
        const std::span<double> derivatives[] = {{}, {}, m.m_w, m.m_rate, m.m_near};
        gradient.evaluate(arguments, m.m, derivatives);
      });
    }
  } // namespace

  void
  StrainFeedbackParameters::add_parameters(Declarations &declarations)
  {
    declarations.text("Active stress", active_stress, "a formula of s, t, w, w_t, w_near, w_delayed", "force")
      .means(
        "The active stress: s is the material coordinate, t the time, w the stretch, w_t its rate, w_near the stretch "
        "at s + Distance (or at the end of the body) and w_delayed that at t - Delay; functions as in Expression.");
    declarations.constants("Constants", constants, {"Active stress"}).means("Constants that the formula may use.");
    declarations.number("Distance", distance, any_number(), "length")
      .means("Distance from s to the place whose stretch is w_near; positive towards s = L.");
    declarations.number("Sensor length", sensor_length, not_negative(), "length")
      .means("If positive, w_near is the mean stretch of the piece of this length around that place; at the ends of "
             "the body the piece is shifted inwards. 0: the stretch at the place.");
    declarations.number("Delay", delay, not_negative(), "time")
      .means("Time by which w_delayed lags behind the stretch; before t = 0 it is the initial stretch. Time steps are "
             "not longer than this.");
  }

  std::optional<BadFact>
  bad_fact(const StretchFeedback::Facts &facts, const double length, const double end_time)
  {
    const auto &[uses_rate, distance, delay, sensor] = facts;
    if (!(std::abs(distance) < length))
      return BadFact{"Distance", distance, fmt::format("a number between {:g} and {:g}", -length, length)};
    if (!(delay == 0. || (delay >= 1e-6 * end_time && std::isfinite(delay))))
      return BadFact{"Delay", delay, fmt::format("0, or at least {:g},", 1e-6 * end_time)};
    if (!(sensor == 0. || (sensor >= 1e-6 * length && sensor <= length)))
      return BadFact{"Sensor length", sensor, fmt::format("0, or a number from {:g} to {:g},", 1e-6 * length, length)};
    return std::nullopt;
  }

  StrainFeedback::StrainFeedback(const StrainFeedbackParameters &parameters, const double length, const double end_time)
  {
    const FormulaInput input           = {"active stress",
                                          parameters.active_stress,
                                          parameters.constants,
                                          formula_entry,
                                          strain_feedback_section + "Constants",
                                          names};
    const auto formula                 = read_formula(input, length, end_time);
    const StretchFeedback::Facts facts = {.uses_rate     = formula->uses(w_t),
                                          .distance      = formula->uses(w_near) ? parameters.distance : 0.,
                                          .delay         = formula->uses(w_delayed) ? parameters.delay : 0.,
                                          .sensor_length = formula->uses(w_near) ? parameters.sensor_length : 0.};
    std::optional<BadFact> bad         = bad_fact(facts, length, end_time);
    if (formula->uses(w_near) && !facts.sees_near())
      bad = {"Distance", 0., "a number other than 0, or a Sensor length,"};
    if (formula->uses(w_delayed) && facts.delay == 0.)
      bad = {"Delay", 0., fmt::format("at least 1e-6 of the End time, {:g},", end_time)};
    if (bad)
      refuse(strain_feedback_section + bad->name,
             "the formula uses {} and {} is {:g}, but {} is expected",
             bad->name == "Delay" ? "w_delayed" : "w_near",
             bad->name,
             bad->value,
             bad->expected);
    const FormulaBreaks breaks = formula_breaks(formula, length, end_time);
    facts_.feedback            = StretchFeedback{
      facts,
      [formula, ends = breaks.in_space.value_or(std::vector<double>()), length](const std::vector<double> &points) {
        return formula_feedback(formula, off_breaks_at_ends(points, ends, length));
      }};
    facts_.has_rate        = false;
    facts_.breaks_in_space = breaks.in_space.value_or(std::vector<double>());
    facts_.breaks_in_time  = breaks.in_time.value_or(std::vector<double>());

    require_finite_values(*this, input, " for a body at rest with the stretch 1", length, end_time);
  }

  std::unique_ptr<ActiveStressAtPoints>
  StrainFeedback::evaluator(const std::vector<double> &points, bool) const
  {
    const std::vector<double> one(points.size(), 1.), zero(points.size(), 0.);
    return stress_at_points(
      [at = facts_.feedback->at(points), one, zero](const double time, const std::span<double> m) {
        at->values(time, {one, zero, one, one}, {m, {}, {}, {}});
      });
  }
} // namespace crawler
