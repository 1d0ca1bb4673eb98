// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/output/scenery.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    // Fractions of the length of the body.
    constexpr double rest_thickness = 0.1, largest_thickness = 1.;
    constexpr double margin = 0.15, strip = 0.015, tick_end = 0.035, tick_width = 0.008, finest_tick = 0.1;
    constexpr double arrow_y = -0.07, arrow_width = 0.035, arrow_length = 0.15;
    constexpr double scale_top = -0.13, scale_bottom = -0.16, scale_length = 0.5;

    constexpr double infinity       = std::numeric_limits<double>::infinity();
    constexpr FieldRange no_numbers = {infinity, -infinity};

    void
    add_rectangle(Corners &corners, const double left, const double right, const double bottom, const double top)
    {
      corners.insert(corners.end(), {left, bottom, 0., right, bottom, 0., right, top, 0., left, top, 0.});
    }

    /// Extends @p drawn to the range @p seen, with @p more on the sides that have grown. Returns true if it has grown
    /// by more than a tenth.
    bool
    grow(FieldRange &drawn, const FieldRange &seen, const double more)
    {
      const double slack = 0.1 * (drawn.second - drawn.first);
      bool grown         = drawn.first > drawn.second; // first range
      if (grown)
        drawn = seen;
      if (seen.first < drawn.first - slack)
      {
        drawn.first = seen.first - more;
        grown       = true;
      }
      if (seen.second > drawn.second + slack)
      {
        drawn.second = seen.second + more;
        grown        = true;
      }
      return grown;
    }

    /// Interpolates a field at equidistant s.
    std::vector<double>
    at_arrows(const Frame &frame, const double length, const std::vector<double> &values)
    {
      std::vector<double> all;
      for (unsigned int i = 0; i < n_arrows; ++i)
      {
        const double s = length * (i + 0.5) / n_arrows;
        const auto after =
          std::clamp<std::ptrdiff_t>(std::upper_bound(frame.s.begin(), frame.s.end(), s) - frame.s.begin(),
                                     1,
                                     static_cast<std::ptrdiff_t>(frame.s.size()) - 1);
        const auto b = static_cast<std::size_t>(after), a = b - 1;
        const double part = (s - frame.s[a]) / (frame.s[b] - frame.s[a]);
        all.push_back(values[a] + part * (values[b] - values[a]));
      }
      return all;
    }
  } // namespace

  Corners
  ribbon(const Frame &frame, const double length)
  {
    const std::size_t n = frame.s.size();
    Corners points(6 * n, 0.);
    for (std::size_t i = 0; i < n; ++i)
    {
      const double w = frame.fields.stretch[i];
      points[6 * i] = points[6 * i + 3] = frame.fields.position[i];
      points[6 * i + 4] = length * (w * largest_thickness > rest_thickness ? rest_thickness / w : largest_thickness);
    }
    return points;
  }

  std::vector<double>
  on_both_edges(const std::vector<double> &values)
  {
    std::vector<double> twice;
    twice.reserve(2 * values.size());
    for (const double value : values)
      twice.insert(twice.end(), 2, value);
    return twice;
  }

  Scenery::Scenery(const double length)
    : length_(length)
    , seen_path_(no_numbers)
    , path_(no_numbers)
  {
    seen_.fill(no_numbers);
    drawn_.fill(no_numbers);
  }

  bool
  Scenery::include(const Frame &frame)
  {
    bool changed = false;
    for (std::size_t f = 0; f < seen_.size(); ++f)
    {
      const auto &values             = frame.fields.*field_names[f].values;
      const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
      seen_[f]                       = {std::min(seen_[f].first, *smallest), std::max(seen_[f].second, *largest)};
      if (field_names[f].has_peaks)
      {
        sizes_[f].add(frame.time, at_arrows(frame, length_, values));
        const FieldRange now = shown(f);
        if (drawn_[f].second - drawn_[f].first > 2. * (now.second - now.first)) // only a peak had been seen
          drawn_[f] = no_numbers;
      }
      changed = grow(drawn_[f], shown(f), 0.) || changed;
      if (field_names[f].values == &Fields::position)
        seen_path_ = {seen_[f].first - margin * length_, seen_[f].second + margin * length_};
    }
    return grow(path_, seen_path_, seen_path_.second - seen_path_.first) || changed;
  }

  void
  Scenery::finish()
  {
    for (std::size_t f = 0; f < drawn_.size(); ++f)
      drawn_[f] = shown(f);
    path_ = seen_path_;
  }

  double
  Scenery::tick_distance() const
  {
    double decade = finest_tick * length_;
    while (true)
    {
      for (const double factor : {1., 2., 5.})
        if ((path_.second - path_.first) / (factor * decade) < max_ground - 2.)
          return factor * decade;
      decade *= 10.;
    }
  }

  Corners
  Scenery::ground() const
  {
    Corners corners;
    add_rectangle(corners, path_.first, path_.second, -strip * length_, 0.);
    const double distance = tick_distance(), half = tick_width * length_ / 2.;
    for (double i = std::ceil(path_.first / distance); i * distance <= path_.second; i += 1.)
      add_rectangle(corners, i * distance - half, i * distance + half, -tick_end * length_, -strip * length_);
    return corners;
  }

  Arrows
  Scenery::arrows(const Frame &frame) const
  {
    const std::vector<double> places = at_arrows(frame, length_, frame.fields.position),
                              forces = at_arrows(frame, length_, frame.fields.friction_force);
    const double y = arrow_y * length_, half = arrow_width * length_ / 2.;
    constexpr auto is_friction = [](const FieldName &field) { return field.values == &Fields::friction_force; };
    const double usual         = sizes_[std::ranges::find_if(field_names, is_friction) - field_names].value();
    Arrows arrows;
    for (unsigned int i = 0; i < n_arrows; ++i)
    {
      const double share = usual > 0. ? std::clamp(forces[i] / usual, -1., 1.) : 0.,
                   size  = -arrow_length * length_ * share;
      const double x     = places[i];
      arrows.points.insert(arrows.points.end(), {x, y - half, 0., x + size, y, 0., x, y + half, 0.});
      arrows.friction_force.insert(arrows.friction_force.end(), 3, forces[i]);
    }
    return arrows;
  }

  Corners
  Scenery::scale() const
  {
    Corners corners;
    add_rectangle(
      corners, path_.first, path_.first + scale_length * length_, scale_bottom * length_, scale_top * length_);
    return corners;
  }
} // namespace crawler
