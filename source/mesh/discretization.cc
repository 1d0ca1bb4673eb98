// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/mesh/discretization.h>
#include <crawler/mesh/triangulation.h>

#include <algorithm>
#include <stdexcept>

namespace crawler
{
  /// Sequence of meshes: cells of one size or between given ends, and their adaptations. Most runs never adapt their
  /// mesh and need no triangulation.
  struct Discretization::Mesh
  {
    /// The cells from left to right.
    std::vector<Cell>
    cells() const
    {
      const double size = length / n_coarse_cells;
      std::vector<Cell> result;
      result.reserve(n_coarse_cells);
      for (unsigned int c = 0; c < n_coarse_cells; ++c)
        result.push_back(ends.empty() ? Cell{c * size, size, 0, false}
                                      : Cell{ends[c], ends[c + 1] - ends[c], 0, false});
      return triangulation ? triangulation->cells(result) : result;
    }

    const double length;
    const unsigned int n_coarse_cells;
    const std::vector<double> ends               = {};      ///< of the coarse cells; empty if these have one size
    std::unique_ptr<Triangulation> triangulation = nullptr; ///< made when the mesh is first adapted
  };

  Discretization::Discretization(MPI_Comm communicator,
                                 const double length,
                                 const unsigned int n_cells,
                                 const unsigned int degree)
    : Discretization(communicator, length, degree, std::make_shared<Mesh>(Mesh{length, n_cells}))
  {
  }

  Discretization::Discretization(MPI_Comm communicator, std::vector<double> cell_ends, const unsigned int degree)
    : Discretization(
        communicator,
        cell_ends.back(),
        degree,
        std::make_shared<Mesh>(Mesh{cell_ends.back(), static_cast<unsigned int>(cell_ends.size() - 1), cell_ends}))
  {
  }

  Discretization::Discretization(MPI_Comm communicator,
                                 const double length,
                                 const unsigned int degree,
                                 std::shared_ptr<Mesh> mesh)
    : communicator(communicator)
    , length(length)
    , element(reference_element(degree))
    , rank(rank_of(communicator))
    , n_ranks(size_of(communicator))
    , cells(mesh->cells())
    , n_active_ranks(std::min(n_cells(), n_ranks))
    , first_cell(first_cell_of(rank, n_cells(), n_ranks))
    , cell_left(of_own_cells(&Cell::left))
    , cell_size(of_own_cells(&Cell::size))
    , mesh_(std::move(mesh))
  {
  }

  Discretization::~Discretization() = default;

  std::vector<double>
  Discretization::of_own_cells(double Cell::*const part) const
  {
    std::vector<double> own;
    for (unsigned int c = first_cell; c < first_cell_of(rank + 1, n_cells(), n_ranks); ++c)
      own.push_back(cells[c].*part);
    return own;
  }

  std::unique_ptr<Discretization>
  Discretization::adapted(std::vector<CellChange> changes) const
  {
    const unsigned int n = n_cells();
    if (!mesh_->triangulation)
    {
      std::vector<double> ends;
      for (const Cell &cell : cells)
        ends.push_back(cell.left);
      ends.push_back(length);
      mesh_->triangulation = create_triangulation(communicator, ends);
    }
    if (mesh_->triangulation->n_cells() != n)
      throw std::logic_error("only the latest of a sequence of meshes can be adapted");

    // Joining takes both halves of a cell.
    for (unsigned int c = 0; c < n; ++c)
      if (changes[c] == CellChange::join)
      {
        const bool is_pair = cells[c].is_left_half && c + 1 < n && cells[c + 1].level == cells[c].level &&
                             changes[c + 1] == CellChange::join;
        if (is_pair)
          ++c;
        else
          changes[c] = CellChange::keep;
      }
    // Neighbours differ by one level at most.
    const auto level = [&](const unsigned int c) {
      return static_cast<int>(cells[c].level) + static_cast<int>(changes[c]);
    };
    const auto keep = [&](const unsigned int c) {
      // The other half is kept too: it cannot be joined alone.
      changes[c]                                     = CellChange::keep;
      changes[cells[c].is_left_half ? c + 1 : c - 1] = CellChange::keep;
    };
    for (bool changed = true; changed;)
    {
      changed = false;
      for (unsigned int c = 0; c < n; ++c)
        for (const int side : {-1, 1})
        {
          if ((side < 0 && c == 0) || (side > 0 && c + 1 == n) || level(c + side) - level(c) <= 1)
            continue;
          if (changes[c] == CellChange::join)
            keep(c);
          else
            changes[c] = CellChange::divide;
          changed = true;
        }
    }
    mesh_->triangulation->change(changes);
    return std::unique_ptr<Discretization>(new Discretization(communicator, length, element.degree, mesh_));
  }

