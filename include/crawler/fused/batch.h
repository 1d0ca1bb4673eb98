// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/reference_element.h>
#include <crawler/fused/lane_engine.h>
#include <crawler/scene/scene.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Element, mesh and method of a fused run.
  struct FusedMethod
  {
    unsigned int degree, n_cells, n_stages;

    auto
    operator<=>(const FusedMethod &) const = default;
  };

  struct RadauTableau;

  /// The tables of a method, as the engine wants them.
  class FusedTables
  {
  public:
    explicit FusedTables(const FusedMethod &method);
    FusedTables(const FusedTables &) = delete;

    /// Quadrature points of all cells, for a body of length 1.
    std::vector<double> points;
    LaneSetup setup;

    /// s/L of a sample (LaneStep).
    double
    place_of_sample(unsigned int number) const;

  private:
    const FusedMethod method_;
    const ReferenceElement element_;
    std::vector<double> sample_places_, samples_, eigenvalues_, vectors_, rows_;
  };

  /// Kept from call to call.
  const FusedTables &
  fused_tables(const FusedMethod &method);

  /// Scratch memory of the engine: so many doubles, aligned to its packs, all 0.
  struct FusedMemoryFree
  {
    void
    operator()(double *memory) const;
  };
  using FusedMemory = std::unique_ptr<double, FusedMemoryFree>;
  FusedMemory
  fused_memory(std::size_t n);

  /// The formulation `automatic` changes to log stretch when the stretch falls below this.
  constexpr double small_stretch = 0.1;

  /// Can the engine compute this scene?
  bool
  fits_fused(const Scene &scene);

  /// A scene to compute from rest to its end; all numbers are in the scene's units.
  struct FusedRun
  {
    const Scene *scene;
    double tolerance, initial_step, largest_step;
    unsigned int most_steps;
  };

  struct FusedResult
  {
    bool finished;       ///< if not, only the full path can tell why
    double displacement; ///< of the centre of mass [length]
    double min_stretch, min_stretch_s, min_stretch_t, max_stretch, max_stretch_s, max_stretch_t;
    unsigned int steps, rejected_steps;
    unsigned long newton_iterations;
  };

  /// Computes all @p runs side by side with one method. The result of a run does not depend on the others.
  std::vector<FusedResult>
  run_batch(const FusedMethod &method, std::span<const FusedRun> runs, const LaneEngine &engine = batch_engine());
} // namespace crawler
