// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cstdint>

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
} // namespace crawler
