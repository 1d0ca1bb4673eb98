// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

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
    Pack (*integral)(const LaneMesh<Pack> &, const Pack *);
    void (*end_derivatives)(const LaneMesh<Pack> &, int, const double *, const Pack *, Pack *);
    void (*extremes)(const LaneMesh<Pack> &, int, const double *, const Pack *, Pack *, Pack *, Pack *, Pack *);
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
                                                       LaneKernels<Pack, q>::integral,
                                                       LaneKernels<Pack, q>::end_derivatives,
                                                       LaneKernels<Pack, q>::extremes};

  template <typename Pack>
  inline const LaneKernelTable<Pack> &
  lane_kernels(const unsigned int degree)
  {
    switch (degree)
    {
      case 1:
        return lane_kernel_table<Pack, 1>;
      case 2:
        return lane_kernel_table<Pack, 2>;
      case 3:
        return lane_kernel_table<Pack, 3>;
      case 4:
        return lane_kernel_table<Pack, 4>;
      case 5:
        return lane_kernel_table<Pack, 5>;
      case 6:
        return lane_kernel_table<Pack, 6>;
      case 7:
        return lane_kernel_table<Pack, 7>;
      default:
        return lane_kernel_table<Pack, 8>;
    }
  }
} // namespace crawler::CRAWLER_INSTRUCTION_SET