  std::vector<double>
  Discretization::points(const std::vector<double> &places) const
  {
    std::vector<double> points;
    points.reserve(cell_left.size() * places.size());
    for (std::size_t c = 0; c < cell_left.size(); ++c)
      for (const double x : places)
        points.push_back(cell_left[c] + x * cell_size[c]);
    return points;
  }

  std::vector<double>
  Discretization::points_of(const std::vector<CellPlace> &places) const
  {
    std::vector<double> points;
    for (const auto &[cell, x] : places)
      points.push_back(cell_left[cell] + x * cell_size[cell]);
    return points;
  }

  void
  Discretization::sum_over_ranks(const std::span<double> values) const
  {
    if (n_ranks > 1)
      MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, communicator);
  }

  std::vector<double>
  Discretization::gather(const std::span<const double> own) const
  {
    if (n_ranks == 1)
      return {own.begin(), own.end()};
    const int n = static_cast<int>(own.size());
    std::vector<int> counts(n_ranks), offsets(n_ranks, 0);
    MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (unsigned int r = 1; r < counts.size(); ++r)
      offsets[r] = offsets[r - 1] + counts[r - 1];
    std::vector<double> all(static_cast<std::size_t>(offsets.back()) + static_cast<std::size_t>(counts.back()));
    MPI_Allgatherv(own.data(), n, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, communicator);
    return all;
  }

  std::span<const double>
  Discretization::to_local(const std::span<const double> owned, std::vector<double> &buffer) const
  {
    if (n_active_ranks == 1 || n_local() == 0)
      return owned;
    double from_left = 0.;
    const int left   = has_left_neighbour() ? static_cast<int>(rank) - 1 : MPI_PROC_NULL;
    const int right  = has_right_neighbour() ? static_cast<int>(rank) + 1 : MPI_PROC_NULL;
    MPI_Sendrecv(
      &owned.back(), 1, MPI_DOUBLE, right, 0, &from_left, 1, MPI_DOUBLE, left, 0, communicator, MPI_STATUS_IGNORE);
    if (!has_left_neighbour())
      return owned;
    buffer.resize(n_local());
    buffer[0] = from_left;
    std::copy(owned.begin(), owned.end(), buffer.begin() + 1);
    return buffer;
  }

  void
  Discretization::add_to_owned(const std::span<const double> local, const std::span<double> owned) const
  {
    if (n_local() == 0)
      return;
    const bool skip_first = has_left_neighbour();
    if (owned.data() != local.data())
      std::copy(local.begin() + (skip_first ? 1 : 0), local.end(), owned.begin());
    if (n_active_ranks == 1)
      return;
    double from_right = 0.;
    const int left    = has_left_neighbour() ? static_cast<int>(rank) - 1 : MPI_PROC_NULL;
    const int right   = has_right_neighbour() ? static_cast<int>(rank) + 1 : MPI_PROC_NULL;
    MPI_Sendrecv(
      local.data(), 1, MPI_DOUBLE, left, 1, &from_right, 1, MPI_DOUBLE, right, 1, communicator, MPI_STATUS_IGNORE);
    owned.back() += from_right;
  }

  std::vector<CellPlace>
  Discretization::own_places(const std::vector<double> &points) const
  {
    std::vector<CellPlace> places;
    for (const double s : points)
      if (const auto [cell, x] = place_in(cells, s); cell >= first_cell && cell < first_cell + n_local_cells())
        places.push_back({cell - first_cell, x});
    return places;
  }
} // namespace crawler
