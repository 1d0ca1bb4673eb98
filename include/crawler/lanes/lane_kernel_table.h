// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/cell_group.h>
#include <crawler/lanes/lane_blocks.h>

#include <cstddef>

/// Loops over all cells for a degree that is chosen at run time (included by lane_systems.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Kernels for one degree, as functions.
  template <typename Pack>
  struct LaneKernelTable
  {
    using One = LaneBlocks<OneCell<Pack>, 1>; // the functions of all degrees and groups have the same types

    decltype(&One::residual) residual;
    decltype(&One::states) states;
    decltype(&One::balance) balance;
    decltype(&One::integrals) integrals;
    decltype(&One::template factorize<false>) factorize, factorize_transposed;
    decltype(&One::slopes) slopes;
    decltype(&One::transposed) transposed;
    decltype(&One::template forward<Pack>) forward, backward;
    decltype(&One::template forward<Complex<Pack>>) complex_forward, complex_backward;
    decltype(&One::n_blocks) n_blocks; ///< for which blocks have room
    decltype(&One::extremes) extremes;
  };

  /// The kernels of the adjoint and of states compute one cell at a time for any group.
  template <typename Group,
            int q,
            typename Number = typename Group::Number,
            typename Own    = LaneBlocks<Group, q>,
            typename Single = LaneBlocks<OneCell<Number>, q>>
  constexpr LaneKernelTable<Number> lane_kernel_table = {Own::residual,
                                                         Single::states,
                                                         Own::balance,
                                                         Own::integrals,
                                                         Own::template factorize<false>,
                                                         Own::template factorize<true>,
                                                         Single::slopes,
                                                         Single::transposed,
                                                         Own::template forward<Number>,
                                                         Own::template backward<Number>,
                                                         Own::template forward<Complex<Number>>,
                                                         Own::template backward<Complex<Number>>,
                                                         Own::n_blocks,
                                                         Own::extremes};

  /// Kernels for bodies with so many cells. Of one body alone the cells take the lanes if they fill half of them.
  template <typename Pack, int q = 1>
  inline const LaneKernelTable<Pack> &
  lane_kernels(const unsigned int degree, const std::size_t n_cells)
  {
    if constexpr (q < 8)
      if (degree > q)
        return lane_kernels<Pack, q + 1>(degree, n_cells);
    if constexpr (PackTraits<Pack>::size == 1)
      if (2 * n_cells >= std::size_t(CellGroup::width))
        return lane_kernel_table<CellGroup, q>;
    return lane_kernel_table<OneCell<Pack>, q>;
  }
} // namespace crawler::CRAWLER_INSTRUCTION_SET
