// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/crawler_equation.h>
#include <crawler/equation/stretch_method.h>
#include <crawler/scene/direction.h>

#include <cmath>

/**
 * Stretch form (doc/numerics.md, "Stretch form") along the body: one stretch w_j in each cell of size h_j, the
 * velocities v_i at the nodes, for one body (Number is double) or for several side by side (Number is a pack of them):
 *
 *   v_i = M_i (N_i - N_{i-1})/H_i,    w_j' = (v_{j+1} - v_j)/h_j,    H_i = (h_{i-1} + h_i)/2, half a cell at the ends.
 *
 * M_i is the mobility of the node, from those M = 1/(g b) of the adjacent cells. Included by the files that compile it.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Mobility of a node and its derivatives by those of the cells to the left and to the right.
  template <typename Number>
  struct NodeMobility
  {
    Number value, by_left, by_right;
  };

  /// Mobility of a node by the mean of the frictions of two cells.
  template <typename Number>
  inline NodeMobility<Number>
  mobility_of_mean_friction(const double h_left, const double h_right, const Number &left, const Number &right)
  {
    constexpr double nothing = 1e-300; // two emptied cells have the mobility 0
    const Number scale = (h_left + h_right) / (h_left * right + h_right * left + nothing), r = right * scale,
                 l = left * scale, part = 1. / (h_left + h_right) + Number{};
    return {left * r, h_left * part * r * r, h_right * part * l * l};
  }

  /// Mobility of a node by upwinding; @p beyond is the cell behind the one that gives.
  template <typename Number>
  inline NodeMobility<Number>
  upwind_mobility(const Number &receiver, const Number &giver, const Number &beyond)
  {
    // by_left stands for the receiver, by_right for the cell that gives.
    const Number A = giver - beyond, B = receiver - giver, product = A * B;
    const auto limited = product > 0.;
    const Number sum = limited ? A + B : 1. + Number{}, x = limited ? A / sum : Number{},
                 y = limited ? B / sum : Number{};
    return {giver + x * B, x * x, 1. + y * y - x * x};
  }

  /// Mobility of the node to the left of cell @p i, 0 < i < n; @p difference is N_i - N_{i-1}, which has the sign of
  /// the velocity. A positive velocity takes length from the right cell.
  template <typename Number>
  inline NodeMobility<Number>
  node_mobility(
    const NodeRule rule, const int n, const double *h, const Number *mobility, const int i, const Number &difference)
  {
    const Number left = mobility[i - 1], right = mobility[i];
    if (rule == NodeRule::upwind)
    {
      const Number &after = mobility[i + 1 < n ? i + 1 : i], &before = mobility[i > 1 ? i - 2 : i - 1];
      const auto from_right = difference > 0.;
      const NodeMobility<Number> mixed =
        upwind_mobility<Number>(from_right ? left : right, from_right ? right : left, from_right ? after : before);
      return {mixed.value, from_right ? mixed.by_left : mixed.by_right, from_right ? mixed.by_right : mixed.by_left};
    }
    NodeMobility<Number> result = mobility_of_mean_friction(h[i - 1], h[i], left, right);
    if (rule == NodeRule::fronts)
    {
      const auto refills = difference * (right - left) > 0.;
      const Number half  = 0.5 + Number{};
      result.value       = refills ? 0.5 * (left + right) : result.value;
      result.by_left     = refills ? half : result.by_left;
      result.by_right    = refills ? half : result.by_right;
    }
    return result;
  }

  /// Velocity v with d(v) v = @p q for the ground's d(v), and its derivative @p slope by q.
  inline double
  directed_velocity(const Direction &direction, const double q, double &slope)
  {
    slope              = 1.;
    const double ratio = direction.ratio, switching_velocity = direction.switching_velocity;
    if (ratio == 1.)
      return q;
    // Newton's method; d(v) v increases with v. As d is between 1 and the ratio, v is between these bounds.
    const double one = q / ratio, other = q;
    double low = one < other ? one : other, high = one < other ? other : one, v = q > 0. ? q : q / ratio;
    for (int i = 0; i < 100; ++i)
    {
      const auto here       = equation::direction_factor(ratio, switching_velocity, v, ::tanh(v / switching_velocity));
      const double f        = here.d * v - q;
      slope                 = 1. / here.dv_v;
      (f > 0. ? high : low) = v;
      double next           = v - f / here.dv_v;
      if (!(next >= low && next <= high))
        next = 0.5 * (low + high);
      const double change = next - v;
      v                   = next;
      if (::fabs(change) <= 1e-15 * ::fabs(v))
        break;
    }
    return v;
  }

  /// Bodies side by side are plain: their grounds have no direction.
  template <typename Pack>
  inline Pack
  directed_velocity(const Direction &, const Pack &q, Pack &slope)
  {
    slope = 1. + Pack{};
    return q;
  }

  /// Velocity of a node, and its derivatives by the unknowns and the stretch rates of the cells to its left and right.
  template <typename Number>
  struct NodeVelocity
  {
    Number v{}, by_left{}, by_right{}, by_left_rate{}, by_right_rate{};
  };

  /// Nodes 0 <= i <= n of a body with n cells.
  template <typename Number>
  struct StretchNodes
  {
    NodeRule rule;
    int n;
    const double *h; ///< [cell]
    Direction direction;
    CellLaws<Number> laws{}; ///< laws at the present state

    /// Mobility M_i and the force (N_i - N_{i-1})/H_i.
    struct Force
    {
      NodeMobility<Number> mobility;
      Number slope;
      double spacing; ///< H_i
    };

    Force
    force(const int i) const
    {
      const Number none{}, one = 1. + Number{}, *const N = laws.force, *const mobility = laws.mobility;
      if (i == 0)
        return {{mobility[0], none, one}, N[0] * (2. / h[0]), 0.5 * h[0]};
      if (i == n)
        return {{mobility[n - 1], one, none}, -N[n - 1] * (2. / h[n - 1]), 0.5 * h[n - 1]};
      const double spacing    = 0.5 * (h[i - 1] + h[i]);
      const Number difference = N[i] - N[i - 1];
      return {node_mobility(rule, n, h, mobility, i, difference), difference / spacing, spacing};
    }

    Number
    velocity(const int i) const
    {
      const Force at = force(i);
      Number slope;
      return directed_velocity(direction, at.slope * at.mobility.value, slope);
    }

    /// Computes the velocities @p v [n + 1] of all nodes, in a loop for each rule that compilers turn into one over
    /// vectors of nodes.
    void
    velocities(Number *v) const
    {
      v[0] = velocity(0);
      v[n] = velocity(n);
      if (rule == NodeRule::fronts)
        inner_velocities<NodeRule::fronts>(v);
      else if (rule == NodeRule::upwind)
        inner_velocities<NodeRule::upwind>(v);
      else
        inner_velocities<NodeRule::friction>(v);
    }

    NodeVelocity<Number>
    with_derivatives(const int i) const
    {
      const Force at = force(i);
      Number turn;
      NodeVelocity<Number> result{directed_velocity(direction, at.slope * at.mobility.value, turn)};
      const Number conductance = turn * at.mobility.value * (1. / at.spacing), force = turn * at.slope;
      if (i > 0)
        result.by_left =
          force * at.mobility.by_left * laws.mobility_slope[i - 1] - conductance * laws.force_slope[i - 1];
      if (i < n)
        result.by_right = force * at.mobility.by_right * laws.mobility_slope[i] + conductance * laws.force_slope[i];
      if (laws.force_by_rate != nullptr && i > 0)
        result.by_left_rate = -conductance * laws.force_by_rate[i - 1];
      if (laws.force_by_rate != nullptr && i < n)
        result.by_right_rate = conductance * laws.force_by_rate[i];
      return result;
    }

  private:
    template <NodeRule own>
    void
    inner_velocities(Number *v) const
    {
      const Number *const N = laws.force, *const mobility = laws.mobility;
      const double *const size = h;
      for (int i = 1; i < n; ++i)
      {
        const Number difference = N[i] - N[i - 1];
        v[i] =
          difference / (0.5 * (size[i - 1] + size[i])) * node_mobility(own, n, size, mobility, i, difference).value;
      }
      if (direction.ratio != 1.)
        for (int i = 1; i < n; ++i)
        {
          Number slope;
          v[i] = directed_velocity(direction, v[i], slope);
        }
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
