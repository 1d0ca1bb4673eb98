// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>

#include <array>
#include <deque>

namespace crawler
{
  /// Rates whose integrals over time are works: of the active stress, of friction, of the positive and of the absolute
  /// power of the active stress, and of the power that leaves through the ends (doc/theory.md section 6) [energy/time].
  using Rates = std::array<double, 5>;

  /// Rates of a state with these integrals (CellIntegrals, or those of a stage of the lanes), where @p end_power leaves
  /// through the ends, [m v] from s = 0 to L.
  template <typename Integrals>
  Rates
  rates_of(const Integrals &sums, const double end_power)
  {
    return {{sums.stress_power, sums.dissipation, sums.positive_power, sums.absolute_power, end_power}};
  }

  /// Works over a run, and energies at its present state.
  struct EnergyBalance
  {
    double stress_work    = 0.; ///< W = -int int m zeta_st ds dt, work of the active stress [energy]
    double dissipation    = 0.; ///< Q = int int g v^2 ds dt [energy]
    double positive_work  = 0.; ///< int int max(-m zeta_st, 0) ds dt, not a number if it is not known [energy]
    double exchanged_work = 0.; ///< int int |m zeta_st| ds dt [energy]
    double end_work       = 0.; ///< int [m v] from s = 0 to L dt [energy]
    double elastic_energy = 0.; ///< elastic energy of the present state [energy]
    double transfer_loss  = 0.; ///< elastic energy lost by changes of the mesh [energy]
    double initial_energy = 0.; ///< elastic energy at t = 0, of a body that starts stretched [energy]

    /// All energies, for operations on each.
    static constexpr std::array<double EnergyBalance::*, 7>
    energies()
    {
      return {{&EnergyBalance::stress_work,
               &EnergyBalance::dissipation,
               &EnergyBalance::positive_work,
               &EnergyBalance::exchanged_work,
               &EnergyBalance::end_work,
               &EnergyBalance::elastic_energy,
               &EnergyBalance::transfer_loss}};
    }

    /// Adds increments to the works.
    void
    add_works(const Rates &increments);

    /// Returns all energies times @p unit.
    EnergyBalance
    scaled(double unit) const;

    /// Energy of the paper, int int m_s zeta_t ds dt [energy].
    double
    paper_energy() const
    {
      return stress_work + end_work;
    }
    /// Energy residual |W - Q - (elastic energy) + (initial energy) - (transfer loss)|/(exchanged work): 0 for the
    /// exact solution [1].
    double
    residual() const;
  };

  /**
   * Integrates rates over time as accurately as the time integrator: over each step the polynomial through some points.
   * The points are the stages of the step, if the method integrates by them, else the last (up to six) accepted points,
   * i.e. the Adams-Moulton quadrature for variable steps, fewer where steps have just grown a lot.
   */
  class RateQuadrature
  {
  public:
    /// Advances to the next point in time, with its rates.
    void
    advance(double time, const Rates &rates);

    /// Begins a step of this @p size [time]; its stages follow, each at its @p place in the step, in [0, 1].
    void
    begin_step(double size);
    void
    add_stage(double place, const Rates &rates);

    /// Increments of the integrals from the start of the step to this @p place in it, 1 at its end.
    Rates
    until(double place) const;

    void
    exchange(Archive &archive)
    {
      archive(points_, size_, latest_, used_);
    }

  private:
    struct Point
    {
      double offset; ///< time from the start of the step [time]: steps may be as short as round-off of the time
      Rates rates;
    };
    std::deque<Point> points_; ///< newest first
    double size_ = 0., latest_ = 0.;
    std::size_t used_ = 0; ///< number of points of the polynomial
  };
} // namespace crawler
