// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/cell.h>

#include <mpi.h>

#include <memory>
#include <vector>

namespace crawler
{
  /// The cells of a mesh that is adapted, as deal.II's triangulation (parallel::shared::Triangulation<1>) keeps them.
  class Triangulation
  {
  public:
    /// Cells between neighbours of @p ends [length] (collective).
    Triangulation(MPI_Comm communicator, const std::vector<double> &ends);
    ~Triangulation();

    std::size_t
    n_cells() const;

    /// The cells from left to right, each of them a part of one of the first mesh, @p coarse.
    std::vector<Cell>
    cells(const std::vector<Cell> &coarse) const;

    /// Divides and joins cells (collective): both halves of a cell are joined, and neighbours differ by one level at
    /// most.
    void
    change(const std::vector<CellChange> &changes);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace crawler
