// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/assembler.h>

namespace crawler
{
  /**
   * Carries a state from one mesh to an adapted one, and from the position form to the log-stretch form.
   *
   * A halved cell keeps its polynomials. In a cell that is joined from two halves the stretch becomes the L2 projection
   * of what it was; so the displacement at the cell's ends, the length of each cell and (degree 2 and above) the
   * cell's centre of mass stay, and elastic energy can only be lost. log w is interpolated or projected, and shifted
   * such that the length of each cell stays. Finally a rigid shift makes the centre of mass exact for every degree.
   */
  class MeshTransfer
  {
  public:
    explicit MeshTransfer(const ReferenceElement &element);

    /// The state @p y of @p from as one of @p to (collective). Meshes may differ by one level; the formulations may be
    /// the same, or position and log stretch. Assembler::make_consistent() must follow.
    std::vector<double>
    transfer(const Assembler &from, std::span<const double> y, const Assembler &to) const;

  private:
    const ReferenceElement &element_;
    std::vector<double> u_half_[2];   ///< [n][n] from a cell's nodes to those of its left and right half
    std::vector<double> log_half_[2]; ///< [q][q] the same for stretch points
    std::vector<double> u_join_;      ///< [n][2q+1] from the nodes of two halves to those of the cell
    std::vector<double> log_join_;    ///< [q][2q] the same for stretch points
  };

  /// The transfer between meshes of a degree, made once for each.
  const MeshTransfer &
  mesh_transfer(unsigned int degree);
} // namespace crawler
