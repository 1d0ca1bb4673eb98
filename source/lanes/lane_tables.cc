// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/lane_tables.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <map>

namespace crawler
{
  LaneTables::LaneTables(const LaneMethod &method)
    : method_(method)
    , element_(reference_element(method.degree))
    , sample_places_(method.is_stretch ? element_.stretch_points : element_.sample_places)
  {
    const RadauTableau &tableau = radau_tableau(method.n_stages);
    const bool uniform          = method.cell_ends.empty();
    for (unsigned int c = 0; c < method.n_cells; ++c)
    {
      sizes_.push_back(uniform ? 1. / method.n_cells : method.cell_ends[c + 1] - method.cell_ends[c]);
      for (const double place : method.is_stretch ? sample_places_ : element_.points)
        points.push_back(uniform ? (c + place) / method.n_cells : method.cell_ends[c] + place * sizes_[c]);
    }
    setup            = {method.degree,
                        method.n_cells,
                        method.n_stages,
                        sizes_.data(),
                        element_.tables(),
                        static_cast<unsigned int>(sample_places_.size()),
                        (method.is_stretch ? element_.stretch_derivatives : element_.sample_derivatives).data(),
                        {tableau.c.data(),
                         tableau.b.data(),
                         tableau.inverse.data(),
                         tableau.error_weights.data(),
                         tableau.newton_fraction,
                         tableau.real_eigenvalue,
                         parts(tableau.eigenvalues),
                         parts(tableau.vectors),
                         parts(tableau.rows)}};
    setup.is_stretch = method.is_stretch;
    setup.laws       = method.laws;
  }

  double
  LaneTables::smallest_size() const
  {
    return *std::ranges::min_element(sizes_);
  }

  double
  LaneTables::place_of_sample(const unsigned int number) const
  {
    const unsigned int cell = number / setup.n_samples;
    const double place      = sample_places_[number % setup.n_samples];
    return method_.cell_ends.empty() ? (cell + place) / method_.n_cells
                                     : method_.cell_ends[cell] + place * sizes_[cell];
  }

  void
  state_within(const LaneStep &step, const LaneSetup &setup, const double time, const std::span<double> y)
  {
    const int s                       = static_cast<int>(setup.n_stages);
    double weights[radau::max_stages] = {};
    radau::collocation_weights(s, setup.method.c, 1. - (step.time - time) / step.size, weights);
    weights[s - 1] -= 1.; // weights are for the state relative to y at the end
    const std::size_t n = y.size();
    for (std::size_t d = 0; d < n; ++d)
    {
      double sum = step.y[d * step.stride];
      for (int j = 0; j < s; ++j)
        sum += weights[j] * step.z[(static_cast<std::size_t>(j) * n + d) * step.stride];
      y[d] = sum;
    }
  }

  std::shared_ptr<const LaneTables>
  lane_tables(const LaneMethod &method)
  {
    constexpr std::size_t max_kept = 1000; // a sweep may have a mesh of its own at each point
    static std::map<LaneMethod, std::shared_ptr<const LaneTables>> known;
    const auto found = known.find(method);
    if (found != known.end())
      return found->second;
    if (known.size() == max_kept)
      known.clear();
    return known[method] = std::make_shared<LaneTables>(method);
  }

  bool
  fits_lanes(const Scene &scene)
  {
    const StretchFeedback *feedback = scene.active_stress->feedback();
    return feedback == nullptr || (!feedback->facts.sees_near() && feedback->facts.delay == 0.);
  }

  unsigned int
  lane_laws(const Scene &scene)
  {
    if (scene.is_plain())
      return LaneLaws::plain;
    const StretchFeedback *feedback = scene.active_stress->feedback();
    unsigned int bits               = LaneLaws::general;
    const auto add = [&bits](const bool has, const LaneLaws::Bits bit) { bits |= has ? bit : LaneLaws::plain; };
    add(scene.ground.direction.is_uneven(), LaneLaws::direction);
    add(!scene.friction->is_power_law, LaneLaws::host_friction);
    add(scene.ground.profile != nullptr, LaneLaws::host_ground);
    add(feedback != nullptr, LaneLaws::feedback);
    add(feedback != nullptr && feedback->facts.uses_rate, LaneLaws::rate);
    return bits;
  }
} // namespace crawler
