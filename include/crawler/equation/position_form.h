// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/assembler.h>
#include <crawler/mesh/block_tridiagonal_matrix.h>
#include <crawler/time/implicit_system.h>

#include <limits>
#include <optional>

namespace crawler
{
  /// Resolution of the stretch by the mesh: squared norms over the whole body (see doc/numerics.md, "Accuracy").
  struct Resolution
  {
    /// int of (highest Legendre mode of w in each cell, relative to the cell's smallest w)^2 ds
    double highest_mode = 0.;
    double strain       = 0.; ///< int (w - 1)^2 ds
  };

  /**
   * Position form F(t, u, u') = M(u) u' + K u + m = 0 (crawler_equation.h; doc/numerics.md, "The semi-discrete
   * system"). The unknowns of a rank are the displacements of its nodes [length]. In a general scene (doc/theory.md,
   * "General bodies and grounds"), for every test function phi
   *
   *   int f(s, s + u, w, v) phi ds + int N phi_s ds = 0,   N = m(s, t, w, w_t, ...) + k(s) (w - 1);
   *
   * laws and their derivatives are computed at all quadrature points first, and then integrated. A stretch at another
   * place couples distant cells: the products with the Jacobian include this, the elimination does not.
   */
  class PositionForm : public Assembler, public ImplicitSystem
  {
  public:
    using Vector      = Assembler::Vector;
    using ConstVector = Assembler::ConstVector;

    PositionForm(const Scene &scene, const Discretization &discretization);

    std::size_t
    n_owned() const override
    {
      return discretization.n_owned();
    }
    ConstVector
    displacement(const ConstVector y) const override
    {
      return y;
    }
    StretchRange
    stretch_range(ConstVector y) override;
    void
    set_initial_state(Vector y) override;

    /// Keeps the active stress of @p n_times times, for methods that return to the stages of a step (default: 1).
    void
    keep_stresses(unsigned int n_times);
    void
    forget_stresses() override;

    /// Residual F(t, u, u'). Returns false (on all ranks) if the stretch is not positive at a quadrature point.
    bool
    residual(double t, ConstVector u, ConstVector v, Vector F) override;

    bool
    setup_jacobian(double t, ConstVector u, ConstVector v, double sigma) override;
    void
    solve_with_jacobian(ConstVector b, Vector x) override;
    void
    jacobian_vmult(ConstVector x, Vector y) override;
    bool
    solves_exactly() const override; ///< false where the stretch at another place contributes
    bool
    setup_complex_jacobians(double t, ConstVector u, ConstVector v, std::span<const Complex> sigma) override;
    void
    solve_with_complex_jacobian(unsigned int i, std::span<const Complex> b, std::span<Complex> x) override;
    void
    setup_stage(unsigned int stage, double t, ConstVector u, ConstVector v) override;
    void
    stage_vmult(unsigned int stage, ConstVector x, ConstVector x_dot, Vector result) override;
    /// In general scenes by Newton's method: the friction may depend on the velocity, the active stress on its
    /// derivative.
    bool
    velocity(double t, ConstVector u, Vector v) override;
    CellIntegrals
    integrals(double t, ConstVector u, ConstVector v) override;

    /// Jacobian A = by_u dF/du + by_v dF/dv; the mass matrix is dF/dv.
    void
    jacobian(double t, ConstVector u, ConstVector v, double by_u, double by_v, BlockTridiagonalMatrix<double> &A);

    Resolution
    resolution(ConstVector y);

    /**
     * Error indicator of each own cell: int_cell (max(1, |w g'/g|) d/(k max(w, floor)))^2 ds with d = N* - N, the
     * difference between the force in the body N = m + k (w - 1) and the one that balances the friction, N* = int_0^s g
     * v ds. N* is zero at both ends, as the stress-free ends require, and d is orthogonal to all functions that the
     * mesh can represent (doc/numerics.md, "Error indicator"). @p v is the velocity of the state @p y.
     */
    std::vector<double>
    error_indicators(double t, ConstVector y, ConstVector v);

  private:
    /// Local arrays of the displacement @p u and the velocity @p v (may be empty), with m of the time @p t.
    CellInput
    input(double t, ConstVector u, ConstVector v);

    /// Evaluates the laws of a general scene there: sets the laws of @p in, whose arrays are local; the unknowns @p u
    /// are owned. Returns the number of the first quadrature point [cell][point] where they are not defined, or -1.
    long
    evaluate_laws(double t, ConstVector u, CellInput &in);

    /// Replaces @p x by M^-1 x for the mass matrix of a state; false if that is singular.
    bool
    solve_with_mass(double t, ConstVector u, ConstVector v, Vector x);

    /// Adds the contribution of the stretch at another place to a product with the Jacobian.
    void
    add_far(const std::vector<double> &by_near, ConstVector x, Vector result) const;

    const std::vector<double> &
    stress_at(double t);

    const CellKernels &kernels_;
    /// Laws of a general scene, and the state, at the quadrature points.
    struct General
    {
      FrictionAtPoints friction;
      BodyForceAtPoints force;
      StretchElsewhere elsewhere;
      std::vector<double> e, w, u, v, rate;
      PointLaws<double> laws;
      std::vector<double> jacobian_by_near = {}; ///< derivative of the force by the stretch at the other place
    };
    std::optional<General> general_;

    BlockTridiagonalMatrix<double> jacobian_;
    std::unique_ptr<BlockTridiagonalMatrix<double>> mass_; ///< made when a velocity is first needed
    const std::unique_ptr<ActiveStressAtPoints> stress_;
    /// Active stress m at the stress points.
    struct StressAtTime
    {
      double time = std::numeric_limits<double>::quiet_NaN();
      std::vector<double> m;
    };
    std::vector<StressAtTime> stresses_; ///< latest stresses
    std::size_t oldest_stress_ = 0;
    std::vector<double> u_local_, v_local_, F_local_;
    std::vector<double> force_, friction_; ///< values at the quadrature points
    std::vector<BlockTridiagonalMatrix<Complex>> complex_jacobians_;
    struct Stage
    {
      BlockTridiagonalMatrix<double> by_u, by_v; ///< dF/du, dF/dv
      std::vector<double> by_near;               ///< derivative of the force by the stretch at the other place
    };
    std::vector<Stage> stages_;
    std::vector<double> product_;
  };
} // namespace crawler
