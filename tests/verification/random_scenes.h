// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "../support/run_text.h"
#include "../support/with_breaks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace crawler::test
{
  /// A scene of the calibration study: its kind, and the entries that make it.
  struct RandomScene
  {
    std::string kind; ///< wave, waves, pulse, standing or sudden; or start, switch or segments
    Settings settings;
    std::vector<double> in_space, in_time; ///< breaks of the active stress
    double step   = 0.;                    ///< no step of a reference may be longer, if this is not 0 [time]
    double length = 0.;                    ///< of the smallest features of the active stress, if known [length]

    /// The scene of @p parameters, which have the settings.
    Scene
    create(const Parameters &parameters) const
    {
      Scene scene = parameters.create_scene();
      if (!in_space.empty() || !in_time.empty())
        scene.active_stress = std::make_unique<WithBreaks>(std::move(scene.active_stress), in_space, in_time);
      return scene;
    }
  };

  /// This part of the values is below it; not a number if there are none.
  inline double
  quantile(std::vector<double> values, const double part)
  {
    std::sort(values.begin(), values.end());
    const auto place = static_cast<std::size_t>(part * static_cast<double>(values.size()));
    return values.empty() ? NAN : values[std::min(values.size() - 1, place)];
  }

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
    const double k    = r.log_uniform(0.02, 100.) * gamma * L * L * nu;
    const double T    = r.log_uniform(0.3, 4.) / nu;
    scene.settings    = set("L = {}; gamma = {}; k = {}; p = {}; T = {}", L, gamma, k, 1. - a, T);
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
      scene.settings   = with(scene.settings,
                            "chi = {}; c = {}; optimal wave; Sine coefficients = {}; Cosine coefficients = {}",
                            r.chance(0.8) ? chi : -chi,
                            c,
                            sines,
                            cosines);
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
    scene.settings = with(scene.settings, "expression; Active stress = {}; Constants = A={}, nu={}", formula, A, nu);
    return scene;
  }

  /// Displacement of the nonlinear model, to a relative 1e-6; nothing if the run does not finish.
  inline std::optional<double>
  true_displacement(const Settings &settings)
  {
    const SimulationResult result = run_with(with(settings, "Accuracy = 1e-6"), {}).result;
    return result.time.status == Status::finished ? std::optional(result.displacement) : std::nullopt;
  }

  /// The scenes from this number on are jumping_scene()s.
  constexpr unsigned int first_jumping_scene = 10000;

  /**
   * Scene number @p number of those whose stress starts or jumps suddenly; body and time as in random_scene(),
   * stiffness from 0.05, strength up to 0.4 k. A third each are waves that start suddenly, waves that turn round at one
   * to four times, and two to six segments of unequal length that switch between two values, one after the other.
   */
  inline RandomScene
  jumping_scene(const unsigned int number)
  {
    Random r(1000 + number);
    RandomScene scene;
    const double a = r.chance(0.3) ? static_cast<double>(r.whole(0, 6)) - 3. : r.uniform(-3., 3.);
    const double L = r.log_uniform(0.1, 10.), gamma = r.log_uniform(0.1, 10.), nu = r.log_uniform(0.1, 10.);
    const double k    = r.log_uniform(0.05, 100.) * gamma * L * L * nu;
    const double T    = r.log_uniform(0.3, 3.) / nu;
    const double A    = r.uniform(0.03, 0.4) * k;
    const double kind = r.uniform(0., 1.);
    std::string formula;
    if (kind < 1. / 3.)
    {
      scene.kind = "start";
      formula    = fmt::format("A*sin(2*pi*({}*s/L+nu*t)+{})", text(r.uniform(0.3, 2.)), text(r.uniform(0., 6.3)));
    }
    else if (kind < 2. / 3.)
    {
      scene.kind           = "switch";
      const unsigned int n = r.whole(1, 4);
      for (unsigned int i = 0; i < n; ++i)
        scene.in_time.push_back(T * (i + r.uniform(0.1, 0.9)) / n);
      // Nested from the last to the first.
      std::string sign = n % 2 == 0 ? "1" : "-1";
      for (unsigned int i = n; i-- > 0;)
        sign = fmt::format("(t<{} ? {} : {})", text(scene.in_time[i]), i % 2 == 0 ? "1" : "-1", sign);
      formula =
        fmt::format("A*sin(2*pi*({}*s/L+nu*t)+{})*{}", text(r.uniform(0.3, 1.5)), text(r.uniform(0., 6.3)), sign);
    }
    else
    {
      scene.kind           = "segments";
      const unsigned int n = r.whole(2, 6);
      const double lag = r.uniform(-0.4, 0.4), low = r.uniform(-1., 0.5), duty = r.uniform(0.2, 0.8);
      std::vector<std::string> values;
      for (unsigned int i = 0; i < n; ++i)
      {
        if (i > 0)
          scene.in_space.push_back(L * (i + r.uniform(-0.2, 0.2)) / n);
        const double phase = i * lag - std::floor(i * lag);
        values.push_back(fmt::format("(mod(nu*t+{},1)<{} ? 1 : {})", text(phase), text(duty), text(low)));
        for (unsigned int stride = 0; stride < 6; ++stride)
          for (const double edge : {0., duty})
            scene.in_time.push_back((stride + edge - phase) / nu);
      }
      formula = values.back();
      for (unsigned int i = n - 1; i-- > 0;)
        formula = fmt::format("(s<{} ? {} : {})", text(scene.in_space[i]), values[i], formula);
      formula = "A*" + formula;
    }
    scene.settings =
      set("L = {}; gamma = {}; k = {}; p = {}; T = {}; expression; Active stress = {}; Constants = A={}, nu={}",
          L,
          gamma,
          k,
          1. - a,
          T,
          formula,
          A,
          nu);
    return scene;
  }

  /// The scenes from this number on are hard_scene()s.
  constexpr unsigned int first_hard_scene = 20000;

  /**
   * Scene number @p number of those that are easily misjudged, L = gamma = 1; a fifth each are
   *  - pulses, single or repeated, that pass over the body in a hundredth to a thousandth of the time, or more slowly;
   *  - events: a wave, and for a time between 3e-5 and 3e-3 of the duration something else;
   *  - long gaits: stiff bodies, 20 to 400 strides;
   *  - soft bodies, k T/(gamma L^2) from 2e-5 to 1e-3;
   *  - robots of 3 to 16 segments that switch with a rate limit or with smooth fronts, with and without gaps.
   */
  inline RandomScene
  hard_scene(const unsigned int number)
  {
    Random r(1000 + number);
    RandomScene scene;
    double k = r.log_uniform(0.3, 30.), T = 1.;
    const double p  = r.uniform(-2., 4.);
    const auto wave = [](const double chi, const double c) { return set("chi = {}; c = {}", chi * std::abs(c), c); };
    switch (number % 5)
    {
      case 0:
      {
        scene.kind         = "pulse";
        const double width = r.uniform(0.08, 0.3), speed = r.log_uniform(0.5, 100.);
        const bool repeats = r.chance(0.5);
        // Until it has passed, and then some time.
        T                      = r.log_uniform(1., 100.) * (1. + 12. * width) / speed;
        const double amplitude = r.uniform(0.05, 0.4) * k * (r.chance(0.7) ? 1. : -1.),
                     period    = repeats ? T / r.uniform(1.5, 6.) : 0.;
        scene.settings         = set("pulse; Amplitude = {}; Width = {}; Speed = {}; Repetition period = {}",
                             amplitude,
                             width,
                             speed,
                             repeats && speed * T / 6. < width ? 0. : period);
        scene.step             = 0.5 * width / speed;
        break;
      }
      case 1:
      {
        scene.kind         = "event";
        const double width = r.log_uniform(3e-5, 3e-3), time = r.uniform(0.01, 0.99);
        const double B = r.uniform(-0.6, 0.6) * k, A = r.uniform(0.02, 0.2) * k; // in the order of the draws
        scene.settings = set("expression; Constants = A={}, B={}, q={}, w={}; "
                             "Active stress = A*sin(2*pi*(s+t))*tanh(5*t)+B*sin(pi*s)*sin(2*pi*s)*exp(-((t-q)/w)^2)",
                             A,
                             B,
                             time,
                             width);
        scene.step     = width;
        break;
      }
      case 2:
      {
        scene.kind     = "long";
        k              = r.log_uniform(5., 1000.);
        const double c = r.log_uniform(0.2, 1.2) * (r.chance(0.5) ? 1. : -1.);
        T              = r.log_uniform(20., 400.) / std::abs(c);
        scene.settings = wave(r.uniform(0.02, 0.4), c);
        break;
      }
      case 3:
      {
        scene.kind       = "soft";
        k                = r.log_uniform(2e-5, 1e-3);
        const double chi = r.uniform(0.05, 0.35), size = r.log_uniform(0.5, 2.);
        scene.settings = wave(chi, r.chance(0.5) ? size : -size);
        break;
      }
      default:
      {
        scene.kind             = "switching";
        const unsigned int n   = r.whole(3, 16);
        T                      = r.uniform(1., 3.);
        const bool smooth      = r.chance(0.5);
        const double amplitude = r.uniform(0.05, 0.3) * k, lag = r.uniform(0.3, 2.) / n, duty = r.uniform(0.3, 0.6),
                     ramp = r.uniform(0.2, 0.8), gap = r.chance(0.5) ? r.uniform(0.05, 0.3) / n : 0.;
        scene.settings = set("segments; Number of segments = {}; Amplitude = {}; Phase lag = {}; Duty cycle = {}; "
                             "Ramp duration = {}; Gap = {}; {}",
                             n,
                             amplitude,
                             lag,
                             duty,
                             ramp,
                             gap,
                             smooth ? fmt::format("Switching = smooth; Front width = {}", r.uniform(0.05, 0.25))
                                    : fmt::format("Rate limit = {}", r.uniform(1., 5.) * k));
      }
    }
    scene.settings = with(scene.settings, "p = {}; k = {}; T = {}", p, k, T);
    return scene;
  }
} // namespace crawler::test
