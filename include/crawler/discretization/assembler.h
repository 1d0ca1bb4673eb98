// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/cell_kernels.h>
#include <crawler/discretization/chain_matrix.h>
#include <crawler/discretization/discretization.h>
#include <crawler/scene/scene.h>

#include <memory>
#include <optional>
#include <utility>

namespace crawler
{
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

  /**
   * The semi-discrete crawler: M(u) v + K u + m = 0 with v = u_t (crawler_equation.h; doc/numerics.md). Vectors are
   * the owned values of each rank; all functions are collective.
   */
  class Assembler
  {
  public:
    Assembler(const Scene &scene, const Discretization &discretization);

    /// F = M(u) v + K u + m(t). Returns false (on all ranks) if the stretch is not positive at a quadrature point;
    /// bad_stretch() then tells where.
    bool
    residual(double t, std::span<const double> u, std::span<const double> v, std::span<double> F);

    /// A = dF/du + sigma dF/dv.
    void
    jacobian(double t, std::span<const double> u, std::span<const double> v, double sigma, ChainMatrix &A);

    /// v = -M(u)^-1 (K u + m(t)): the velocity of the state. Returns false if it cannot be computed.
    bool
    velocity(double t, std::span<const double> u, std::span<double> v);

    /// The integrals over the whole body, the same on all ranks.
    CellIntegrals
    integrals(double t, std::span<const double> u, std::span<const double> v);

    /// The extreme stretches of the whole body, the same on all ranks. A stretch that is not a number counts as the
    /// smallest.
    StretchRange
    stretch_range(std::span<const double> u);

    Resolution
    resolution(std::span<const double> u);

    /// Root mean square of the unknowns of all ranks [length].
    double
    root_mean_square(std::span<const double> u) const;

    /// The power that leaves through the ends in the paper's energy: [m v] from s = 0 to L (theory.md section 6).
    double
    end_power(double t, std::span<const double> v);

    /// m at the ends of the body, s = 0 and s = L [force].
    std::pair<double, double>
    end_stress(double t);

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

  private:
    CellInput
    input(double t, std::span<const double> u, std::span<const double> v);

    const Scene &scene_;
    const Discretization &discretization_;
    const CellKernels &kernels_;

    std::unique_ptr<ActiveStressAtPoints> stress_, end_stress_;
    std::vector<double> m_; ///< at the quadrature points, at the time m_time_
    double m_time_;

    std::vector<double> u_local_, v_local_, F_local_;
    std::vector<double> highest_mode_;  ///< [point] weights that give the highest Legendre coefficient
    std::unique_ptr<ChainMatrix> mass_; ///< built when a velocity is first asked for
    std::optional<StretchAt> bad_stretch_;
  };
} // namespace crawler
