// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/known_stress.h>

#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Modes".
  struct ModesParameters
  {
    unsigned int harmonics      = 2; ///< N, along the body [1]
    std::string in_time         = "travelling";
    double wave_speed           = 1.; ///< [length/time]
    double period               = 1.; ///< [time]
    unsigned int time_harmonics = 1, time_cells = 10;
    bool from_rest                   = false;
    std::vector<double> coefficients = {0., 0.1}; ///< [force]

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * A sum of modes, linear in its coefficients c, for optimisation without choosing a shape first. Along the body they
   * are phi = 1, sin x, cos x, ..., sin Nx, cos Nx, x = 2 pi s/L. In time
   *
   *   travelling: m = sum_k c_k phi_k(s + ct);
   *   harmonics:  m = sum_jk c_jk psi_j(t) phi_k(s), psi = 1, sin y, cos y, ..., y = 2 pi t/P;
   *   splines:    likewise with psi = the cubic B-splines on equal cells of [0, T].
   *
   * From rest: m at t = 0 is subtracted; of the splines the first, the only one that is not 0 there, is left out.
   */
  class Modes : public KnownStress
  {
  public:
    /// Throws InputError if there are more coefficients than modes; missing ones are 0.
    Modes(const ModesParameters &parameters, double length, double end_time);

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    /// Computes the amplitudes of the modes along the body at one time.
    void
    amplitudes(double t, bool rate, std::vector<double> &amplitudes) const;
    void
    time_functions(double t, bool rate, std::vector<double> &psi) const;

    const ModesParameters parameters_;
    const double length_, end_time_;
    std::size_t n_space_, n_time_ = 1; ///< numbers of modes
    std::vector<double> c_, at_rest_;  ///< [time][space]; amplitudes to be subtracted
  };
} // namespace crawler
