// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/group_kernels.h>
#include <crawler/lanes/lane_kernels.h>

/// Loops over all cells for a degree that is chosen at run time (included by lane_systems.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Kernels for one degree, as functions; by default those of bodies side by side.
  template <typename Pack>
  struct LaneKernelTable
  {
    using One = LaneKernels<Pack, 1>; // the functions of all degrees have the same types

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
    decltype(&One::integral) integral;
    decltype(&One::end_derivatives) end_derivatives;
    decltype(&One::extremes) extremes;
  };

  template <typename Pack, int q, typename Own = LaneKernels<Pack, q>>
  constexpr LaneKernelTable<Pack> lane_kernel_table = {Own::residual,
                                                       Own::states,
                                                       Own::balance,
                                                       Own::integrals,
                                                       Own::template factorize<false>,
                                                       Own::template factorize<true>,
                                                       Own::slopes,
                                                       Own::transposed,
                                                       Own::template forward<Pack>,
                                                       Own::template backward<Pack>,
                                                       Own::template forward<Complex<Pack>>,
                                                       Own::template backward<Complex<Pack>>,
                                                       Own::n_blocks,
                                                       Own::integral,
                                                       Own::end_derivatives,
                                                       Own::extremes};

  /// Kernels of one body whose cells are side by side.
  template <int q>
  constexpr LaneKernelTable<double>
  kernels_of_groups()
  {
    LaneKernelTable<double> table = lane_kernel_table<double, q>;
    table.residual                = GroupKernels<q>::residual;
    table.balance                 = GroupKernels<q>::balance;
    table.integrals               = GroupKernels<q>::integrals;
    table.extremes                = GroupKernels<q>::extremes;
    table.factorize               = GroupKernels<q>::template factorize<false>;
    table.factorize_transposed    = GroupKernels<q>::template factorize<true>;
    table.forward                 = GroupKernels<q>::template forward<double>;
    table.backward                = GroupKernels<q>::template backward<double>;
    table.complex_forward         = GroupKernels<q>::template forward<Complex<double>>;
    table.complex_backward        = GroupKernels<q>::template backward<Complex<double>>;
    table.n_blocks                = GroupKernels<q>::n_blocks;
    return table;
  }

  template <int q>
  constexpr LaneKernelTable<double> group_kernel_table = kernels_of_groups<q>();

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
        return group_kernel_table<q>;
    return lane_kernel_table<Pack, q>;
  }
} // namespace crawler::CRAWLER_INSTRUCTION_SET
