// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/discretization.h>

#include <functional>
#include <span>

namespace crawler
{
  /**
   * Solves the balance of forces F(v) = 0 for the velocity of a general scene by Newton's method with backtracking,
   * from the guess @p v. @p residual writes F; @p solve replaces F by (dF/dv)^-1 F at a velocity; both return false if
   * they cannot. Returns false if this does not converge (collective).
   */
  bool
  newton_velocity(const Discretization &discretization,
                  std::span<double> v,
                  const std::function<bool(std::span<const double> v, std::span<double> F)> &residual,
                  const std::function<bool(std::span<const double> v, std::span<double> F)> &solve);
} // namespace crawler
