// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/reference_element.h>

#include <mpi.h>

#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /**
   * Mesh, element and numbering of the unknowns. The mesh is a deal.II parallel::shared::Triangulation<1> in which each
   * rank owns a run of neighbouring cells (ranks beyond the number of cells own none). Unknowns are numbered along the
   * body: node i of cell c has the number c*degree + i, so each matrix is a chain of small dense blocks.
   *
   * A rank owns the unknowns of its cells except the first node of its first cell, which the rank to the left owns
   * (rank 0 owns that too). "Local" arrays hold all nodes of the own cells, that first one included: local node
   * number = (cell - first_cell)*degree + i. On the first rank, and in a serial run, owned and local are the same.
   */
  class Discretization
  {
  public:
    Discretization(MPI_Comm communicator, double length, unsigned int n_cells, unsigned int degree);
    ~Discretization();

    MPI_Comm
    communicator() const
    {
      return communicator_;
    }
    const ReferenceElement &
    element() const
    {
      return element_;
    }
    double
    length() const
    {
      return length_;
    }
    unsigned int
    n_cells() const
    {
      return n_cells_;
    }
    std::size_t
    n_unknowns() const
    {
      return static_cast<std::size_t>(n_cells_) * element_.degree + 1;
    }

    /// The cells of this rank: left ends [length] and sizes [length].
    const std::vector<double> &
    cell_left() const
    {
      return cell_left_;
    }
    const std::vector<double> &
    cell_size() const
    {
      return cell_size_;
    }
    unsigned int
    n_local_cells() const
    {
      return static_cast<unsigned int>(cell_left_.size());
    }
    /// Number of local nodes: 0 on a rank without cells.
    std::size_t
    n_local() const
    {
      return cell_left_.empty() ? 0 : cell_left_.size() * element_.degree + 1;
    }
    /// Number of unknowns that this rank owns.
    std::size_t
    n_owned() const
    {
      return n_local() - (has_left_neighbour() ? 1 : 0);
    }
    bool
    has_left_neighbour() const
    {
      return rank_ > 0 && !cell_left_.empty();
    }
    bool
    has_right_neighbour() const
    {
      return rank_ + 1 < n_active_ranks_;
    }
    unsigned int
    rank() const
    {
      return rank_;
    }
    /// All ranks of the communicator.
    unsigned int
    n_ranks() const
    {
      return n_ranks_;
    }
    /// Ranks that own cells: 0 ... n_active_ranks() - 1.
    unsigned int
    n_active_ranks() const
    {
      return n_active_ranks_;
    }

    /// Material coordinates of all quadrature points of the own cells, cell by cell [length].
    std::vector<double>
    quadrature_points() const;

    /// A local array from the owned values of all ranks (collective). Returns @p owned itself where nothing is
    /// missing; else fills and returns @p buffer.
    std::span<const double>
    to_local(std::span<const double> owned, std::vector<double> &buffer) const;

    /// Owned sums from local contributions (collective): @p local is added up where two ranks share a node.
    void
    add_to_owned(std::span<const double> local, std::span<double> owned) const;

  private:
    void
    make_mesh();

    const MPI_Comm communicator_;
    const double length_;
    const unsigned int n_cells_;
    const ReferenceElement element_;
    unsigned int rank_, n_ranks_;
    unsigned int n_active_ranks_;
    std::vector<double> cell_left_, cell_size_;

    struct Mesh; ///< deal.II's objects, kept out of this header
    std::unique_ptr<Mesh> mesh_;
  };
} // namespace crawler
