// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/point_laws.h>
#include <crawler/mesh/reference_element.h>

namespace crawler
{
  class FrictionLaw;

  /// Input of the integrals over a run of cells. Arrays over nodes are local ones (discretization.h).
  struct CellInput
  {
    unsigned int n_cells;
    const double *cell_size;
    const ReferenceElement *element;
    const FrictionLaw *friction;
    double k;                                ///< elastic modulus
    const double *u;                         ///< displacement at the nodes
    const double *v;                         ///< velocity at the nodes; may be null in residual(), for no friction
    const double *m;                         ///< active stress at the quadrature points
    const PointLaws<double> *laws = nullptr; ///< laws of a general scene, in place of k, m and friction
  };

  /// Integrals over the body for the energy balance; see theory.md section 1 for their relations.
  struct CellIntegrals
  {
    double displacement   = 0.; ///< int u ds
    double elastic_energy = 0.; ///< int k/2 (w-1)^2 ds
    double stress_power   = 0.; ///< -int m v_s ds
    double positive_power = 0.; ///< int max(-m v_s, 0) ds
    double absolute_power = 0.; ///< int |m v_s| ds, the scale of the energy balance's tolerance
    double dissipation    = 0.; ///< int g v^2 ds
    double net_friction   = 0.; ///< int g v ds, zero
    double abs_friction   = 0.; ///< int |g v| ds, its scale
    double velocity       = 0.; ///< int v ds
  };

  /**
   * Loops over cells, compiled for each degree so that the compiler unrolls them. With phi_i the shape functions:
   *
   *   residual   F_i = int f phi_i + int N phi_i,s (added to F); f = g(w) v, N = m + k (w - 1) of plain scenes
   *   blocks     by_state dF_i/du_j + by_velocity dF_i/dv_j, a dense block of each cell
   *   integrals  CellIntegrals, added
   *   forces     N and f at the quadrature points
   *   states     u, v, strain and rate of the stretch at the quadrature points
   */
  struct CellKernels
  {
    /// Returns the local quadrature point number (cell*n + point) of the first stretch that is not positive, or -1.
    long (*residual)(const CellInput &, double *F);
    void (*blocks)(const CellInput &, double by_state, double by_velocity, double *blocks);
    void (*integrals)(const CellInput &, CellIntegrals &);
    void (*forces)(const CellInput &, double *N, double *f);
    void (*states)(const CellInput &, double *u, double *v, double *e, double *rate);
  };

  /// Kernels for one degree, 1 to ReferenceElement::highest_degree.
  const CellKernels &
  cell_kernels(unsigned int degree);
} // namespace crawler
