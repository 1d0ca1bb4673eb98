// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/cell.h>
#include <crawler/mesh/reference_element.h>

#include <mpi.h>

#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /**
   * Mesh, element and numbering of the unknowns. Each rank owns a run of neighbouring cells (ranks beyond the number of
   * cells own none). Adaptive meshes are a deal.II parallel::shared::Triangulation<1>. Unknowns are numbered along the
   * body: node i of cell c has the number c*degree + i, so each matrix is a chain of small dense blocks.
   *
   * A rank owns the unknowns of its cells except the first node of its first cell, which the rank to the left owns
   * (rank 0 owns it itself). "Local" arrays hold all nodes of the own cells, including the first: local node number =
   * (cell - first_cell)*degree + i. On the first rank, and in a serial run, owned and local are the same.
   */
  class Discretization
  {
  public:
    /// Makes a mesh of equal cells.
    Discretization(MPI_Comm communicator, double length, unsigned int n_cells, unsigned int degree);

    /// Makes cells between neighbours of @p cell_ends [length], which start with 0 and end with the length.
    Discretization(MPI_Comm communicator, std::vector<double> cell_ends, unsigned int degree);
    ~Discretization();

    /// This mesh with cells divided and joined according to @p changes, given for all cells (the same on all ranks);
    /// neighbours differ by one level at most, so more cells may be divided and fewer joined (collective).
    std::unique_ptr<Discretization>
    adapted(std::vector<CellChange> changes) const;

    const MPI_Comm communicator;
    const double length;
    const ReferenceElement &element;
    const unsigned int rank, n_ranks; ///< this rank, and all of the communicator
    /// The whole mesh from left to right, the same on all ranks; this rank's cells start with number first_cell.
    const std::vector<Cell> cells;
    const unsigned int n_active_ranks; ///< ranks that own cells: 0 ... n_active_ranks - 1
    const unsigned int first_cell;
    const std::vector<double> cell_left, cell_size; ///< left ends and sizes of this rank's cells [length]

    unsigned int
    n_cells() const
    {
      return static_cast<unsigned int>(cells.size());
    }
    std::size_t
    n_unknowns() const
    {
      return cells.size() * element.degree + 1;
    }

    unsigned int
    n_local_cells() const
    {
      return static_cast<unsigned int>(cell_left.size());
    }
    /// Places of those of ascending points that are in this rank's cells, which they are numbered among.
    std::vector<CellPlace>
    own_places(const std::vector<double> &points) const;

    /// Number of local nodes: 0 on a rank without cells.
    std::size_t
    n_local() const
    {
      return cell_left.empty() ? 0 : cell_left.size() * element.degree + 1;
    }
    /// Number of unknowns that this rank owns.
    std::size_t
    n_owned() const
    {
      return n_local() - (has_left_neighbour() ? 1 : 0);
    }
    /// Own part of an array over the unknowns of all ranks.
    std::span<const double>
    owned_part(const std::span<const double> all) const
    {
      return all.subspan(first_cell * element.degree + (has_left_neighbour() ? 1 : 0), n_owned());
    }
    bool
    has_left_neighbour() const
    {
      return rank > 0 && !cell_left.empty();
    }
    bool
    has_right_neighbour() const
    {
      return rank + 1 < n_active_ranks;
    }

    /// Material coordinates [length] of @p places (0 to 1) in the own cells, cell by cell.
    std::vector<double>
    points(const std::vector<double> &places) const;
    /// Those of @p places in own cells, numbered as by own_places().
    std::vector<double>
    points_of(const std::vector<CellPlace> &places) const;

    /// Slope of a field in one of this rank's cells, from its @p local values and the derivatives [n nodes] of the
    /// shape functions at the place.
    double
    slope(const std::span<const double> local, const std::size_t cell, const double *derivatives) const
    {
      double sum = 0.;
      for (std::size_t i = 0; i < element.n; ++i)
        sum += derivatives[i] * local[cell * element.degree + i];
      return sum / cell_size[cell];
    }

    /// Completes a local array from the owned values of all ranks (collective). Returns @p owned itself where nothing
    /// is missing; else fills and returns @p buffer.
    std::span<const double>
    to_local(std::span<const double> owned, std::vector<double> &buffer) const;

    /// Sums local contributions to owned ones (collective): @p local is added up where two ranks share a node.
    void
    add_to_owned(std::span<const double> local, std::span<double> owned) const;

    /// Sums each of these values over all ranks (collective).
    void
    sum_over_ranks(std::span<double> values) const;

    /// Concatenates all ranks' parts of a distributed array, in rank order, on all ranks (collective).
    std::vector<double>
    gather(std::span<const double> own) const;

  private:
    struct Mesh;

    Discretization(MPI_Comm communicator, double length, unsigned int degree, std::shared_ptr<Mesh> mesh);

    std::vector<double>
    of_own_cells(double Cell::*part) const;

    std::shared_ptr<Mesh> mesh_; ///< shared by a sequence of adapted meshes; in the state of the latest
  };
} // namespace crawler
