// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/assembler.h>

namespace crawler
{
  /// The position form: M(u) u' + K u + m = 0 (crawler_equation.h; doc/numerics.md, "The semi-discrete system").
  class PositionForm : public Assembler
  {
  public:
    PositionForm(const Scene &scene, const Discretization &discretization);

    Formulation
    formulation() const override
    {
      return Formulation::position;
    }
    std::size_t
    n_owned() const override
    {
      return discretization_.n_owned();
    }
    std::size_t
    n_unknowns() const override
    {
      return discretization_.n_unknowns();
    }
    bool
    residual(double t, ConstVector u, ConstVector v, Vector F) override;
    bool
    setup_jacobian(double t, ConstVector u, ConstVector v, double sigma) override;
    void
    solve_with_jacobian(ConstVector b, Vector x) override;
    void
    jacobian_vmult(ConstVector x, Vector y) override;
    bool
    setup_complex_jacobians(double t, ConstVector y, ConstVector y_dot, std::span<const Complex> sigma) override;
    void
    solve_with_complex_jacobian(unsigned int i, std::span<const Complex> b, std::span<Complex> x) override;
    void
    setup_stage(unsigned int stage, double t, ConstVector y, ConstVector y_dot) override;
    void
    stage_vmult(unsigned int stage, ConstVector x, ConstVector x_dot, Vector result) override;
    bool
    velocity(double t, ConstVector u, Vector v) override;
    CellIntegrals
    integrals(double t, ConstVector u, ConstVector v) override;

    /// A = dF/du + sigma dF/dv.
    void
    jacobian(double t, ConstVector u, ConstVector v, double sigma, ChainMatrix<double> &A);

  protected:
    const std::vector<double> &
    friction_weights() const override;
    const std::vector<double> &
    friction_integration() const override;
    void
    friction(double t, ConstVector u, ConstVector v, std::vector<double> &g_v) override;

    // The loops over cells, which general scenes replace. The arrays of @p in are local, the unknowns @p u are owned.

    /// Adds F to the local array @p F; the number of the first quadrature point [cell][point] where F is not defined,
    /// or -1.
    virtual long
    add_residual(double t, ConstVector u, const CellInput &in, double *F);
    /// dF/du + sigma dF/dv.
    virtual void
    jacobian_blocks(double t, ConstVector u, const CellInput &in, double sigma, double *blocks);
    /// dF/dv.
    virtual void
    mass_blocks(double t, ConstVector u, const CellInput &in, double *blocks);

    std::unique_ptr<ChainMatrix<double>> mass_; ///< built when a velocity is first asked for

  private:
    const CellKernels &kernels_;
    ChainMatrix<double> jacobian_;
    std::vector<ChainMatrix<Complex>> complex_jacobians_;
    struct Stage
    {
      ChainMatrix<double> by_u, by_v; ///< dF/du, dF/dv
    };
    std::vector<Stage> stages_;
    std::vector<double> product_;
  };
} // namespace crawler
