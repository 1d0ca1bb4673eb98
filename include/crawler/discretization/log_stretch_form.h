// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/assembler.h>

namespace crawler
{
  /**
   * The log-stretch form (doc/numerics.md, "Log-stretch form"): the displacement u and the velocity v at the nodes and
   * log w at q Gauss points of each cell, with
   *
   *   (log w)' = v_s/w  at those points,   int g(w) v phi ds + int (k (w - 1) + m) phi_s ds = 0,   u' = v,
   *
   * so the stretch is positive whatever happens, and keeps its digits however small it is. The velocity is an unknown
   * of its own because v_s/w of an emptied cell is a quotient of tiny numbers, and differences of u have no digits for
   * it. Friction is integrated at the nodes; for degree 1 and a <= -1 no cell can be emptied (doc/theory.md, "When a
   * body can invert").
   */
  class LogStretchForm : public Assembler
  {
  public:
    LogStretchForm(const Scene &scene, const Discretization &discretization);

    Formulation
    formulation() const override
    {
      return Formulation::log_stretch;
    }
    std::size_t
    n_owned() const override
    {
      return 2 * discretization_.n_owned() + static_cast<std::size_t>(discretization_.n_local_cells()) * q_;
    }
    std::size_t
    n_unknowns() const override
    {
      return 2 * discretization_.n_unknowns() + static_cast<std::size_t>(discretization_.n_cells()) * q_;
    }
    std::vector<double>
    weights() const override;
    void
    make_consistent(double t, Vector y) override;
    bool
    residual(double t, ConstVector y, ConstVector y_dot, Vector F) override;
    bool
    setup_jacobian(double t, ConstVector y, ConstVector y_dot, double sigma) override;
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
    velocity(double t, ConstVector y, Vector v) override;
    CellIntegrals
    integrals(double t, ConstVector y, ConstVector v) override;

  protected:
    const std::vector<double> &
    friction_weights() const override;
    const std::vector<double> &
    friction_integration() const override;
    void
    friction(double t, ConstVector y, ConstVector v, std::vector<double> &g_v) override;

    /// The laws of a general scene at a state; null for a plain scene.
    virtual const LogLaws *
    laws_at(double, ConstVector, const LogCellInput &)
    {
      return nullptr;
    }

    /// Changes of the stretch nearby for a change @p x of the unknowns, at the stretch points.
    virtual void
    change_of_near(const LogLaws &, ConstVector, Vector) const
    {
    }

    /// The part of the velocities in a vector of all unknowns.
    template <typename Span>
    Span
    velocities(const Span y) const
    {
      return y.last(discretization_.n_owned());
    }

    LogCellInput
    log_input(double t, ConstVector y, ConstVector v);

    const unsigned int q_;
    const LogCellKernels &kernels_;
    std::vector<double> node_local_, nodes_; ///< local and owned arrays over the nodes
    std::vector<double> local_buffer_;

  private:
    /// The Jacobian for one shift, log w eliminated.
    template <typename Number>
    struct Eliminated
    {
      explicit Eliminated(const Discretization &discretization);

      Number sigma = 0.;
      ChainMatrix<Number> matrix;
      std::vector<double> factors; ///< [cell][log_factors]
      std::vector<Number> node_local, nodes, local_buffer;
      std::optional<LogLaws> laws; ///< of a general scene
      std::vector<double> by_u;    ///< int f_x phi_i at the own nodes, of a general scene
    };
    template <typename Number>
    bool
    setup(Eliminated<Number> &jacobian, const LogCellInput &in, const LogLaws *laws, Number sigma) const;
    template <typename Number>
    void
    keep_laws(Eliminated<Number> &jacobian, const LogLaws &laws) const;
    void
    add_general(const Eliminated<double> &jacobian, ConstVector x, Vector y) const;
    template <typename Number>
    void
    solve(Eliminated<Number> &jacobian, std::span<const Number> b, std::span<Number> x) const;
    /// (L, F) parts of a product with the Jacobian, from its factors.
    void
    multiply(const Eliminated<double> &jacobian, ConstVector x, Vector y);

    Eliminated<double> jacobian_;
    std::vector<Eliminated<Complex>> complex_jacobians_;
    std::vector<Eliminated<double>> stages_; ///< with the shift 0
  };
} // namespace crawler
