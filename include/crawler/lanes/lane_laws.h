// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/crawler_equation.h>
#include <crawler/equation/point_laws.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_friction.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_mesh.h>

/// Laws of general bodies and grounds in the position form (included by lane_systems.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /**
   * Laws f = g(w) b(s) c(x) d(v) v and N = m(s, t, w, w_t) + k(s) (w - 1) at all quadrature points of a pack of bodies,
   * and their derivatives. The host evaluates those that the engine does not know, one lane after the other.
   */
  template <typename Pack>
  class GeneralLaws
  {
  public:
    static constexpr int lanes = PackTraits<Pack>::size;

    explicit GeneralLaws(const LaneSetup &setup)
      : bits_(setup.laws)
      , n_(static_cast<int>(setup.n_cells * (setup.degree + 1)))
    {
    }

    void
    lay_out(LaneMemory &memory)
    {
      if (!has(LaneLaws::general))
        return;
      memory.pieces(n_, at.u, at.v, at.e, at.rate, w_, laws.k, b_, g_, w_dg_, laws.N, laws.f, laws.f_v, laws.w_f_w);
      laws.N_w = laws.k;
      if (has(LaneLaws::direction))
        memory.pieces(n_, direction_.tanh);
      if (has(LaneLaws::host_ground))
        memory.pieces(n_, c_, c_x_, laws.f_u);
      if (has(LaneLaws::feedback))
        memory.pieces(n_, m_, laws.N_w);
      if (has(LaneLaws::rate))
        memory.pieces(n_, laws.N_rate);
      if (lanes > 1 && asks_host())
        for (double *&array : scratch_)
          memory.pieces(n_, array);
    }

    void
    set_body(const int l, const LaneBody &body)
    {
      if (!has(LaneLaws::general))
        return;
      hosts_[l]          = body.host;
      const bool is_busy = body.host != nullptr; // else the lane is at rest
      set_lane(direction_.ratio, l, body.direction.ratio);
      set_lane(direction_.switching_velocity, l, body.direction.switching_velocity);
      for (int p = 0; p < n_; ++p)
      {
        set_lane(laws.k[p], l, is_busy ? body.k * body.k_profile[p] : 1.);
        set_lane(b_[p], l, is_busy ? body.friction_profile[p] : 1.);
        // Lanes at rest keep these values: the host does not write there.
        set_lane(g_[p], l, 1.);
        set_lane(w_dg_[p], l, 0.);
        if (has(LaneLaws::host_ground))
        {
          set_lane(c_[p], l, 1.);
          set_lane(c_x_[p], l, 0.);
        }
        if (has(LaneLaws::feedback))
        {
          set_lane(m_[p], l, 0.);
          set_lane(laws.N_w[p], l, body.k);
        }
        if (has(LaneLaws::rate))
          set_lane(laws.N_rate[p], l, 0.);
      }
    }

    /// True if the friction is linear in the velocity, and the force independent of it.
    bool
    are_linear_in_velocity() const
    {
      return (bits_ & LaneLaws::nonlinear_in_velocity) == 0;
    }

    /// Evaluates for the states @p at at the times @p t, with the active stress @p m where that is known;
    /// with derivatives if @p slopes. Returns a number that is not positive where the laws have no meaning.
    Pack
    evaluate(const double *t, const LaneFriction<Pack> &friction, const Pack *m, const bool slopes)
    {
      Pack least = broadcast<Pack>(HUGE_VAL);
      for (int p = 0; p < n_; ++p)
      {
        w_[p] = 1. + at.e[p];
        least = smaller(w_[p], least);
      }
      if (!has(LaneLaws::host_friction))
      {
        friction(w_, g_, n_);
        for (int p = 0; p < n_ && slopes; ++p)
          w_dg_[p] = friction.a * g_[p];
      }
      if (asks_host())
        for (int l = 0; l < lanes; ++l)
          if (hosts_[l] != nullptr && get_lane(least, l) > 0. && !ask_host(l, t[l], slopes))
            set_lane(least, l, -1.);
      if (has(LaneLaws::direction))
        tanh_at_points(at.v, direction_.switching_velocity, direction_.tanh, n_);
      add_up(has(LaneLaws::feedback) ? m_ : m, slopes);
      return least;
    }

    PointLaws<Pack> laws{};     ///< laws at the last evaluation
    LaneStateAtPoints<Pack> at; ///< state, to be written first

  private:
    bool
    has(const LaneLaws::Bits bit) const
    {
      return (bits_ & bit) != 0;
    }

    bool
    asks_host() const
    {
      return (bits_ & (LaneLaws::host_friction | LaneLaws::host_ground | LaneLaws::feedback)) != 0;
    }

    void
    add_up(const Pack *m, const bool slopes)
    {
      const Pack one = broadcast<Pack>(1.), none{};
      equation::DirectionFactor<Pack> direction{one, one};
      const bool has_ground = has(LaneLaws::host_ground), has_direction = has(LaneLaws::direction);
      for (int p = 0; p < n_; ++p)
      {
        if (has_direction)
          direction = equation::direction_factor<Pack>(
            direction_.ratio, direction_.switching_velocity, at.v[p], direction_.tanh[p]);
        const auto here =
          equation::sliding<Pack>(b_[p], has_ground ? c_[p] : one, has_ground ? c_x_[p] : none, direction, at.v[p]);
        laws.f[p] = equation::friction_force<Pack>(g_[p], here.force);
        laws.N[p] = equation::body_force<Pack>(at.e[p], m != nullptr ? m[p] : none, laws.k[p]);
        if (!slopes)
          continue;
        laws.f_v[p]   = g_[p] * here.by_v;
        laws.w_f_w[p] = w_dg_[p] * here.force;
        if (has_ground)
          laws.f_u[p] = g_[p] * here.by_u;
      }
      laws.m = m;
    }

    bool
    ask_host(const int l, const double t, const bool slopes)
    {
      const bool friction = has(LaneLaws::host_friction), ground = has(LaneLaws::host_ground),
                 force = has(LaneLaws::feedback), by_rate = has(LaneLaws::rate);
      Pack *const read[]  = {at.u, at.v, w_, at.rate};
      Pack *const write[] = {friction ? g_ : nullptr,
                             friction && slopes ? w_dg_ : nullptr,
                             ground ? c_ : nullptr,
                             ground && slopes ? c_x_ : nullptr,
                             force ? m_ : nullptr,
                             force && slopes ? laws.N_w : nullptr,
                             by_rate && slopes ? laws.N_rate : nullptr};
      double *own[n_arrays];
      for (int i = 0; i < n_arrays; ++i)
      {
        Pack *const array = i < n_read ? read[i] : write[i - n_read];
        if constexpr (lanes == 1)
          own[i] = array;
        else
          own[i] = array != nullptr ? scratch_[i] : nullptr;
      }
      if constexpr (lanes > 1)
        for (int i = 0; i < n_read; ++i)
          for (int p = 0; p < n_; ++p)
            own[i][p] = get_lane(read[i][p], l);
      const bool good = hosts_[l]->evaluate(
        {t, own[0], own[1], own[2], own[3], own[4], own[5], own[6], own[7], own[8], own[9], own[10]});
      if constexpr (lanes > 1)
        for (int i = n_read; i < n_arrays; ++i)
          if (own[i] != nullptr)
            for (int p = 0; p < n_; ++p)
              set_lane(write[i - n_read][p], l, own[i][p]);
      if (force && slopes)
        for (int p = 0; p < n_; ++p)
          set_lane(laws.N_w[p], l, get_lane(laws.N_w[p], l) + get_lane(laws.k[p], l));
      return good;
    }

    static constexpr int n_read = 4, n_arrays = 11; ///< numbers of arrays of LanePoints

    const unsigned int bits_;
    const int n_; ///< points
    LawHost *hosts_[lanes] = {};
    struct
    {
      Pack ratio, switching_velocity, *tanh;
    } direction_; ///< of the ground
    Pack *w_, *b_, *g_, *w_dg_, *c_, *c_x_, *m_;
    double *scratch_[n_arrays]; ///< scratch of one lane
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
