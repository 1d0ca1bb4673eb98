// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/gauss_panels.h>
#include <crawler/scene/scene.h>

#include <span>
#include <vector>

namespace crawler
{
  /// Body data that, with its strain, determine its motion and the stress for it: friction g(s,w) = b(s) g(w) and
  /// stiffness k(s), at points.
  struct BodyAtPoints
  {
    /// Takes a scene without features_beyond_strain().
    BodyAtPoints(const Scene &scene, const std::vector<double> &points);

    std::shared_ptr<const FrictionLaw> friction;
    std::vector<double> friction_profile; ///< b(s) [1]
    std::vector<double> elastic_modulus;  ///< k(s) [force]
  };

  /**
   * Motion of a body of given strain e(s,t) at one time: v = B_t + drift with B_t = int_0^s e_t ds, and the drift for
   * which the friction balances, int g v ds = 0 (doc/theory.md, "Prescribed strain"). Lists are over the quadrature
   * points.
   */
  struct GivenMotion
  {
    /// Finds the motion from the strain and its rate at the points of the panels, the first of the points of @p body;
    /// @p with_slopes: w_dg, too. Strains above -1 are expected.
    void
    find(const GaussPanels &panels,
         std::span<const double> strain,
         std::span<const double> rate,
         const BodyAtPoints &body,
         bool with_slopes = false);

    std::vector<double> w, g, w_dg; ///< stretch, friction per velocity, and its derivative by log w
    std::vector<double> B_t, v, gv;
    double g_mean = 0., drift = 0.;
    double velocity = 0.; ///< of the centre of mass, the mean of v
  };
} // namespace crawler
