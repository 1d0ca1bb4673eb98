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
    /// Part of a cell that a layer of thickness sqrt(4 D t) must fill to show, and the part of the duration up to which
    /// layers are thin at most.
    constexpr double seen = 1., longest = 1e-3;
  } // namespace

  SuddenChanges::SuddenChanges(const Scene &scene, const Units &units, const double smallest_cell)
    : units_(units)
    , cell_(smallest_cell)
    , a_(scene.friction_exponent())
    , k_(scene.body.elastic_modulus / units.force)
  {
    if (scene.active_stress->feedback() != nullptr)
      return;
    starts_ = TimeSegments(*scene.active_stress, scene.end_time).breaks();
    starts_.insert(starts_.begin(), 0.);
    std::vector<double> places = {0., units.length};
    for (const double s : scene.breaks_in_space())
      places.insert(places.end(), {s - beside * units.length, s + beside * units.length});
    moduli_ = profile_at(scene.profiles.elastic_modulus, places);
    for (double &k : moduli_)
      k *= scene.body.elastic_modulus;
    m_.resize(places.size());
    stress_ = scene.active_stress->at(places);
  }

  SuddenChanges::Stresses
  SuddenChanges::at(const double t)
  {
    stress_->values(t * units_.time, m_);
    Stresses stresses{{1. - m_[0] / moduli_[0], 1. - m_[1] / moduli_[1]}, {}};
    for (std::size_t i = 2; i + 1 < m_.size(); i += 2)
      stresses.jumps.push_back(m_[i + 1] / moduli_[i + 1] - m_[i] / moduli_[i]);
    return stresses;
  }

  void
  SuddenChanges::look_at_next_start()
  {
    const double start   = starts_[next_++];
    const Stresses after = at(start + beside);
    Stresses before{{1., 1.}, std::vector<double>(after.jumps.size(), 0.)};
    if (start > 0.)
      before = at(start - beside);
    double largest    = std::max(std::abs(after.end_stretch.first - before.end_stretch.first),
                              std::abs(after.end_stretch.second - before.end_stretch.second));
    double resistance = 1.; // largest w^a
    const auto see    = [&](const double w) {
      if (w > 0.)
        resistance = std::max(resistance, std::pow(w, a_));
    };
    see(after.end_stretch.first);
    see(after.end_stretch.second);
    for (std::size_t i = 0; i < after.jumps.size(); ++i)
    {
      const double change = std::abs(after.jumps[i] - before.jumps[i]);
      largest             = std::max(largest, change);
      see(1. + 0.5 * change);
      see(1. - 0.5 * change);
    }
    if (largest > sudden)
      thin_until_ =
        std::max(thin_until_, start + std::min(longest, cell_ * cell_ * seen * seen * resistance / (4. * k_)));
  }

  std::optional<std::pair<Extreme, Extreme>>
  SuddenChanges::extremes_if_thin(const double t)
  {
    while (next_ < starts_.size() && starts_[next_] < t)
      look_at_next_start();
    if (!stress_ || !(t < thin_until_))
      return std::nullopt;
    const auto [left, right] = at(t).end_stretch;
    const Extreme at_left{left, 0., t}, at_right{right, 1., t};
    return left < right ? std::pair(at_left, at_right) : std::pair(at_right, at_left);
  }

  std::optional<double>
  SuddenChanges::stretch_at_end(const double s, const double t)
  {
    const bool is_left = s <= beside;
    if (!stress_ || (!is_left && s < 1. - beside))
      return std::nullopt;
    const auto [left, right] = at(std::max(t - beside, 0.)).end_stretch; // before the jump of the stress
    return is_left ? left : right;
  }
} // namespace crawler
