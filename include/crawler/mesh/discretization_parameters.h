// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>

#include <optional>

namespace crawler
{
  class Declarations;

  /// Unknowns of the equation chosen by the user.
  enum class FormulationEntry
  {
    position,
    stretch,
    automatic
  };
  template <>
  struct Words<FormulationEntry>
  {
    static constexpr const char *list[] = {"position", "stretch", "automatic"};
  };

  enum class MeshKind
  {
    uniform,
    adaptive,
    automatic
  };
  template <>
  struct Words<MeshKind>
  {
    static constexpr const char *list[] = {"uniform", "adaptive", "automatic"};
  };

  enum class ShareCells
  {
    automatic,
    yes,
    no
  };
  template <>
  struct Words<ShareCells>
  {
    static constexpr const char *list[] = {"automatic", "yes", "no"};
  };

  /// Section "Discretization"; empty entries are chosen from the wanted accuracy.
  struct DiscretizationParameters
  {
    FormulationEntry formulation = FormulationEntry::automatic;
    MeshKind mesh                = MeshKind::automatic;
    std::optional<double> mesh_tolerance; ///< relative [1]
    std::optional<double> smallest_cell;  ///< [length]
    std::optional<unsigned int> degree;
    std::optional<unsigned int> n_cells;
    ShareCells share_cells = ShareCells::automatic;

    void
    add_parameters(Declarations &declarations);

    /// True if several ranks should share a mesh of @p cells cells.
    bool
    shares(unsigned int cells) const;
  };
} // namespace crawler
