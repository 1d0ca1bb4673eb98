// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/sudden_changes.h>
#include <crawler/scene/breaks.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Distance to a break, relative to duration and length, of times and places that count as its sides.
    constexpr double beside = 1e-9;
    /// Change of the stretch below which it is not sudden, and its overshoot is small.
    constexpr double sudden = 1e-5;
    /// Part of a cell that a layer of thickness sqrt(4 D t) must fill to show.
    constexpr double seen = 1.;
  } // namespace

  bool
  SuddenChanges::are_known(const Scene &scene)
  {
    return scene.active_stress->feedback() == nullptr ||
           (EndStretches(scene).are_known() && scene.breaks_in_space().empty());
  }

  SuddenChanges::SuddenChanges(const Scene &scene, const Units &units, const double smallest_cell)
    : units_(units)
    , cell_(smallest_cell)
    , a_(scene.friction_exponent())
    , k_(scene.body.elastic_modulus / units.force)
  {
    if (!are_known(scene))
      return;
    if (scene.active_stress->feedback() != nullptr)
      ends_.emplace(scene);
    starts_ = TimeSegments(*scene.active_stress, scene.end_time).breaks();
    starts_.insert(starts_.begin(), 0.);
    std::vector<double> places = {0., units.length};
    for (const double s : scene.breaks_in_space())
      places.insert(places.end(), {s - beside * units.length, s + beside * units.length});
    moduli_ = profile_at(scene.profiles.elastic_modulus, places);
    for (double &k : moduli_)
      k *= scene.body.elastic_modulus;
    initial_ = profile_at(scene.profiles.initial_stretch, places);
    stress_  = scene.active_stress->at(places);
  }

  std::vector<double>
  SuddenChanges::balanced_at(const double t)
  {
    if (ends_)
      return ends_->balanced(t * units_.time);
    std::vector<double> w(moduli_.size());
    stress_->values(t * units_.time, w);
    std::ranges::transform(w, moduli_, w.begin(), [](const double m, const double k) { return 1. - m / k; });
    return w;
  }

  void
  SuddenChanges::look_at_next_start()
  {
    const double start               = starts_[next_++];
    const std::vector<double> after  = balanced_at(start + beside),
                              before = start > 0. ? balanced_at(start - beside) : initial_;
    double largest = 0., smallest = 1., resistance = 1.; // change, stretch, w^a
    const auto see = [&](const double change, const double w) {
      largest = std::max(largest, std::abs(change));
      if (w > 0.)
        resistance = std::max(resistance, std::pow(w, a_));
    };
    if (start == 0.)
      for (const double w : before)
        see(0., w);
    for (std::size_t end = 0; end < 2; ++end)
      see(after[end] - before[end], after[end]);
    for (std::size_t i = 2; i < after.size(); i += 2)
    {
      const double change = (after[i + 1] - after[i]) - (before[i + 1] - before[i]);
      smallest            = std::min(smallest, std::min(before[i], before[i + 1]) - std::abs(change));
      see(change, 1. + 0.5 * change);
      see(change, 1. - 0.5 * change);
    }
    keeps_stretch_ = start == 0. && smallest > 0.;
    const double k = k_ * (ends_ ? ends_->stiffening() : 1.);
    if (largest > sudden)
      thin_until_ =
        std::max(thin_until_, start + std::min(longest, cell_ * cell_ * seen * seen * resistance / (4. * k)));
  }

  std::optional<std::pair<Extreme, Extreme>>
  SuddenChanges::extremes_if_thin(const double t)
  {
    while (next_ < starts_.size() && starts_[next_] < t)
      look_at_next_start();
    if (!stress_ || !(t < thin_until_))
      return std::nullopt;
    const std::vector<double> w = balanced_at(t);
    if (!std::isfinite(w[0]) || !std::isfinite(w[1]))
      return std::nullopt;
    const Extreme at_left{w[0], 0., t}, at_right{w[1], 1., t};
    return w[0] < w[1] ? std::pair(at_left, at_right) : std::pair(at_right, at_left);
  }

  bool
  SuddenChanges::keeps_stretch_inside(const double t)
  {
    return extremes_if_thin(t) && keeps_stretch_;
  }

  std::optional<double>
  SuddenChanges::stretch_at_end(const double s, const double t)
  {
    const bool is_left = s <= beside;
    if (!stress_ || (!is_left && s < 1. - beside))
      return std::nullopt;
    return balanced_at(std::max(t - beside, 0.))[is_left ? 0 : 1]; // before the jump of the stress
  }
} // namespace crawler
