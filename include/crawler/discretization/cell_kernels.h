// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/reference_element.h>

#include <array>
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

  /// What the log-stretch form needs besides.
  struct LogCellInput
  {
    CellInput cells;         ///< its m is at the stretch points [cell][q]
    const double *log_w;     ///< [cell][q] logarithm of the stretch at the stretch points
    const double *log_w_dot; ///< [cell][q] its time derivative

    /// For degree 1: the cells to the left and to the right of these, of size 0 where there is none.
    struct Beside
    {
      double size, log_w;
    };
    std::array<Beside, 2> beside;
  };

  /// Integrals over the body that the ledger is made of; see theory.md section 1 for their relations.
  struct CellIntegrals
  {
    double displacement   = 0.; ///< int u ds
    double elastic_energy = 0.; ///< int k/2 (w-1)^2 ds
    double stress_power   = 0.; ///< -int m v_s ds
    double positive_power = 0.; ///< int max(-m v_s, 0) ds
    double absolute_power = 0.; ///< int |m v_s| ds, the scale of the ledger's tolerance
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

  /**
   * The log-stretch form (doc/numerics.md, "Log-stretch form"): at each stretch point of a cell the equation
   *   L_p = d/dt log w - v_s/w,
   * and the residual F_i = int g v phi_i + int N phi_i,s with the stretch w = exp(log w); the friction integral by the
   * Gauss-Lobatto formula at the nodes, the other by the Gauss formula at the stretch points. With degree 1 friction at
   * a node between two cells is the mean of theirs, or its harmonic mean where the emptier cell receives length.
   */
  struct LogCellKernels
  {
    /// Adds F to @p F and writes L [cell][q]. Without log_w_dot: F only, without friction.
    void (*residual)(const LogCellInput &, double *F, double *L);
    /// The friction at the nodes, int g phi_i: the diagonal of the friction matrix; added to @p mass. Of the velocity
    /// only the sign matters.
    void (*mass)(const LogCellInput &, double *mass);
    /// The friction g at the nodes of each cell and its derivative as in the Jacobian [cell][n].
    void (*friction)(const LogCellInput &, double *g, double *w_dg);
    /// (f, l) += J (v, log w) with the real factors of LogElimination.
    void (*multiply)(const CellInput &, const double *factors, const double *v, const double *x, double *f, double *l);
    void (*integrals)(const LogCellInput &, CellIntegrals &);
  };

  /// The laws of a general scene in the log-stretch form (doc/theory.md, "General bodies and grounds").
  struct LogLaws
  {
    // At the nodes of each cell [cell][n]: the friction per reference length f and its derivatives.
    std::vector<double> f, by_v, by_log_w, by_u;
    // At the stretch points [cell][q]: the derivatives of N by log w, by w_t and by the stretch nearby; the last two
    // may be empty.
    std::vector<double> by_log, by_rate, by_near;
    std::vector<double> near_slope; ///< see StretchElsewhere
  };

  /// The elimination of log w from the Jacobian of the log-stretch form, cell by cell; real or complex shifts.
  template <typename Number>
  struct LogElimination
  {
    /// The blocks of the Jacobian after elimination of log w, and what the others need [cell][log_factors].
    bool (*jacobian)(const LogCellInput &, Number sigma, Number *blocks, double *factors);
    /// The same for a general scene, without what by_u adds and without the stretch nearby.
    bool (*general_jacobian)(const LogCellInput &, const LogLaws &, Number sigma, Number *blocks, double *factors);
    /// From a right-hand side (f, l) to that of the chain of blocks: added to @p f.
    void (*reduce)(const CellInput &, const double *factors, const Number *l, Number *f);
    /// log w [cell][q] from the velocities @p v at the nodes and the right-hand side @p l (in place).
    void (*recover)(const CellInput &, const double *factors, const Number *v, Number *l);
  };

  /// Doubles per cell that LogElimination::jacobian keeps.
  template <typename Number>
  constexpr unsigned int
  log_factors(const unsigned int degree)
  {
    return degree * sizeof(Number) / sizeof(double) + 2 * degree + 2 * (degree + 1);
  }

  const LogCellKernels &
  log_cell_kernels(unsigned int degree);
  template <typename Number>
  const LogElimination<Number> &
  log_elimination(unsigned int degree);

  /// The kernels for one degree, 1 to ReferenceElement::highest_degree.
  const CellKernels &
  cell_kernels(unsigned int degree);
} // namespace crawler
