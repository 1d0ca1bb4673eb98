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
  inline constexpr const char *words_of<FormulationEntry>[] = {"position", "stretch", "automatic"};

  enum class MeshKind
  {
    uniform,
    adaptive,
    automatic
  };
  template <>
  inline constexpr const char *words_of<MeshKind>[] = {"uniform", "adaptive", "automatic"};

  enum class ShareCells
  {
    automatic,
    yes,
    no
  };
  template <>
  inline constexpr const char *words_of<ShareCells>[] = {"automatic", "yes", "no"};

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
