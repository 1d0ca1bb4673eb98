// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/state_velocity.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Relaxation time, relative to the duration, below which cells turn round-off of the state into a velocity.
    constexpr double fast_relaxation = 1e-9;
    /// Relaxation time of cells below which the velocities of the fused engine are not used.
    constexpr double fastest_relaxation = 1e-12;

    /// Relaxation time of the highest mode of the smallest cell; of an adaptive mesh the largest cell tells whether the
    /// body is stiff.
    double
    relaxation_time(const Assembler &assembler, const bool is_adaptive)
    {
      const Discretization &mesh = assembler.discretization;
      double h                   = is_adaptive ? 0. : 1.;
      for (const Cell &cell : mesh.cells)
        h = is_adaptive ? std::max(h, cell.size) : std::min(h, cell.size);
      return h * h / (assembler.scene.body.elastic_modulus * std::pow(mesh.element.degree, 4.));
    }
  } // namespace

  StateVelocity::StateVelocity(Assembler &assembler,
                               PositionForm *const position,
                               const bool is_adaptive,
                               const unsigned int n_stages)
    : assembler_(assembler)
    , position_(position)
    , relaxation_time_(relaxation_time(assembler, is_adaptive))
    , rates_(n_stages + 1)
  {
  }

  bool
  StateVelocity::is_known_to_lanes() const
  {
    return relaxation_time_ > fastest_relaxation;
  }

  bool
  StateVelocity::keeps_rates() const
  {
    const Scene &scene   = assembler_.scene;
    const bool amplifies = relaxation_time_ < fast_relaxation || scene.friction_exponent() > 0.;
    return amplifies && position_ != nullptr;
  }

  void
  StateVelocity::see_rate(const double t, const ConstVector y_dot)
  {
    auto found = std::find_if(rates_.begin(), rates_.end(), [t](const Rate &rate) { return rate.time == t; });
    if (found == rates_.end())
    {
      std::rotate(rates_.begin(), rates_.begin() + 1, rates_.end());
      found = rates_.end() - 1;
    }
    found->time = t;
    found->y_dot.assign(y_dot.begin(), y_dot.end());
  }

  void
  StateVelocity::forget_rates()
  {
    rates_.assign(rates_.size(), {});
  }

  /// Computes v from the rate r, if that is kept: v is the solution of M v + f + h K (v - r) = 0, h the step. Friction
  /// balances exactly, since K does not act on rigid motions, and where M vanishes v is r.
  bool
  StateVelocity::compute(const double t, const double size, const ConstVector y, const std::span<double> v)
  {
    const auto known = std::find_if(rates_.begin(), rates_.end(), [&](const Rate &rate) {
      return size > 0. && std::abs(rate.time - t) <= 1e-9 * size;
    });
    if (!keeps_rates() || known == rates_.end())
      return assembler_.velocity(t, y, v);
    const bool is_plain = assembler_.scene.is_plain();
    std::vector<double> F(y.size()), correction(y.size());
    // Jacobian M/h + K without a velocity; but friction that is not linear in it has to be that of the rate.
    const std::vector<double> at = is_plain ? std::vector<double>(y.size(), 0.) : known->y_dot;
    if (!position_->residual(t, y, known->y_dot, F) || !position_->setup_jacobian(t, y, at, 1. / size))
      return false;
    position_->solve_with_jacobian(F, correction);
    for (std::size_t i = 0; i < v.size(); ++i)
      v[i] = known->y_dot[i] - correction[i] / size;
    remove_rigid_motion(t, y, v);
    return true;
  }

  /// Removes the round-off of the solution, 1e-16 h K/M of it, that can hide in a rigid motion, on which K does not
  /// act. The residual friction gives its size: at once if it is linear in the velocity, else by secants.
  void
  StateVelocity::remove_rigid_motion(const double t, const ConstVector y, const std::span<double> v)
  {
    const bool is_linear       = !assembler_.scene.ground.direction.is_uneven();
    const unsigned int n_tries = is_linear ? 1 : 4;
    const std::vector<double> rigid(v.size(), 1.);
    double friction = assembler_.integrals(t, y, v).net_friction;
    double slope    = std::abs(assembler_.integrals(t, y, rigid).net_friction);
    for (unsigned int i = 0; i < n_tries && friction != 0.; ++i)
    {
      const double motion = friction / slope;
      if (!std::isfinite(motion))
        return;
      for (double &value : v)
        value -= motion;
      if (i + 1 == n_tries)
        return;
      const double now = assembler_.integrals(t, y, v).net_friction;
      if (!(std::abs(now) < std::abs(friction)))
      {
        for (double &value : v) // no improvement
          value += motion;
        return;
      }
      slope    = (friction - now) / motion;
      friction = now;
    }
  }

  bool
  StateVelocity::compute_within(
    const double t, const double end, const double size, const ConstVector y, const std::span<double> v)
  {
    std::vector<const Rate *> stages;
    for (const Rate &rate : rates_)
      if (rate.time > end - size * (1. - 1e-9) && rate.time <= end + 1e-9 * size)
        stages.push_back(&rate);
    if (position_ == nullptr || stages.size() + 1 != rates_.size())
      return assembler_.velocity(t, y, v);
    std::fill(v.begin(), v.end(), 0.);
    for (const Rate *stage : stages)
    {
      double weight = 1.;
      for (const Rate *other : stages)
        if (other != stage)
          weight *= (t - other->time) / (stage->time - other->time);
      for (std::size_t i = 0; i < v.size(); ++i)
        v[i] += weight * stage->y_dot[i];
    }
    return true;
  }
} // namespace crawler
