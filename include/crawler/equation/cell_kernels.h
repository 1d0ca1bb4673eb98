// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/reference_element.h>

#include <vector>

namespace crawler
{
  class FrictionLaw;

  /// What the integrals over a run of cells need. Arrays over nodes are local ones (discretization.h).
  struct CellInput
  {
    unsigned int n_cells;
    const double *cell_size;
    const ReferenceElement *element;
    const FrictionLaw *friction;
    double k;        ///< elastic modulus
    const double *u; ///< displacement at the nodes
    const double *v; ///< velocity at the nodes; may be null in residual(): then without friction
    const double *m; ///< active stress at the quadrature points
  };

  /// Integrals over the body that the energy balance is made of; see theory.md section 1 for their relations.
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
   * The loops over cells, compiled for each degree so that the compiler unrolls them. With phi_i the shape functions:
   *
   *   residual   F_i  = int g(w) v phi_i + int N phi_i,s                    (added to F)
   *   jacobian   J_ij = sigma int g phi_j phi_i + int g' v phi_j,s phi_i + int k phi_j,s phi_i,s
   *                     = dF_i/du_j + sigma dF_i/dv_j                       (dense block of each cell)
   *   mass       M_ij = int g(w) phi_j phi_i
   */
  struct CellKernels
  {
    /// Returns the local quadrature point number (cell*n + point) of the first stretch that is not positive, or -1.
    long (*residual)(const CellInput &, double *F);
    void (*jacobian)(const CellInput &, double sigma, double *blocks);
    void (*mass)(const CellInput &, double *blocks);
    void (*integrals)(const CellInput &, CellIntegrals &);
  };

  /// The kernels for one degree, 1 to ReferenceElement::highest_degree.
  const CellKernels &
  cell_kernels(unsigned int degree);
} // namespace crawler
