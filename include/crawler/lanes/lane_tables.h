// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/scene/scene.h>

#include <boost/align/aligned_allocator.hpp>

#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /// Element, mesh and method of a fused run.
  struct LaneMethod
  {
    unsigned int degree, n_cells, n_stages;
    std::vector<double> cell_ends = {};    ///< cell ends of a body of length 1 (mesh/graded_mesh.h)
    bool is_stretch               = false; ///< the stretch form, of degree 1
    bool other_rule               = false; ///< see stretch_method()
    unsigned int laws             = 0;     ///< LaneLaws::Bits of the scene

    auto // NOLINTNEXTLINE(modernize-use-nullptr): what the compiler makes of default
    operator<=>(const LaneMethod &) const = default;
  };

  struct RadauTableau;

  /// Tables of a method, in the form that the engine reads.
  class LaneTables
  {
  public:
    explicit LaneTables(const LaneMethod &method);
    LaneTables(const LaneTables &) = delete;

    /// Quadrature points of all cells, for a body of length 1; in the stretch form their middles.
    std::vector<double> points;
    LaneSetup setup;

    /// Size of the smallest cell, for a body of length 1.
    double
    smallest_size() const;

    /// Place s/L of a sample (LaneStep).
    double
    place_of_sample(unsigned int number) const;

  private:
    const LaneMethod method_;
    const ReferenceElement &element_;
    std::vector<double> sizes_;
    const std::vector<double> &sample_places_; ///< in a cell
  };

  /// Dense output: the state at a time of the step, [unknowns] (in natural units).
  void
  state_within(const LaneStep &step, const LaneSetup &setup, double time, std::span<double> y);

  /// Tables of a method; the latest are kept from call to call.
  std::shared_ptr<const LaneTables>
  lane_tables(const LaneMethod &method);

  /// Scratch memory of the engine: doubles aligned to its packs.
  using LaneStorage = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

  /// Smallest stretch admitted in a batch.
  constexpr double small_stretch = 0.1;

  /// True if the engine can compute this scene in the position form.
  bool
  fits_lanes(const Scene &scene);

  /// LaneLaws::Bits of the scene.
  unsigned int
  lane_laws(const Scene &scene);
} // namespace crawler
