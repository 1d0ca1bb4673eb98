// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/position_form.h>

namespace crawler
{
  /**
   * Carries a state of the position form from one mesh to an adapted one.
   *
   * A halved cell keeps its polynomials. In a cell joined from two halves the stretch becomes its L2 projection; so the
   * displacement at the cell's ends, the length of each cell and (degree 2 and above) the cell's centre of mass stay,
   * and elastic energy can only be lost. Finally a rigid shift makes the centre of mass exact for every degree.
   */
  class MeshTransfer
  {
  public:
    explicit MeshTransfer(const ReferenceElement &element);

    /// Transfers the state @p y of @p from to the mesh of @p to (collective). Meshes may differ by one level.
    std::vector<double>
    transfer(const PositionForm &from, std::span<const double> y, const PositionForm &to) const;

  private:
    const ReferenceElement &element_;
    std::vector<double> u_half_[2]; ///< [n][n] matrices from a cell's nodes to those of its left and right half
    std::vector<double> u_join_;    ///< [n][2q+1] matrix from the nodes of two halves to those of the cell
  };

  /// Transfer between meshes of a degree, made once for each.
  const MeshTransfer &
  mesh_transfer(unsigned int degree);
} // namespace crawler
