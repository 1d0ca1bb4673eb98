// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/given_motion.h>

namespace crawler
{
  BodyAtPoints::BodyAtPoints(const Scene &scene, const std::vector<double> &points)
    : friction(scene.friction)
    , friction_profile(profile_at(scene.profiles.friction, points))
    , elastic_modulus(profile_at(scene.profiles.elastic_modulus, points))
  {
    for (double &k : elastic_modulus)
      k *= scene.body.elastic_modulus;
  }

  void
  GivenMotion::find(const GaussPanels &panels,
                    const std::span<const double> strain,
                    const std::span<const double> rate,
                    const BodyAtPoints &body,
                    const bool with_slopes)
  {
    const auto &weights = panels.weights();
    for (auto *const list : {&w, &g, &w_dg, &B_t, &v, &gv})
      list->resize(weights.size());
    panels.running_integral(rate, B_t);
    for (std::size_t i = 0; i < w.size(); ++i)
      w[i] = 1. + strain[i];
    body.friction->values(w, g, with_slopes ? std::span<double>(w_dg) : std::span<double>());
    for (std::size_t i = 0; i < w.size(); ++i)
    {
      g[i] *= body.friction_profile[i];
      w_dg[i] *= body.friction_profile[i];
    }
    double length = 0., g_sum = 0., B_t_sum = 0.;
    for (std::size_t i = 0; i < w.size(); ++i)
    {
      length += weights[i];
      g_sum += weights[i] * g[i];
      B_t_sum += weights[i] * B_t[i];
    }
    g_mean                = g_sum / length;
    const double B_t_mean = B_t_sum / length;
    double covariance     = 0.; // gives the mean of v without cancellation
    for (std::size_t i = 0; i < w.size(); ++i)
      covariance += weights[i] * (g[i] - g_mean) * (B_t[i] - B_t_mean);
    velocity = -covariance / g_sum;
    drift    = velocity - B_t_mean;
    for (std::size_t i = 0; i < w.size(); ++i)
    {
      v[i]  = B_t[i] + drift;
      gv[i] = g[i] * v[i];
    }
  }
} // namespace crawler
