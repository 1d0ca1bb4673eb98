// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/cell.h>

#include <mpi.h>

#include <memory>
#include <vector>

namespace crawler
{
  /// Cells of an adaptive mesh, kept by deal.II's triangulation (parallel::shared::Triangulation<1>).
  class Triangulation
  {
  public:
    Triangulation()          = default;
    virtual ~Triangulation() = default;

    Triangulation(const Triangulation &) = delete;
    Triangulation &
    operator=(const Triangulation &) = delete;

    virtual std::size_t
    n_cells() const = 0;

    /// The cells from left to right, each a part of a cell of the first mesh, @p coarse.
    virtual std::vector<Cell>
    cells(const std::vector<Cell> &coarse) const = 0;

    /// Divides and joins cells (collective): both halves of a cell are joined, and neighbours differ by at most one
    /// level.
    virtual void
    change(const std::vector<CellChange> &changes) = 0;
  };

  /// Creates cells between neighbours of @p ends [length] (collective). Throws FileError if deal.II cannot be loaded.
  std::unique_ptr<Triangulation>
  create_triangulation(MPI_Comm communicator, const std::vector<double> &ends);

  /// Its implementation in the library that links deal.II (source/deal_ii).
  using CreateTriangulation = Triangulation *(MPI_Comm communicator, const std::vector<double> &ends);
} // namespace crawler
