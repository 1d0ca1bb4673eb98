// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/wave_roots.h>
#include <crawler/scene/body.h>
#include <crawler/scene/known_stress.h>

#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Optimal wave".
  struct OptimalWaveParameters
  {
    double perturbation_parameter           = 0.4; ///< chi [1]
    std::vector<double> sine_coefficients   = {1.};
    std::vector<double> cosine_coefficients = {0.};
    std::string shape                       = "Fourier";
    std::string shape_formula               = "sin(2*pi*x/L)";
    std::string shape_constants             = "";
    std::string shape_file                  = "shape.csv";
    std::string choose_wave_by              = "energy";
    double energy                           = 0.5;
    std::string root                        = "largest admissible displacement";
    unsigned int root_index                 = 1;
    double wave_speed                       = 1.;

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * The optimal wave of Santhosh and Serra @cite SanthoshSerra2022, to leading order in chi:
   *
   *   m = chi sum_n [ gamma ( a_n (cos q c t - cos q(s+ct)) + b_n (sin q(s+ct) - sin q c t) )/q
   *                   - (k/c) ( a_n (sin q(s+ct) - sin q s) + b_n (cos q(s+ct) - cos q s) ) ],   q = 2 pi n/L,
   *
   * with the wave speed given, or chosen among the waves that spend a given energy H (wave_roots.h). Its shape is given
   * by Fourier coefficients; for other shapes see ShapedWave. Its period is L/(|c| n), n the greatest common divisor of
   * its harmonics' numbers.
   */
  class OptimalWave : public KnownStress
  {
  public:
    /// Throws InputError if no wave spends the energy, if the requested root does not exist, or if the lists of
    /// coefficients do not fit together.
    OptimalWave(const OptimalWaveParameters &parameters, const Body &body, double end_time);

    /// Reports the wave, and all roots if it was chosen by its energy.
    void
    report(std::ostream &out) const override;

    /// The chosen wave.
    const WaveRoot &
    wave() const
    {
      return wave_;
    }
    const WaveShape &
    shape() const
    {
      return shape_;
    }
    double
    perturbation_parameter() const
    {
      return chi_;
    }

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    void
    choose_by_energy(const OptimalWaveParameters &parameters);
    void
    require_computable() const;

    const Body body_;
    const double chi_;
    const double end_time_;
    WaveShape shape_;
    WaveRoot wave_{};
    std::optional<WaveRoots> roots_; ///< if the wave was chosen by its energy
    std::size_t chosen_ = 0;
  };
} // namespace crawler
