// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/optimal_wave.h>
#include <crawler/scene/active_stress/shape_function.h>
#include <crawler/scene/known_stress.h>

namespace crawler
{
  /**
   * The optimal wave for a velocity wave V of any shape (Santhosh and Serra @cite SanthoshSerra2022; their f = alpha V,
   * alpha = a/(L gamma c)), also one without the period of the body length:
   *
   *   m = chi [ gamma ( int_0^s V(s'+ct) ds' - (s/L) int_0^L V(s'+ct) ds' ) - (k/c) ( V(s+ct) - V(s) ) ].
   *
   * To leading order in chi the velocity is chi ( V(s+ct) - its mean over the body ) and the strain
   * (chi/c) ( V(s+ct) - V(s) ). With V = sum a_n sin q_n x + b_n cos q_n x it is the OptimalWave.
   */
  class ShapedWave : public KnownStress
  {
  public:
    /// Makes the wave for Shape = expression or table. Throws InputError if the wave is to be chosen by its energy, or
    /// if V is not given or not continuous wherever the wave comes, min(0, cT) <= x <= L + max(0, cT).
    ShapedWave(const OptimalWaveParameters &parameters, const Body &body, double end_time);

    /// Reports the wave, with the numbers of its leading order.
    void
    report(std::ostream &out) const override;

    /// Leading order in chi, until the end time: D = -(a chi^2/(cL)) int int e' v' ds dt for e' = V(s+ct) - V(s) and v'
    /// = V(s+ct) - its mean; Q = gamma chi^2 int int v'^2 ds dt; E = (k/2) (chi/c)^2 int e'^2 ds at the end.
    struct LeadingOrder
    {
      double displacement; ///< D [length]
      double energy;       ///< Q + E [force length]
      double min_stretch, max_stretch;
    };
    LeadingOrder
    leading_order() const;

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    const double end_time_;
    const std::string shape_name_;
    const Body body_;
    const double chi_, speed_;
    const ShapeFunction shape_; ///< V [length/time]
  };
} // namespace crawler
