// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/scene/scene.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    /// Relative change of the stretch to both sides of the initial one: a kink there decides nothing.
    constexpr double both_sides = 1e-6;
    /// Negative parts of k + dm/dw, relative to k, that may be round-off.
    constexpr double round_off = 1e-9;

    /// Derivatives of the active stress at t = 0 at points of the body, near its initial state.
    struct Derivatives
    {
      std::vector<double> m, by_stretch, by_rate, by_near;
    };

    Derivatives
    derivatives_at_start(const Scene &scene, const std::vector<double> &points, const double change)
    {
      std::vector<double> w = profile_at(scene.profiles.initial_stretch, points);
      for (double &stretch : w)
        stretch *= 1. + change;
      const std::vector<double> rate(points.size(), change / scene.end_time), zero(points.size());
      Derivatives at                  = {zero, zero, zero, zero};
      const StretchFeedback &feedback = *scene.active_stress->feedback();
      feedback.at(points)->values(0., {w, rate, w, w}, {at.m, at.by_stretch, at.by_rate, at.by_near});
      if (feedback.facts.distance != 0. && feedback.facts.sensor_length == 0.) // an end sees itself
      {
        const std::size_t end = feedback.facts.distance > 0. ? points.size() - 1 : 0;
        at.by_stretch[end] += at.by_near[end];
      }
      return at;
    }
  } // namespace

  void
  require_well_posed_feedback(const Scene &scene)
  {
    if (!scene.active_stress || scene.active_stress->feedback() == nullptr)
      return;
    constexpr unsigned int n            = 37;
    const auto points                   = equal_parts(0., scene.body.length, n);
    const Derivatives around[]          = {derivatives_at_start(scene, points, -both_sides),
                                           derivatives_at_start(scene, points, 0.),
                                           derivatives_at_start(scene, points, both_sides)};
    const std::vector<double> stiffness = profile_at(scene.profiles.elastic_modulus, points);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double k = scene.body.elastic_modulus * stiffness[i];
      const auto all = [&](const auto &violates) { return std::ranges::all_of(around, violates); };
      if (all([&](const Derivatives &at) { return at.by_rate[i] < -round_off * k * scene.end_time; }))
        refuse("Active stress/Generator",
               "the feedback makes the equation ill-posed: at s = {:g}, t = 0 the derivative of "
               "the active stress with respect to w_t is {:.4g}, but 0 or a positive number is "
               "expected",
               points[i],
               around[1].by_rate[i]);
      if (all([&](const Derivatives &at) { return at.by_rate[i] == 0. && at.by_stretch[i] < -(1. + round_off) * k; }))
        refuse("Active stress/Generator",
               "the feedback makes the equation ill-posed: at s = {:g}, t = 0 the derivative of "
               "the active stress with respect to w{} is {:.4g}, but -k, {:.4g}, or more is "
               "expected, or a term with w_t that resists changes of the stretch",
               points[i],
               around[1].by_near[i] != 0. ? " (and to w_near at an end that sees itself)" : "",
               around[1].by_stretch[i],
               -k);
    }
  }
} // namespace crawler
