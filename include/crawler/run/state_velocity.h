// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/equation/position_form.h>

#include <span>
#include <vector>

namespace crawler
{
  /**
   * Velocity of states that a time integration has reached. A state alone does not always determine it: where friction
   * vanishes (w -> 0 for a > 0) the error of Newton's method would be divided by the friction, and cells that are small
   * or stiff turn its round-off into velocities, by 1e-16 over their relaxation time. The rate of the integrator has no
   * such error, so there it is used. Natural units.
   */
  class StateVelocity
  {
  public:
    using ConstVector = std::span<const double>;

    /// @p assembler must outlive this; @p position is the same or null (the stretch form). @p is_adaptive: its mesh has
    /// small cells where friction is large and slows them down. @p n_stages of the method.
    StateVelocity(Assembler &assembler, PositionForm *position, bool is_adaptive, unsigned int n_stages);

    /// True if rates and velocities of the fused engine, which has no such cure, may be used.
    bool
    is_known_to_lanes() const;

    /// True if see_rate() is to be told of the rates.
    bool
    keeps_rates() const;
    /// Keeps the rate of a stage; those of the latest times are kept.
    void
    see_rate(double t, ConstVector y_dot);
    /// Forgets the rates: they are those of other states from now on.
    void
    forget_rates();

    /// Computes the velocity @p v of the state @p y that was reached with a step of this size. Returns false if it
    /// cannot be computed.
    bool
    compute(double t, double size, ConstVector y, std::span<double> v);

    /// Computes the velocity @p v of the state @p y at a time within the step of this @p size that ended at @p end:
    /// where friction balances forces, the error of a dense output would be multiplied by the stiffness, so the
    /// polynomial through the rates of the stages is used, if these were seen.
    bool
    compute_within(double t, double end, double size, ConstVector y, std::span<double> v);

    void
    exchange(Archive &archive)
    {
      archive(rates_);
    }

  private:
    void
    remove_rigid_motion(double t, ConstVector y, std::span<double> v);

    struct Rate
    {
      double time = -1.;
      std::vector<double> y_dot;

      void
      exchange(Archive &archive)
      {
        archive(time, y_dot);
      }
    };

    Assembler &assembler_;
    PositionForm *const position_;
    double relaxation_time_; ///< lower bound of that of the mesh
    std::vector<Rate> rates_;
  };
} // namespace crawler
