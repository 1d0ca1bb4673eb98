// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "../support/run_text.h"

#include <cmath>
#include <random>

namespace crawler::test
{
  /// A scene of the calibration study: its kind, and the entries that make it.
  struct RandomScene
  {
    std::string kind; ///< wave, waves, pulse, standing or sudden
    Settings settings;
  };

  /// Numbers that are the same everywhere (distributions of the standard library are not).
  class Random
  {
  public:
    explicit Random(const unsigned int seed)
      : engine_(seed)
    {
    }

    double
    uniform(const double lower, const double upper)
    {
      return lower + (upper - lower) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    }
    double
    log_uniform(const double lower, const double upper)
    {
      return lower * std::exp(uniform(0., std::log(upper / lower)));
    }
    unsigned int
    whole(const unsigned int lower, const unsigned int upper)
    {
      return lower + static_cast<unsigned int>(uniform(0., 1.) * (upper - lower + 1));
    }
    bool
    chance(const double probability)
    {
      return uniform(0., 1.) < probability;
    }

  private:
    std::mt19937_64 engine_;
  };

  /**
   * Scene number @p number. a is in [-4, 3] (in 3 of 10 scenes a whole number), L and gamma in [0.1, 10], strides per
   * time nu in [0.1, 10], stiffness k/(gamma L^2 nu) in [0.02, 100], 0.3 to 4 strides (all but a log-uniform). 40 % are
   * optimal waves in both directions with 1 to 3 harmonics and a strain up to 0.85, the others formulas of strength up
   * to k/2: two travelling waves, a pulse of width 0.08 L to 0.4 L, standing waves with a drift, and 6 % waves that do
   * not start from 0.
   */
  inline RandomScene
  random_scene(const unsigned int number)
  {
    Random r(1000 + number);
    RandomScene scene;
    const double a = r.chance(0.3) ? static_cast<double>(r.whole(0, 7)) - 4. : r.uniform(-4., 3.);
    const double L = r.log_uniform(0.1, 10.), gamma = r.log_uniform(0.1, 10.), nu = r.log_uniform(0.1, 10.);
    const double k = r.log_uniform(0.02, 100.) * gamma * L * L * nu;
    const double T = r.log_uniform(0.3, 4.) / nu;
    scene.settings = {{"Body/Length", text(L)},
                      {"Body/Friction coefficient", text(gamma)},
                      {"Body/Elastic modulus", text(k)},
                      {"Body/Anchoring exponent", text(1. - a)},
                      {"Time/End time", text(T)}};
    const auto set = [&scene](const std::string &entry, const std::string &value)
    {
      scene.settings.emplace_back("Active stress/" + entry, value);
    };
    const double kind = r.uniform(0., 1.);
    if (kind < 0.4)
    {
      scene.kind           = "wave";
      const double c       = r.chance(0.5) ? nu * L : -nu * L;
      const unsigned int n = r.whole(1, 3);
      std::string sines, cosines;
      double sum = 0.;
      for (unsigned int i = 0; i < n; ++i)
      {
        const double sine = i == 0 ? 1. : r.uniform(-0.5, 0.5), cosine = n == 1 ? 0. : r.uniform(-0.5, 0.5);
        sum += 2. * std::hypot(sine, cosine);
        sines += (i > 0 ? ", " : "") + text(sine * nu * L);
        cosines += (i > 0 ? ", " : "") + text(cosine * nu * L);
      }
      const double chi = r.uniform(0.03, 0.85) / sum;
      set("Optimal wave/Perturbation parameter", text(r.chance(0.8) ? chi : -chi));
      set("Optimal wave/Sine coefficients", sines);
      set("Optimal wave/Cosine coefficients", cosines);
      set("Optimal wave/Choose wave by", "wave speed");
      set("Optimal wave/Wave speed", text(c));
      return scene;
    }
    const double A = r.uniform(0.03, 0.5) * k;
    std::string formula;
    if (kind < 0.6)
    {
      scene.kind               = "waves";
      const unsigned int first = r.whole(1, 3), second = r.whole(1, 4);
      const double speed = r.uniform(-2., 2.), phase = r.uniform(0., 6.3), part = r.uniform(0., 0.5);
      formula = fmt::format("A/2*(sin(2*pi*({0}*s/L+nu*t))-sin(2*pi*{0}*s/L))"
                            "+{1}*A/2*(sin(2*pi*({2}*s/L+({3})*nu*t)+{4})-sin(2*pi*{2}*s/L+{4}))",
                            first,
                            text(part),
                            second,
                            text(speed),
                            text(phase));
    }
    else if (kind < 0.8)
    {
      scene.kind         = "pulse";
      const double place = r.uniform(0., 1.), speed = r.uniform(-1., 1.), width = r.log_uniform(0.08, 0.4);
      formula = fmt::format("A*sin(pi*nu*t)^2*exp(-((s/L-{}-({})*nu*t)/{})^2)", text(place), text(speed), text(width));
    }
    else if (kind < 0.94)
    {
      scene.kind           = "standing";
      const unsigned int n = r.whole(1, 3);
      const double phase = r.uniform(0., 3.), beat = r.uniform(0.3, 2.), drift = r.uniform(-0.5, 0.5),
                   center = r.uniform(0., 1.);
      formula             = fmt::format("A*sin(2*pi*nu*t)*sin(pi*{}*s/L+{})*(0.5+0.5*sin(2*pi*nu*t*{}))"
                                        "+({})*A*(1-exp(-3*nu*t))*(s/L-{})",
                            n,
                            text(phase),
                            text(beat),
                            text(drift),
                            text(center));
    }
    else
    {
      scene.kind           = "sudden";
      const unsigned int n = r.whole(1, 2);
      formula              = fmt::format("A*sin(2*pi*({}*s/L+nu*t)+{})", n, text(r.uniform(0., 6.3)));
    }
    set("Generator", "expression");
    set("Expression/Active stress", formula);
    set("Expression/Constants", fmt::format("A={}, nu={}", text(A), text(nu)));
    return scene;
  }
} // namespace crawler::test
