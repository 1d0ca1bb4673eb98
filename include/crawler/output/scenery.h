// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>
#include <crawler/output/usual_size.h>

#include <array>
#include <iterator>
#include <vector>

namespace crawler
{
  /// Vertices of triangles or quadrilaterals, one after another, each with x, y and z.
  using Corners = std::vector<double>;

  /**
   * The drawn body of rest length @p length [length] on the ground, y = 0, at its present place. Each point of the
   * frame gives one at the ground and one at the upper edge. The body is L/10 over the stretch thick, which keeps its
   * area, but at most L.
   */
  Corners
  ribbon(const Frame &frame, double length);

  /// Values at the points of the ribbon from those at the points of the frame.
  std::vector<double>
  on_both_edges(const std::vector<double> &values);

  /// Triangles that show the forces of the ground on the body, with the friction force at each corner.
  struct Arrows
  {
    Corners points;
    std::vector<double> friction_force;
  };
  constexpr unsigned int n_arrows = 24;

  /// Surroundings of the body: the ground below its path, the size of the arrows, and scales of the fields.
  class Scenery
  {
  public:
    explicit Scenery(double length);

    /// Includes one more frame. Returns true if ground or scales have changed, which is rare, since they grow by more
    /// than is needed at once.
    bool
    include(const Frame &frame);

    /// Sets ground and scales to exactly what all frames need.
    void
    finish();

    /// Quadrilaterals, at most @p max_ground: a strip under the body's path, and ticks below it.
    Corners
    ground() const;
    static constexpr std::size_t max_ground = 64;

    /// Distance of the ticks [length]: 1, 2 or 5 times a power of ten, times L/10.
    double
    tick_distance() const;

    /// Arrows at equidistant s. One 0.15 L long is the usual size in the frames so far; none is longer.
    Arrows
    arrows(const Frame &frame) const;

    /// A quadrilateral below the left end of the ground, whose fields go from their smallest value on the left to their
    /// largest on the right, those with peaks within their usual size.
    Corners
    scale() const;
    /// Ranges in the order of field_names.
    const std::array<FieldRange, std::size(field_names)> &
    ranges() const
    {
      return drawn_;
    }

    void
    exchange(Archive &archive)
    {
      archive(sizes_, seen_, drawn_, seen_path_, path_);
    }

  private:
    double length_;
    std::array<UsualSize, std::size(field_names)> sizes_;         ///< of the fields with peaks
    std::array<FieldRange, std::size(field_names)> seen_, drawn_; ///< of the fields; the path is that of the position
    FieldRange seen_path_, path_;

    /// Range drawn of a field.
    FieldRange
    shown(const std::size_t field) const
    {
      return field_names[field].has_peaks ? sizes_[field].within(seen_[field]) : seen_[field];
    }
  };
} // namespace crawler
