// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "run_text.h"

#include <cmath>
#include <numbers>

namespace crawler::test
{
  /**
   * Exact solution of the whole equation for a = +1, gamma = k = L = 1: the strain
   *   e = E (sin 2 pi (s+t) - sin 2 pi s),
   * which belongs to the velocity v = E sin 2 pi (s+t) - d with d = (E^2/2)(1 - cos 2 pi t), since then <(1+e) v> = 0,
   * and to the active stress m = int_0^s (1+e) v ds - k e (doc/theory.md, kinematic level).
   */
  struct ExactSolution
  {
    double E = 0.2;

    /// Displacement of the centre of mass.
    double
    displacement(const double t) const
    {
      return -0.5 * E * E * (t - std::sin(2. * std::numbers::pi * t) / (2. * std::numbers::pi));
    }
    double
    u(const double s, const double t) const
    {
      constexpr double q = 2. * std::numbers::pi;
      return -E / q * (std::cos(q * (s + t)) - std::cos(q * s)) + displacement(t);
    }
    double
    stretch(const double s, const double t) const
    {
      constexpr double q = 2. * std::numbers::pi;
      return 1. + E * (std::sin(q * (s + t)) - std::sin(q * s));
    }

    /// Settings of the scene, with the active stress as a formula.
    Settings
    settings(const double end_time) const
    {
      const std::string d = "(E^2/2*(1-cos(q*t)))";
      return {{"Body/Anchoring exponent", "0"},
              {"Active stress/Generator", "expression"},
              {"Active stress/Expression/Constants", "E=" + text(E) + ", q=" + text(2. * std::numbers::pi)},
              {"Active stress/Expression/Active stress",
               "E*(cos(q*t)-cos(q*(s+t)))/q - " + d + "*s + E^2*(s/2-(sin(2*q*(s+t))-sin(2*q*t))/(4*q)) - E*" + d +
                 "*(cos(q*t)-cos(q*(s+t)))/q - E^2*(s*cos(q*t)/2-(sin(2*q*s+q*t)-sin(q*t))/(4*q)) + E*" + d +
                 "*(1-cos(q*s))/q - E*(sin(q*(s+t))-sin(q*s))"},
              {"Time/End time", text(end_time)}};
    }
  };
} // namespace crawler::test
