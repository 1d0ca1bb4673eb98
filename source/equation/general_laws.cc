// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/bracketed_root.h>
#include <crawler/equation/crawler_equation.h>
#include <crawler/equation/general_laws.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace crawler
{
  FrictionAtPoints::FrictionAtPoints(const Scene &scene, std::vector<double> points)
    : scene_(scene)
    , points_(std::move(points))
    , b_(profile_at(scene.profiles.friction, points_))
    , x_(points_.size())
    , c_(points_.size(), 1.)
    , slope_(points_.size(), 0.)
  {
    for (auto *field : {&g, &w_dg, &sliding, &f, &f_u, &f_v, &w_f_w})
      field->resize(points_.size());
  }

  long
  FrictionAtPoints::evaluate(const std::span<const double> u,
                             const std::span<const double> v,
                             const std::span<const double> w)
  {
    const Ground &ground                   = scene_.ground;
    const auto [ratio, switching_velocity] = ground.direction;
    equation::DirectionFactor<double> direction{1., 1.};
    scene_.friction->values(w, g, w_dg);
    if (ground.profile)
    {
      for (std::size_t i = 0; i < x_.size(); ++i)
        x_[i] = points_[i] + u[i];
      ground.profile->values(x_, c_, slope_);
    }
    long bad = -1;
    for (std::size_t i = 0; i < x_.size(); ++i)
    {
      if (ratio != 1.)
        direction = equation::direction_factor(ratio, switching_velocity, v[i], std::tanh(v[i] / switching_velocity));
      const auto here = equation::sliding(b_[i], c_[i], slope_[i], direction, v[i]);
      sliding[i]      = here.force;
      f[i]            = equation::friction_force(g[i], here.force);
      f_u[i]          = g[i] * here.by_u;
      f_v[i]          = g[i] * here.by_v;
      w_f_w[i]        = w_dg[i] * here.force;
      if (bad < 0 && !(c_[i] > 0. && std::isfinite(c_[i])))
        bad = static_cast<long>(i);
    }
    return bad;
  }

  std::function<BadLaw(const Units &)>
  FrictionAtPoints::describe(const long point) const
  {
    return [c = c_[static_cast<std::size_t>(point)], x = x_[static_cast<std::size_t>(point)]](const Units &units) {
      return BadLaw{fmt::format("the profile of the ground is {} at x = {:.6g}, which the body has reached; a positive "
                                "number is expected",
                                std::isnan(c) ? "not known" : fmt::format("{:.6g}", c),
                                x * units.length),
                    "Ground/Profile"};
    };
  }

  BodyForceAtPoints::BodyForceAtPoints(const Scene &scene, const std::vector<double> &points)
    : k(profile_at(scene.profiles.elastic_modulus, points))
    , N(points.size())
    , m(points.size())
  {
    for (double &value : k)
      value *= scene.body.elastic_modulus;
    by_w                            = k;
    const StretchFeedback *feedback = scene.active_stress->feedback();
    if (feedback == nullptr)
    {
      stress_ = scene.active_stress->at(points);
      return;
    }
    feedback_ = feedback->at(points);
    if (feedback->facts.uses_rate)
      by_rate.resize(points.size());
    if (feedback->facts.sees_near())
      by_near.resize(points.size());
  }

  void
  BodyForceAtPoints::evaluate(const double t,
                              const std::span<const double> e,
                              const StretchSeen &seen,
                              const double *known_m)
  {
    if (feedback_)
    {
      feedback_->values(t, seen, {m, by_w, by_rate, by_near});
      for (std::size_t i = 0; i < k.size(); ++i)
        by_w[i] += k[i];
    }
    else if (known_m != nullptr)
      std::copy_n(known_m, m.size(), m.begin());
    else
      stress_->values(t, m);
    for (std::size_t i = 0; i < k.size(); ++i)
      N[i] = equation::body_force(e[i], m[i], k[i]);
  }

  EndStretches::EndStretches(const Scene &scene)
    : stress_(*scene.active_stress)
    , force_(scene, {0., scene.body.length})
  {
  }

  bool
  EndStretches::are_known() const
  {
    const StretchFeedback *feedback = stress_.feedback();
    return feedback == nullptr || (!feedback->facts.uses_rate && !feedback->facts.sees_near() &&
                                   feedback->facts.delay == 0. && stress_.failures() == nullptr);
  }

  std::pair<double, double>
  EndStretches::at(const double t)
  {
    constexpr int n_stretches = 32;    // since with feedback the force may fall with the stretch
    constexpr double small    = 1e-12; // where laws like w*log(w) are defined
    if (stress_.feedback() == nullptr)
    {
      evaluate(t, 0.);
      return {-force_.N[0] / force_.k[0], -force_.N[1] / force_.k[1]};
    }
    std::pair<double, double> balance(std::nan(""), std::nan(""));
    for (int i = 0; i <= n_stretches; ++i)
    {
      evaluate(t, std::max(static_cast<double>(i) / n_stretches, small));
      balance.first  = std::fmax(balance.first, -force_.N[0] / force_.k[0]);
      balance.second = std::fmax(balance.second, -force_.N[1] / force_.k[1]);
      if (balance.first > 0. && balance.second > 0.)
        break;
    }
    return balance;
  }

  std::vector<double>
  EndStretches::balanced(const double t)
  {
    std::vector<double> stretches;
    for (const std::size_t end : {0, 1})
    {
      const auto force = [&](const double w) {
        evaluate(t, w);
        stiffening_ = std::max(stiffening_, force_.by_w[end] / force_.k[end]);
        return force_.N[end];
      };
      double near     = 1.;
      const double at = force(near), factor = at > 0. ? 0.5 : 2.;
      double far = factor;
      while (far > 1e-12 && far < 1e12 && force(far) * at > 0.)
      {
        near = far;
        far *= factor;
      }
      stretches.push_back(at == 0.                ? 1.
                          : force(far) * at <= 0. ? bracketed_root(force, std::min(near, far), std::max(near, far))
                                                  : std::nan(""));
    }
    return stretches;
  }

  void
  EndStretches::evaluate(const double t, const double w)
  {
    const std::array<double, 2> stretch{{w, w}}, strain{{w - 1., w - 1.}};
    force_.evaluate(t, strain, {stretch, {}, {}, {}});
  }

  StretchElsewhere::StretchElsewhere(const Scene &scene,
                                     const Discretization &discretization,
                                     const std::vector<double> &points)
    : discretization_(discretization)
    , points_(points)
  {
    const StretchFeedback *feedback = scene.active_stress->feedback();
    if (feedback == nullptr)
      return;
    if (feedback->facts.sees_near())
    {
      std::vector<double> others = points;
      for (double &s : others)
        s += feedback->facts.distance;
      near_places_.emplace(discretization.cells, discretization.element, others, feedback->facts.sensor_length);
      near.resize(points.size());
    }
    delay_ = feedback->facts.delay;
    if (delay_ > 0.)
    {
      at_start_ = profile_at(scene.profiles.initial_stretch, points);
      delayed   = at_start_;
    }
  }

  void
  StretchElsewhere::evaluate(const double t, const std::span<const double> u, const StretchHistory *history)
  {
    const auto to_stretch = [](std::vector<double> &values) {
      for (double &value : values)
        value += 1.;
    };
    if (near_places_)
      near_strain(u, near);
    to_stretch(near);
    if (delay_ == 0.)
      return;
    const StretchHistory::Step *step = history != nullptr && t > delay_ ? history->find(t - delay_) : nullptr;
    if (step == nullptr)
    {
      delayed = at_start_;
      return;
    }
    auto known =
      std::find_if(places_.begin(), places_.end(), [&](const auto &entry) { return entry.first == step->cells; });
    if (known == places_.end())
    {
      constexpr std::size_t most = 4;
      if (places_.size() == most)
        places_.erase(places_.begin());
      places_.emplace_back(step->cells, StrainPlaces(*step->cells, *step->element, points_));
      known = places_.end() - 1;
    }
    StretchHistory::displacement(*step, t - delay_, then_);
    known->second.evaluate(then_, delayed);
    to_stretch(delayed);
  }

  void
  StretchElsewhere::near_strain(const std::span<const double> u, const std::span<double> strain) const
  {
    near_places_->evaluate(discretization_.gather(u), strain);
  }
} // namespace crawler
