// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crawler
{
  /// A cell of the whole mesh.
  struct Cell
  {
    double left, size;  ///< [length]
    unsigned int level; ///< number of halvings from a cell of the first mesh
    bool is_left_half;  ///< the cell is the left half of its parent

    void
    exchange(auto &archive)
    {
      archive(left, size, level, is_left_half);
    }
  };

  /// Place in a cell.
  struct CellPlace
  {
    unsigned int cell; ///< number of the cell
    double x;          ///< from 0 to 1
  };

  /// Places in their cells.
  inline std::vector<double>
  in_cells(const std::vector<CellPlace> &places)
  {
    std::vector<double> result;
    for (const CellPlace &place : places)
      result.push_back(place.x);
    return result;
  }

  /// Place of the point @p s among all @p cells: in the right one of two that meet there, outside at the next end.
  inline CellPlace
  place_in(const std::vector<Cell> &cells, const double s)
  {
    const auto next = std::ranges::upper_bound(cells, s, {}, &Cell::left);
    const auto c    = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - cells.begin(), 1)) - 1;
    return {static_cast<unsigned int>(c), std::clamp((s - cells[c].left) / cells[c].size, 0., 1.)};
  }

  /// Change of a cell; two halves of a former cell are joined if both are marked.
  enum class CellChange : signed char
  {
    join   = -1,
    keep   = 0,
    divide = 1
  };

  /// The rank that owns a cell: each owns a run of neighbouring cells.
  inline unsigned int
  owner(const std::uint64_t cell, const std::uint64_t n_cells, const std::uint64_t n_ranks)
  {
    return static_cast<unsigned int>(cell * std::min(n_cells, n_ranks) / n_cells);
  }

  /// The first cell of a rank; the number of cells if it owns none.
  inline unsigned int
  first_cell_of(const std::uint64_t rank, const std::uint64_t n_cells, const std::uint64_t n_ranks)
  {
    const std::uint64_t n_owners = std::min(n_cells, n_ranks);
    return static_cast<unsigned int>((std::min(rank, n_owners) * n_cells + n_owners - 1) / n_owners);
  }
} // namespace crawler
