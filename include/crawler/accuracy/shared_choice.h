// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>

#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Numerics that similar scenes share.
  struct SharedChoice
  {
    NumericsChoice choice;
    double relative_tolerance; ///< tolerance of the time integration, relative to the size of the displacement
    std::vector<double> sizes; ///< sizes of the displacements of the examples [length]

    /// Numerics of a scene whose displacement is about of this @p size [length].
    NumericsChoice
    choice_for(const Scene &scene, double size) const;
  };

  /**
   * Measures on @p examples the numerics that similar scenes need (doc/numerics.md, "Sweeps"). The rule of
   * choose_numerics() gives a reference for them; then the number of cells, and the method and tolerance of the time
   * integration, are made as cheap as possible while the displacement of no example differs by more than a small part
   * of Accuracy.
   *
   * Nothing if the examples are of different kinds, do not fit the fused engine or have no bound that could be compared
   * with the wanted error, or if their runs were not to go on.
   */
  std::optional<SharedChoice>
  shared_choice(std::span<const Problem> examples);
} // namespace crawler
