// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Discretization"; what is left empty is chosen from the wanted accuracy.
  struct DiscretizationParameters
  {
    std::string formulation = "automatic";
    std::string mesh        = "automatic";
    std::optional<double> mesh_tolerance; ///< relative [1]
    std::optional<double> smallest_cell;  ///< [length]
    std::optional<unsigned int> degree;
    std::optional<unsigned int> n_cells;
    std::string share_cells = "automatic";

    void
    add_parameters(Declarations &declarations);

    /// Whether several ranks should share a mesh of @p cells cells.
    bool
    shares(unsigned int cells) const;
  };
} // namespace crawler
