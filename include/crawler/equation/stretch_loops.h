// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>

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
  /// Rule that gives the mobility of a node from those of the adjacent cells.
  enum class NodeRule : unsigned char
  {
    friction, ///< mean of their frictions
    fronts,   ///< mean of their frictions, but of their mobilities where the emptier cell receives
    upwind    ///< mobility of the cell that gives, with van Leer's correction
  };

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

  /// Mobility M_i and (N_i - N_{i-1})/H_i of any node, 0 <= i <= n.
  template <typename Number>
  struct NodeForce
  {
    NodeMobility<Number> mobility;
    Number slope;
    double spacing; ///< H_i
  };

  template <typename Number>
  inline NodeForce<Number>
  node_force(
    const NodeRule rule, const int n, const double *h, const Number *mobility, const Number *force, const int i)
  {
    const Number none{}, one = 1. + Number{};
    if (i == 0)
      return {{mobility[0], none, one}, force[0] * (2. / h[0]), 0.5 * h[0]};
    if (i == n)
      return {{mobility[n - 1], one, none}, -force[n - 1] * (2. / h[n - 1]), 0.5 * h[n - 1]};
    const double spacing    = 0.5 * (h[i - 1] + h[i]);
    const Number difference = force[i] - force[i - 1];
    return {node_mobility(rule, n, h, mobility, i, difference), difference / spacing, spacing};
  }

  /// Ground's d(v) (scene/ground.h): the velocity v with d(v) v = q, and its derivative by q.
  struct NodeDirection
  {
    double ratio = 1., switching_velocity = 1.;

    /// Solved by Newton's method; d(v) v increases with v, and is between the smaller and the larger of v and ratio v.
    double
    velocity(const double q, double &slope) const
    {
      slope = 1.;
      if (ratio == 1.)
        return q;
      const double mean = 0.5 * (1. + ratio), half = 0.5 * (1. - ratio);
      // d is between 1 and the ratio.
      const double one = q / ratio, other = q;
      double low = one < other ? one : other, high = one < other ? other : one, v = q > 0. ? q : q / ratio;
      for (int i = 0; i < 100; ++i)
      {
        const double th = ::tanh(v / switching_velocity), f = (mean + half * th) * v - q,
                     df       = mean + half * (th + v / switching_velocity * (1. - th * th));
        slope                 = 1. / df;
        (f > 0. ? high : low) = v;
        double next           = v - f / df;
        if (!(next >= low && next <= high))
          next = 0.5 * (low + high);
        const double change = next - v;
        v                   = next;
        if (::fabs(change) <= 1e-15 * ::fabs(v))
          break;
      }
      return v;
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
