// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/host_laws.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace crawler
{
  namespace
  {
    bool
    are_positive(const std::span<const double> values)
    {
      return std::ranges::all_of(values, [](const double value) { return value > 0. && std::isfinite(value); });
    }
  } // namespace

  HostLaws::HostLaws(const Scene &scene, const std::vector<double> &points)
    : k(profile_at(scene.profiles.elastic_modulus, points))
    , b(profile_at(scene.profiles.friction, points))
    , scene_(scene)
    , points_(points)
    , x_(points.size())
    , feedback_(scene.active_stress->feedback() != nullptr ? scene.active_stress->feedback()->at(points) : nullptr)
  {
  }

  LaneBody
  lane_body(const Scene &scene, HostLaws *const laws)
  {
    LaneBody body{.k = scene.body.elastic_modulus, .a = scene.body.friction_exponent()};
    if (laws != nullptr)
    {
      body.k_profile        = laws->k.data();
      body.friction_profile = laws->b.data();
      body.direction        = scene.ground.direction;
      body.host             = laws;
    }
    return body;
  }

  bool
  HostLaws::evaluate(const LanePoints &at)
  {
    const std::size_t n = points_.size();
    bool good           = true;
    const auto span     = [n](auto *values) { return std::span(values, values != nullptr ? n : 0); };
    if (at.g != nullptr)
    {
      scene_.friction->values(span(at.w), span(at.g), span(at.w_dg));
      good = are_positive(span(at.g));
    }
    if (at.c != nullptr)
    {
      for (std::size_t i = 0; i < n; ++i)
        x_[i] = points_[i] + at.u[i];
      scene_.ground.profile->values(x_, span(at.c), span(at.c_x));
      good = good && are_positive(span(at.c));
    }
    if (at.m != nullptr)
      feedback_->values(
        at.t, {span(at.w), span(at.rate), {}, {}}, {span(at.m), span(at.m_w), span(at.m_rate), std::span<double>()});
    return good;
  }

  HostCellLaws::HostCellLaws(const Scene &scene, const std::vector<double> &middles)
    : scene_(scene)
    , laws_(scene, middles)
  {
  }

  double
  HostCellLaws::evaluate_cells(
    const double t, const double *m, const double *w, const double *rate, CellLaws<double> &at_cells)
  {
    const std::size_t n = laws_.friction.size();
    const long bad      = laws_.evaluate(t, {w, n}, {rate, n}, m);
    // Power laws fail only where the stretch is lost.
    if (bad >= 0 && w[bad] > 0. && !scene_.friction->is_power_law)
      bad_friction = {w[bad], laws_.friction[static_cast<std::size_t>(bad)]};
    at_cells                = laws_.at_cells();
    const bool may_be_empty = scene_.friction_exponent() < 0.;
    return bad >= 0 ? -1. : may_be_empty ? 1. : *std::min_element(w, w + n);
  }
} // namespace crawler
