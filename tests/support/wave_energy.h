// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/wave_roots.h>
#include <crawler/scene/body.h>

#include <cmath>
#include <numbers>

namespace crawler::test
{
  /// Energy of the wave with speed @p c: theory.md section 3, H = 2 L gamma T Delta_2 + (L k/c^2) sum P_n sin^2(pi n c
  /// T/L).
  inline double
  wave_energy(const Body &body, const WaveShape &shape, const double end_time, const double c)
  {
    double sum = 0.;
    for (unsigned int n = 1; n <= shape.a.size(); ++n)
      sum += shape.power(n) * std::pow(std::sin(std::numbers::pi * n * c * end_time / body.length), 2);
    return 2. * body.length * body.friction_coefficient * end_time * shape.delta_2() +
           body.length * body.elastic_modulus / (c * c) * sum;
  }
} // namespace crawler::test
