// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/gauss_panels.h>
#include <crawler/scene/scene.h>

#include <span>
#include <vector>

namespace crawler
{
  /// What decides, besides its strain, how a body moves and what that takes: friction g(s,w) = b(s) g(w) and stiffness
  /// k(s), at points.
  struct BodyAtPoints
  {
    /// Of a scene without features_beyond_strain(); it must outlive this.
    BodyAtPoints(const Scene &scene, const std::vector<double> &points);

    const FrictionLaw &friction;
    std::vector<double> friction_profile; ///< b(s) [1]
    std::vector<double> elastic_modulus;  ///< k(s) [force]
  };

  /**
   * How a body of given strain e(s,t) moves at one time: v = B_t + drift with B_t = int_0^s e_t ds, and the drift that
   * lets the friction balance, int g v ds = 0 (doc/theory.md, "Prescribed strain"). Lists are over the points of the
   * quadrature.
   */
  struct GivenMotion
  {
    explicit GivenMotion(std::size_t n_points);

    /// From the strain and its rate at the points of the panels, with which the points of @p body begin;
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
