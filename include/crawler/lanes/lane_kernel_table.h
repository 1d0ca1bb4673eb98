// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/group_kernels.h>
#include <crawler/lanes/lane_kernels.h>

/// Loops over all cells for a degree that is chosen at run time (included by lane_systems.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Kernels for one degree, as functions.
  template <typename Pack>
  struct LaneKernelTable
  {
    Pack (*residual)(const LaneMesh<Pack> &, const Pack *, const Pack *, const Pack *, Pack *);
    void (*states)(const LaneMesh<Pack> &, const Pack *, const Pack *, Pack *, Pack *, Pack *, Pack *);
    void (*balance)(const LaneMesh<Pack> &, const Pack *, const Pack *, const Pack *, Pack *, Pack *, Pack *);
    void (*integrals)(const LaneMesh<Pack> &, const Pack *, const Pack *, const Pack *, LaneIntegrals<Pack> &);
    void (*factorize)(const LaneMesh<Pack> &,
                      const Pack *,
                      const Pack *,
                      const Pack &,
                      int,
                      const Complex<Pack> *,
                      Pack *,
                      Pack *,
                      Complex<Pack> *,
                      Complex<Pack> *);
    decltype(factorize) factorize_transposed;
    void (*slopes)(const LaneMesh<Pack> &, const Pack *, const Pack *, const LaneSlopes<Pack> &);
    void (*transposed)(const LaneMesh<Pack> &, const LaneSlopes<Pack> &, const Pack *, Pack *, Pack *);
    void (*forward)(int, const Pack *, Pack *);
    void (*backward)(int, const Pack *, Pack *);
    void (*complex_forward)(int, const Complex<Pack> *, Complex<Pack> *);
    void (*complex_backward)(int, const Complex<Pack> *, Complex<Pack> *);
    int (*n_blocks)(int); ///< for which blocks have room
    Pack (*integral)(const LaneMesh<Pack> &, const Pack *);
    void (*end_derivatives)(const LaneMesh<Pack> &, int, const double *, const Pack *, Pack *);
    void (*extremes)(const LaneMesh<Pack> &, int, const double *, const Pack *, LaneLook<Pack> &);
  };

  template <typename Pack, int q>
  constexpr LaneKernelTable<Pack> lane_kernel_table = {LaneKernels<Pack, q>::residual,
                                                       LaneKernels<Pack, q>::states,
                                                       LaneKernels<Pack, q>::balance,
                                                       LaneKernels<Pack, q>::integrals,
                                                       LaneKernels<Pack, q>::template factorize<false>,
                                                       LaneKernels<Pack, q>::template factorize<true>,
                                                       LaneKernels<Pack, q>::slopes,
                                                       LaneKernels<Pack, q>::transposed,
                                                       LaneKernels<Pack, q>::template forward<Pack>,
                                                       LaneKernels<Pack, q>::template backward<Pack>,
                                                       LaneKernels<Pack, q>::template forward<Complex<Pack>>,
                                                       LaneKernels<Pack, q>::template backward<Complex<Pack>>,
                                                       LaneKernels<Pack, q>::n_blocks,
                                                       LaneKernels<Pack, q>::integral,
                                                       LaneKernels<Pack, q>::end_derivatives,
                                                       LaneKernels<Pack, q>::extremes};

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
