// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/cell_kernels.h>
#include <crawler/discretization/chain_matrix.h>
#include <crawler/discretization/discretization.h>
#include <crawler/discretization/general_laws.h>
#include <crawler/discretization/stretch_sampler.h>
#include <crawler/scene/scene.h>

#include <complex>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace crawler
{
  class GeneralSampler;

  /// A stretch and where it was seen.
  struct StretchAt
  {
    double value; ///< [1]
    double s;     ///< [length]
  };

  /// The smallest and the largest stretch of a state: looked for at the quadrature points and the ends of all cells,
  /// and sharpened by a parabola inside a cell.
  struct StretchRange
  {
    StretchAt min, max;
  };

  /// How well the mesh resolves a stretch: squared norms over the whole body (see doc/numerics.md, "Accuracy").
  struct Resolution
  {
    double highest_mode; ///< int of (highest Legendre mode of w in each cell, relative to the cell's smallest w)^2 ds
    double strain;       ///< int (w - 1)^2 ds
  };

  /// In which unknowns the equation is solved.
  enum class Formulation
  {
    position,   ///< the displacement u = zeta - s
    log_stretch ///< u, and log w in each cell: for stretches that position cannot hold
  };

  /**
   * The semi-discrete crawler F(t, y, y') = 0 in one of the formulations. The unknowns y of a rank are its nodes'
   * displacements u [length], and after those in the log-stretch form log w at the stretch points of its cells [1] and
   * the velocities v of its nodes [length/time].
   * Vectors are the owned values of each rank; all functions are collective.
   */
  class Assembler
  {
  public:
    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;
    using Complex     = std::complex<double>;

    virtual ~Assembler();
    Assembler(const Assembler &) = delete;

    virtual Formulation
    formulation() const = 0;

    /// Number of unknowns of this rank, and of all ranks.
    virtual std::size_t
    n_owned() const = 0;
    virtual std::size_t
    n_unknowns() const = 0;

    /// For each owned unknown the error that counts as much as an error of 1 in the displacement.
    virtual std::vector<double>
    weights() const
    {
      return std::vector<double>(n_owned(), 1.);
    }

    /// Sets the unknowns that follow from the others at once.
    virtual void
    make_consistent(double, Vector)
    {
    }

    /// F(t, y, y'). Returns false (on all ranks) if the stretch is not positive at a quadrature point; bad_stretch()
    /// then tells where.
    virtual bool
    residual(double t, ConstVector y, ConstVector y_dot, Vector F) = 0;

    /// Prepares dF/dy + sigma dF/dy' for the two functions below. Returns false if it is singular.
    virtual bool
    setup_jacobian(double t, ConstVector y, ConstVector y_dot, double sigma) = 0;
    virtual void
    solve_with_jacobian(ConstVector b, Vector x) = 0;
    virtual void
    jacobian_vmult(ConstVector x, Vector y) = 0;

    /// The same for complex sigma_0, sigma_1, ..., as implicit Runge-Kutta methods need.
    virtual bool
    setup_complex_jacobians(double t, ConstVector y, ConstVector y_dot, std::span<const Complex> sigma) = 0;
    virtual void
    solve_with_complex_jacobian(unsigned int i, std::span<const Complex> b, std::span<Complex> x) = 0;

    /// Keeps dF/dy and dF/dy' at the state of a stage, for stage_vmult: result = dF/dy x + dF/dy' x_dot.
    virtual void
    setup_stage(unsigned int stage, double t, ConstVector y, ConstVector y_dot) = 0;
    virtual void
    stage_vmult(unsigned int stage, ConstVector x, ConstVector x_dot, Vector result) = 0;

    /// Keeps the active stress of so many times, for methods that come back to the stages of a step (default: 1).
    void
    keep_stresses(unsigned int n_times);

    /// The active stress is another one from now on, at the same times, too.
    void
    forget_stresses();

    /// v = u' at the nodes [length/time], from the balance of forces. Returns false if it cannot be computed.
    virtual bool
    velocity(double t, ConstVector y, Vector v) = 0;

    /// The integrals over the whole body, the same on all ranks. @p v is the velocity at the nodes.
    virtual CellIntegrals
    integrals(double t, ConstVector y, ConstVector v) = 0;

    /// The displacements at the nodes among the unknowns.
    ConstVector
    displacement(const ConstVector y) const
    {
      return y.first(discretization_.n_owned());
    }
    /// [cell][q] log w at the stretch points among the unknowns; empty in the position form.
    ConstVector
    log_stretch(const ConstVector y) const
    {
      return formulation() == Formulation::position
               ? ConstVector()
               : y.subspan(discretization_.n_owned(),
                           static_cast<std::size_t>(discretization_.n_local_cells()) *
                             discretization_.element().degree);
    }

    /// The extreme stretches of the whole body, the same on all ranks. A stretch that is not a number counts as the
    /// smallest.
    StretchRange
    stretch_range(ConstVector y);

    Resolution
    resolution(ConstVector y);

    /**
     * The error indicator of each own cell: int_cell (max(1, |w g'/g|) d/(k max(w, floor)))^2 ds with d = N* - N, the
     * difference between the force in the body N = m + k (w - 1) and the one that balances the friction, N* = int_0^s g
     * v ds. N* is zero at both ends, as the stress-free ends ask, and d is orthogonal to all that the mesh can
     * represent (doc/numerics.md, "Error indicator"). @p v is the velocity of the state @p y.
     */
    std::vector<double>
    error_indicators(double t, ConstVector y, ConstVector v);

    /// Root mean square of the displacement over the nodes of all ranks [length].
    double
    root_mean_square(ConstVector y) const;

    /// The displacement at the ends of @p n_pieces equal pieces of the body, the same on all ranks [length].
    std::vector<double>
    displacement_at(unsigned int n_pieces, ConstVector y);

    /// The power that leaves through the ends in the paper's energy: [m v] from s = 0 to L (theory.md section 6).
    double
    end_power(double t, ConstVector y, ConstVector v);

    /// The stretches that the end conditions prescribe, 1 - m/k at s = 0 and s = L. A body with feedback makes its own:
    /// then they are not known, and has_known_ends() is false.
    std::pair<double, double>
    end_stretches(double t);
    bool
    has_known_ends() const
    {
      return scene_.active_stress->feedback() == nullptr;
    }

    /// The unknowns of the body at t = 0: with its initial stretch, its centre of mass where it is without.
    void
    set_initial_state(Vector y);

    /// The strain, in the log-stretch form log w, at the stretch points of this rank's cells [cell][q].
    std::vector<double>
    stretch_coefficients(ConstVector y) const;

    /// Where a feedback with delay finds the past; none: the body was at its initial stretch before. Must outlive this.
    void
    set_history(const StretchHistory *history)
    {
      history_ = history;
    }
    const StretchHistory *
    history() const
    {
      return history_;
    }

    /// The first law that was not positive, of the last residual() that returned false because of one (on each rank
    /// its own). @p units are those of the user.
    std::optional<BadLaw>
    bad_law(const Units &units) const
    {
      return describe_bad_law_ ? std::optional(describe_bad_law_(units)) : std::nullopt;
    }

    /// The first stretch that was not positive, of the last residual() that returned false.
    const std::optional<StretchAt> &
    bad_stretch() const
    {
      return bad_stretch_;
    }
    const Discretization &
    discretization() const
    {
      return discretization_;
    }
    const Scene &
    scene() const
    {
      return scene_;
    }

  protected:
    /// @p stress_points [length]: where the equation needs the active stress.
    Assembler(const Scene &scene, const Discretization &discretization, const std::vector<double> &stress_points);

    /// Local arrays of the displacement @p u and the velocity @p v (may be empty), with m of the time @p t.
    CellInput
    input(double t, ConstVector u, ConstVector v);

    /// The same without unknowns and stress.
    CellInput
    geometry() const;

    StretchAt
    smallest_of_ranks(StretchAt own) const;

    /// Adds up over all ranks.
    void
    sum_over_ranks(CellIntegrals &sum) const;

    /// The friction g v at the points where this form integrates it [cell][point]; the weights of these points, and
    /// the integrals from the left end of a cell to each quadrature point [quadrature point][point].
    virtual void
    friction(double t, ConstVector y, ConstVector v, std::vector<double> &g_v) = 0;
    virtual const std::vector<double> &
    friction_weights() const = 0;
    virtual const std::vector<double> &
    friction_integration() const = 0;

    const Scene &scene_;
    const Discretization &discretization_;
    std::optional<StretchAt> bad_stretch_;
    std::function<BadLaw(const Units &)> describe_bad_law_;
    const StretchHistory *history_ = nullptr;

    /// Looks whether the friction @p g at the stretches @p w is positive and finite; the number of the first point
    /// where it is not, or -1. Then bad_law() tells.
    long
    look_at_friction(std::span<const double> w, std::span<const double> g);
    std::vector<double> F_local_;

  private:
    const std::pair<double, double> end_moduli_;
    std::unique_ptr<ActiveStressAtPoints> stress_, end_stress_, quadrature_stress_;
    std::unique_ptr<GeneralSampler> end_sampler_, quadrature_sampler_; ///< of general scenes, once they are needed
    const std::vector<double> &
    stress_at(double t);

    /// m at the stress points.
    struct StressAtTime
    {
      double time = std::numeric_limits<double>::quiet_NaN();
      std::vector<double> m;
    };
    const std::size_t n_stress_points_;
    std::vector<StressAtTime> stresses_; ///< the latest
    std::size_t oldest_stress_ = 0;
    std::vector<double> u_local_, v_local_;
    const StretchSampler &sampler_;    ///< at the left end, the quadrature points and the right end
    std::vector<double> highest_mode_; ///< [point] weights that give the highest Legendre coefficient
    std::vector<double> friction_at_, m_at_quadrature_;
    /// Ends of equal pieces of the body in own cells, and the shape functions there.
    struct PieceEnds
    {
      unsigned int n_pieces = 0, first = 0;
      std::vector<unsigned int> cells;
      std::vector<double> shape; ///< [end][n nodes]
    };
    PieceEnds piece_ends_;
    void
    find_piece_ends(unsigned int n_pieces);
  };

  std::unique_ptr<Assembler>
  create_assembler(Formulation formulation, const Scene &scene, const Discretization &discretization);
} // namespace crawler
