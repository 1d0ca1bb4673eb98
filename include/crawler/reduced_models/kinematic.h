// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/cell_kernels.h>
#include <crawler/equation/energy_balance.h>
#include <crawler/reduced_models/reduced_fields.h>
#include <crawler/scene/given_motion.h>
#include <crawler/scene/scene.h>
#include <crawler/scene/strain_extremes.h>

#include <functional>
#include <memory>
#include <optional>

namespace crawler
{
  /**
   * Body whose strain e(s,t) is given (the level "kinematic"; doc/theory.md, "Prescribed strain"), in natural units.
   * With g = b(s) g(1+e) and <.> the mean over the body:
   *
   *   v = B_t - <g B_t>/<g>,   B = int_0^s e ds,   <v> = -<(g - <g>)(B_t - <B_t>)>/<g>,   m = int_0^s g v ds - k e.
   *
   * Integrals over s are Gauss quadrature on panels.
   */
  class KinematicBody
  {
  public:
    /// @p panels are the ends of the panels, @p points those of fields(). Scene (in natural units) and strain must
    /// outlive it.
    KinematicBody(const Scene &scene,
                  const ActiveStress &strain,
                  const std::vector<double> &panels,
                  const std::vector<double> &points = {});

    /// State at one time, integrated over the body.
    struct Integrals
    {
      CellIntegrals sums;    ///< the mean displacement is 0 here: it is the integral of sums.velocity over time
      double end_power = 0.; ///< [m v] from s = 0 to L
      StrainExtreme smallest, largest;

      Rates
      rates() const
      {
        return rates_of(sums, end_power);
      }
    };

    /// Evaluates the state at time @p t; where a stretch is not positive only the extremes are known, the rest is NaN.
    const Integrals &
    evaluate(double t);

    /// Fields at the time of evaluate(), with the centre of mass displaced by @p displacement since the start.
    ReducedFields
    fields(double displacement);

  private:
    const GaussPanels panels_;
    const std::vector<double> points_;
    std::vector<double> inside_; ///< the Gauss points, then both ends
    const std::unique_ptr<ActiveStressAtPoints> strain_, rate_, strain_at_points_;
    const BodyAtPoints body_, body_at_points_;
    const GaussPanels::Places places_;
    double time_ = 0.;
    std::vector<double> e_, e_t_;
    GivenMotion motion_;
    std::vector<double> m_;
    Integrals integrals_;
  };

  struct KinematicResult
  {
    double displacement = 0., space_error = 0., time_error = 0.; ///< errors of the quadrature
    bool stopped = false;                                        ///< keep_going returned false
    EnergyBalance energies;
    double net_friction = 0.; ///< mean of |int g v ds| over that of int |g v| ds
    StrainExtremes extremes{};
    std::optional<StrainExtreme> inversion;        ///< place without a positive stretch; then the rest is unknown
    std::vector<double> space_panels, time_panels; ///< ends of the panels
  };

  /**
   * Displacement and works of a body with a given strain over 0 <= t <= 1. Panels in t are first chosen such that the
   * strain changes by a few times its size in each (by its bounds, so that no event is missed; if that takes too many
   * the error is infinite). The panels in s and in t are doubled until the changes of the displacement are, each, below
   * a quarter of @p tolerance times the displacement (or of 1e-12), and the works balance to @p tolerance, or until
   * there are a million panels; the changes are the errors, and the values are those of the doubled panels.
   */
  KinematicResult
  kinematic(const Scene &scene,
            const ActiveStress &strain,
            double tolerance,
            const std::function<bool()> &keep_going = {});

  /// Adds the works from @p start to @p end, by one panel of Gauss points, to @p energies; returns the change of the
  /// displacement. @p see gets the state at each of the points and its weight.
  double
  advance(KinematicBody &body,
          double start,
          double end,
          EnergyBalance &energies,
          const std::function<void(const KinematicBody::Integrals &now, double weight)> &see = {});
} // namespace crawler
