// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// A scene to compute, and how. Both are the caller's.
  struct SceneToCompute
  {
    const RunParameters *parameters;
    const Scene *scene;
  };

  /// Numerics that similar scenes share.
  struct SharedChoice
  {
    NumericsChoice choice;
    double relative_tolerance; ///< of the time integration, relative to the size of the displacement
    std::vector<double> sizes; ///< of the displacements of the examples [length]

    /// The numerics of a scene whose displacement is about of this @p size [length].
    NumericsChoice
    choice_for(const Scene &scene, double size) const;
  };

  /**
   * Measures on @p examples what similar scenes need (doc/numerics.md, "Sweeps"). The rule of choose_numerics() gives a
   * reference for them; then the number of cells, and the method and tolerance of the time integration, are made as
   * cheap as they can be while the displacement of no example differs by more than a small part of Accuracy.
   *
   * Nothing if the examples are of different kinds, do not fit the fused engine or have no bound that could be compared
   * with what is wanted, or if @p keep_going says no.
   */
  std::optional<SharedChoice>
  shared_choice(std::span<const SceneToCompute> examples, const std::function<bool()> &keep_going);
} // namespace crawler
