// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/field_sampler.h>
#include <crawler/output/usual_size.h>

#include <array>
#include <iterator>
#include <utility>
#include <vector>

namespace crawler
{
  /// The whole body at one time, in the user's units.
  struct Frame
  {
    double time;
    unsigned int step;
    unsigned int points_per_cell;
    std::vector<double> s; ///< of the points of all cells, ends included: two at each border of cells [length]
    Fields fields;
  };

  /// Points of triangles or quadrilaterals one after another, each with x, y and z.
  using Corners = std::vector<double>;

  /// Thickness of the drawn body: its area is kept, so L/10 over the stretch, but at most L.
  double
  thickness(double stretch, double length);

  /**
   * The drawn body of a rest length @p length [length]: it lies on the ground, y = 0, at its present place. For each
   * point of the frame there is one at the ground and one at the upper edge.
   */
  Corners
  ribbon(const Frame &frame, double length);

  /// Values at the points of the frame for those of the ribbon.
  std::vector<double>
  on_both_edges(const std::vector<double> &values);

  /// A place on the body where the force of the ground is drawn as an arrow.
  struct Grip
  {
    double position, friction_force;
  };
  constexpr unsigned int n_grips = 24;

  /// At equidistant s.
  std::vector<Grip>
  grips(const Frame &frame, double length);

  /// What is seen besides the body: the ground below its path, the size of the arrows, and scales of the fields.
  class Scenery
  {
  public:
    explicit Scenery(double length);

    /// Takes account of one more frame. True if ground or scales have changed: they change rarely, since they grow by
    /// more than is needed at once.
    bool
    include(const Frame &frame);

    /// Ground and scales become exactly what all frames need.
    void
    finish();

    /// Quadrilaterals, at most @p most_ground: a strip under the body's path, and ticks below it.
    Corners
    ground() const;
    static constexpr std::size_t most_ground = 64;

    /// Distance of the ticks [length]: 1, 2 or 5 times a power of ten, times L/10.
    double
    tick_distance() const;

    /// Triangles, an arrow for each place: forces of the ground on the body. 0.15 L long is the usual size of the
    /// frames so far; no arrow is longer.
    Corners
    arrows(const std::vector<Grip> &grips) const;

    /// A quadrilateral below the left end of the ground; the fields go from their smallest value on its left to their
    /// largest one, those with peaks within their usual size.
    Corners
    scale() const;
    /// In the order of field_names.
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

    /// What is drawn of a field.
    FieldRange
    shown(std::size_t field) const;
  };
} // namespace crawler
