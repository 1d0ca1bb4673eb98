// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/prescribed_strain.h>

#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Two-level wave".
  struct TwoLevelWaveParameters
  {
    double smallest_strain = -0.3, largest_strain = 0.3; ///< [1]
    std::optional<double> share;                         ///< of a period at the largest strain [1]; unset: the best
    double front_width    = 0.05;                        ///< [1], a fraction of the period
    double wave_number    = 1.;                          ///< waves on the body [1]
    std::string direction = "from head to tail";
    std::string given_by  = "frequency";
    double frequency      = 1.;   ///< [1/time]
    double wave_speed     = 1.;   ///< [length/time]
    double work           = 0.01; ///< over the whole duration [force length]
    double phase          = 0.;   ///< [rad]
    double ramp_duration  = 0.;   ///< [time]

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * The gait with the largest displacement for its work and its extreme strains (doc/theory.md, "Gait efficiency"): a
   * wave of strain of constant speed with two levels, e = emax on the fraction p of each period and emin on the rest,
   * with smooth fronts. It is a TravellingWave read as strain. The best fraction is p = 1/(1 +
   * sqrt(g(1+emax)/g(1+emin))); the shorter its fronts, the closer the wave comes to the bound.
   */
  class TwoLevelWave : public PrescribedStrain
  {
  public:
    /// Throws InputError if strains or fronts do not fit, or if the work of the wave depends on its phase but is given.
    TwoLevelWave(const TwoLevelWaveParameters &parameters, const Scene &scene);

    /// Reports the choices and the attainable displacement.
    void
    report(std::ostream &out) const override;

    /// Results of the entries. The merit of a gait is D/sqrt(W T/(gamma L)) of displacement D and work W.
    struct Numbers
    {
      double share;     ///< p [1]
      double frequency; ///< [1/time]
      double merit;     ///< of whole waves with these fronts at full strain on a uniform body [1]
      double bound;     ///< F, bound of the merit of all gaits with these strains [1]
    };
    const Numbers &
    numbers() const
    {
      return numbers_;
    }

  private:
    const TwoLevelWaveParameters parameters_;
    const Numbers numbers_;
  };
} // namespace crawler
