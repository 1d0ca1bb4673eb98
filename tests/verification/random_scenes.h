// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "../support/random.h"
#include "../support/run_text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace crawler::test
{
  /// A random scene: its generator, and the entries that make it.
  struct RandomScene
  {
    std::string kind;
    Settings settings;
    double step   = 0.; ///< in which the active stress changes [time]
    double length = 0.; ///< of the smallest features of the active stress [length]
  };

  /// What scenes are drawn from.
  enum class Family
  {
    everything, ///< all that generators, laws and ranges allow
    smooth,     ///< waves, pulses and formulas on usual bodies, for 0.3 to 4 strides
    jumps,      ///< the stress starts suddenly or jumps
    pulse,      ///< passes over the body in a hundredth to a thousandth of the time, or more slowly
    event,      ///< something else for a time between 3e-5 and 3e-3 of the duration
    long_gait,  ///< stiff bodies, 20 to 400 strides
    soft,       ///< soft bodies, k/(gamma L^2 nu) from 2e-5 to 5e-3
    robot       ///< segments that switch with a rate limit or with smooth fronts
  };

  /**
   * Draws one scene of a family; the same for the same number. Most bodies are sensible: their stress, relative to the
   * modulus, is as small as the steepness of the friction asks for. Tables are written into a folder.
   */
  class SceneMachine
  {
  public:
    SceneMachine(const Family family, const unsigned int number, std::filesystem::path folder)
      : family_(family)
      , r((family == Family::everything ? 50000 : 1000) + number)
      , number_(number)
      , folder_(std::move(folder))
    {
      draw_body();
      draw_stress();
      if (allows_laws_ && r.chance(0.35))
        draw_laws();
      else if (allows_laws_ && r.chance(0.2))
        set("Model", "auto");
      else if (allows_laws_ && p == 1. && r.chance(0.5) && scene_.kind != "strain feedback" && scene_.kind != "none")
        set("Model", "linear");
      set("Time/End time", T);
      set("Body/Elastic modulus", k);
      set("Body/Anchoring exponent", p);
      scene_.step = std::min(scene_.step, T / 8.);
    }

    RandomScene
    scene() const
    {
      return scene_;
    }

  private:
    const std::string stress_ = "Active stress/";

    void
    set(const std::string &entry, const std::string &value)
    {
      scene_.settings.emplace_back(entry, value);
    }
    void
    set(const std::string &entry, const double value)
    {
      set(entry, text(value));
    }
    std::string
    one_of(const std::vector<std::string> &words)
    {
      return words[r.whole(0, static_cast<unsigned int>(words.size()) - 1)];
    }
    double
    sign()
    {
      return r.chance(0.5) ? 1. : -1.;
    }
    /// The smallest features of the active stress, by which a reference is made.
    void
    feature(const double length, const double time)
    {
      scene_.length = scene_.length > 0. ? std::min(scene_.length, length) : length;
      scene_.step   = scene_.step > 0. ? std::min(scene_.step, time) : time;
    }
    std::string
    file(const std::string &name, const std::string &content)
    {
      std::filesystem::create_directories(folder_);
      const auto path = std::filesystem::absolute(folder_ / fmt::format("scene_{}_{}.csv", number_, name));
      std::ofstream(path) << content;
      return path.string();
    }

    void
    draw_body()
    {
      L = r.log_uniform(0.1, 10.), gamma = r.log_uniform(0.1, 10.), nu = r.log_uniform(0.1, 10.);
      unit = gamma * L * L * nu;
      set("Body/Length", L);
      set("Body/Friction coefficient", gamma);
      if (family_ != Family::everything)
      {
        const auto [lower, upper] = family_ == Family::soft        ? std::pair(2e-5, 5e-3)
                                    : family_ == Family::long_gait ? std::pair(5., 1000.)
                                                                   : std::pair(0.05, 100.);
        k                         = r.log_uniform(lower, upper) * unit;
        p                         = r.chance(0.3) ? r.whole(0, 7) - 2. : r.uniform(-2., 5.);
        T            = (family_ == Family::long_gait ? r.log_uniform(20., 400.) : r.log_uniform(0.3, 4.)) / nu;
        steep_       = 1. + 0.1 * std::abs(1. - p);
        allows_laws_ = false;
        return;
      }
      k = (r.chance(0.4) ? r.log_uniform(1e-6, 1e6) : r.log_uniform(0.02, 100.)) * unit;
      p = r.chance(0.2)   ? static_cast<double>(r.whole(0, 41)) - 20.
          : r.chance(0.2) ? r.uniform(-20., 21.)
          : r.chance(0.3) ? 2.
                          : r.uniform(-2., 5.);
      // All but few strides.
      T      = (r.chance(0.7) ? r.log_uniform(0.3, 4.) : r.log_uniform(4., 1000.)) / nu;
      steep_ = 1. + 0.1 * std::abs(1. - p);
      if (Random(90000 + number_).chance(0.25)) // a bold one, which may invert
        steep_ = 0.5;
      set("Accuracy", r.log_uniform(1e-9, 1e-2));
    }
    void
    at_most(const double strides)
    {
      T = std::min(T, strides / nu);
    }
    double
    strain()
    {
      return r.log_uniform(0.02, 0.6) / steep_;
    }

    /// The generator; of everything the more frequent the longer its part of [0, 1] is.
    std::string
    generator()
    {
      static const std::map<Family, std::vector<std::string>> generators = {
        {Family::smooth, {"optimal wave", "optimal wave", "travelling wave", "standing wave", "pulse", "expression"}},
        {Family::jumps, {"segments", "expression"}},
        {Family::pulse, {"pulse"}},
        {Family::event, {"expression"}},
        {Family::long_gait, {"optimal wave"}},
        {Family::soft, {"optimal wave"}},
        {Family::robot, {"segments"}}};
      static const std::map<double, std::string> ends = {{0.18, "optimal wave"},
                                                         {0.30, "travelling wave"},
                                                         {0.38, "standing wave"},
                                                         {0.48, "pulse"},
                                                         {0.60, "segments"},
                                                         {0.74, "expression"},
                                                         {0.80, "prescribed strain"},
                                                         {0.88, "strain feedback"},
                                                         {0.92, "table"},
                                                         {0.98, "sum"},
                                                         {1., "none"}};
      return family_ == Family::everything ? ends.upper_bound(r.uniform(0., 1.))->second
                                           : one_of(generators.at(family_));
    }

    void
    draw_stress()
    {
      const std::string name = generator();
      const double size      = strain() * k;
      begin(name);
      if (name == "optimal wave")
        draw_optimal_wave();
      else if (name.ends_with("ing wave"))
        draw_wave(stress_, size, name == "travelling wave");
      else if (name == "pulse")
        draw_pulse(stress_, size);
      else if (name == "segments")
        draw_segments(stress_, size);
      else if (name == "expression")
        draw_formula(size);
      else if (name == "prescribed strain")
        draw_prescribed_strain();
      else if (name == "strain feedback")
        draw_feedback(size);
      else if (name == "table")
        draw_table(size);
      else if (name == "sum")
        draw_sum(size);
      else
      {
        at_most(30.);
        draw_initial_stretch();
      }
    }
    void
    begin(const std::string &generator)
    {
      scene_.kind = generator;
      set(stress_ + "Generator", generator);
    }

    void
    draw_optimal_wave()
    {
      const std::string wave = stress_ + "Optimal wave/";
      const double c = sign() * nu * L, size = r.uniform(0.03, 0.8) / steep_;
      double speed = c;
      if (family_ != Family::everything || r.chance(0.7))
      {
        const unsigned int n = r.whole(1, 4);
        std::string sines, cosines;
        double sum = 0., delta = 0.;
        std::vector<double> powers;
        for (unsigned int i = 0; i < n; ++i)
        {
          const double sine = i == 0 ? 1. : r.uniform(-0.5, 0.5), cosine = n == 1 ? 0. : r.uniform(-0.5, 0.5);
          sum += 2. * std::hypot(sine, cosine);
          powers.push_back((sine * sine + cosine * cosine) * nu * L * nu * L);
          delta += powers.back() / 4.;
          sines += (i > 0 ? ", " : "") + text(sine * nu * L);
          cosines += (i > 0 ? ", " : "") + text(cosine * nu * L);
        }
        set(wave + "Sine coefficients", sines);
        set(wave + "Cosine coefficients", n == 1 ? "0" : cosines);
        feature(L / n, 0.25 / (n * nu));
        set(wave + "Perturbation parameter", (r.chance(0.8) ? 1. : -1.) * size / sum);
        if (r.chance(0.3))
        {
          // The energy of a wave of this speed, so that there is one.
          speed    = c * r.uniform(0.7, 1.5);
          double H = 2. * L * gamma * T * delta;
          if (r.chance(0.8))
            for (unsigned int i = 0; i < n; ++i)
              H += L * k / (speed * speed) * powers[i] / 2. *
                   (1. - std::cos(2. * std::numbers::pi * (i + 1) * speed * T / L));
          set(wave + "Choose wave by", "energy");
          set(wave + "Energy", H);
          set(wave + "Root", r.chance(0.9) ? "largest admissible displacement" : "index");
          return;
        }
      }
      else
      {
        draw_shape(wave, speed);
        set(wave + "Perturbation parameter", (r.chance(0.8) ? 0.5 : -0.5) * size);
      }
      set(wave + "Choose wave by", "wave speed");
      set(wave + "Wave speed", speed);
    }
    void
    draw_shape(const std::string &wave, const double c)
    {
      const double kind = r.uniform(0., 1.);
      set(wave + "Shape", kind < 0.8 ? "expression" : "table");
      if (kind < 0.8)
      {
        const double width = r.log_uniform(0.05, 0.5), n = r.uniform(0.3, 2.5);
        const std::string formula = kind < 0.3 ? fmt::format("V*sin(2*pi*{}*x/L)", text(n))
                                    : kind < 0.6
                                      ? fmt::format("V*exp(-((x/L-{})/{})^2)", text(c > 0. ? 1.5 : -0.5), text(width))
                                    : kind < 0.7 ? std::string("V*(4*abs(mod(x/L,1)-0.5)-1)") // kinks that move
                                                 : fmt::format("V*sin(2*pi*x/L)*exp(0.3*sin(2*pi*{}*x/L))", text(n));
        set(wave + "Shape formula", formula);
        set(wave + "Shape constants", "V=" + text(nu * L));
        feature(kind >= 0.3 && kind < 0.6 ? width * L : 0.3 * L, (kind < 0.6 ? 0.5 * width : 0.1) / nu);
        return;
      }
      at_most(20.);
      std::string rows  = "x,f\n";
      const double from = std::min(0., c * T) - L / 16., to = L + std::max(0., c * T) + L / 16.;
      const auto n = static_cast<unsigned int>((to - from) / L * 16.) + 8;
      for (unsigned int i = 0; i <= n; ++i)
      {
        const double x = from + (to - from) * i / n;
        rows +=
          fmt::format("{},{}\n", x, nu * L * (std::sin(2. * std::numbers::pi * x / L) * 0.8 + r.uniform(-0.05, 0.05)));
      }
      set(wave + "Shape file", file("shape", rows));
      feature(L / 8., 1. / (16. * nu));
    }

    void
    draw_direction(const std::string &section)
    {
      if (r.chance(0.5))
        set(section + "Direction", one_of({"from head to tail", "from tail to head"}));
    }
    void
    draw_window(const std::string &section)
    {
      if (family_ == Family::everything && r.chance(0.3))
      {
        const double edge = r.chance(0.3) ? 0. : r.log_uniform(0.02, 0.25) * L;
        if (r.chance(0.7))
          set(section + "Window start", r.uniform(0., 0.35) * L);
        set(section + "Window end", r.uniform(0.65, 1.) * L);
        set(section + "Window edge", edge);
        if (edge > 0.)
          feature(edge, T);
      }
      if (r.chance(0.5))
        set(section + "Ramp duration", r.uniform(0.2, 1.) / nu);
    }
    double
    draw_profile(const std::string &section)
    {
      const double kind = family_ == Family::everything ? r.uniform(0., 1.) : 0.;
      if (kind < 0.5)
        return 0.25;
      const double duty = r.uniform(0.15, 0.85), front = r.log_uniform(0.02, 0.5) * 2. * std::min(duty, 1. - duty);
      set(section + "Profile", kind < 0.8 ? "smoothed square" : "square");
      set(section + "Duty cycle", duty);
      if (kind < 0.8)
        set(section + "Front width", std::min(front, 0.5));
      else
        scene_.kind += " square";
      return kind < 0.8 ? 0.5 * std::min(front, 0.5) : 0.05;
    }
    void
    draw_wave(const std::string &base, const double size, const bool travels)
    {
      const std::string section = base + (travels ? "Travelling wave/" : "Standing wave/");
      const double n            = r.chance(0.05)   ? 0.
                                  : r.chance(0.3)  ? r.whole(1, 3)
                                  : r.chance(0.85) ? r.log_uniform(0.2, 4.)
                                                   : r.uniform(4., 12.);
      set(section + "Amplitude", sign() * size);
      if (r.chance(0.25))
        set(section + "Offset", r.uniform(-0.3, 0.3) * size);
      set(section + "Wave number", n);
      set(section + "Phase", r.uniform(-3.2, 3.2));
      if (travels)
      {
        draw_direction(section);
        if (n > 0. && r.chance(0.3))
        {
          set(section + "Given by", "wave speed");
          set(section + "Wave speed", nu * L / n);
        }
        else
          set(section + "Frequency", nu);
      }
      else
      {
        set(section + "Frequency", r.chance(0.95) ? nu : 0.);
        set(section + "Phase in space", r.uniform(-3.2, 3.2));
      }
      const double part = draw_profile(section);
      feature(L / std::max(n, 0.5) * (travels ? 2. * part : 0.5), part / nu);
      draw_window(section);
    }

    void
    draw_pulse(const std::string &base, const double size)
    {
      const std::string pulse = base + "Pulse/";
      const double width      = (r.chance(0.9) ? r.log_uniform(0.05, 0.6) : r.log_uniform(1e-3, 0.05)) * L;
      const double speed      = family_ == Family::pulse ? r.log_uniform(0.5, 100.) * nu * L
                                : r.chance(0.95)         ? r.log_uniform(0.2, 3.) * nu * L
                                                         : 0.;
      if (family_ == Family::pulse) // until it has passed, and then some time
        T = r.log_uniform(1., 100.) * (L + 12. * width) / speed;
      set(pulse + "Shape", one_of({"gaussian", "compact"}));
      set(pulse + "Amplitude", sign() * size);
      set(pulse + "Width", width);
      set(pulse + "Speed", speed);
      draw_direction(pulse);
      if (speed > 0. && r.chance(0.5))
        set(pulse + "Repetition period", std::max(r.log_uniform(0.3, 3.) / nu, 1.01 * width / speed));
      if (speed == 0. || r.chance(0.15))
        set(pulse + "Start position", r.uniform(0., 1.) * L);
      feature(width, 0.5 * width / std::max(speed, nu * L));
      draw_window(pulse);
    }

    void
    draw_segments(const std::string &base, const double size)
    {
      const std::string segments = base + "Segments/";
      const auto n      = static_cast<unsigned int>(r.chance(0.95) ? r.log_uniform(1., 17.) : r.uniform(17., 60.));
      const double duty = r.uniform(0.2, 0.8);
      const bool smooth = family_ != Family::jumps && r.chance(0.5);
      std::string sizes = text(size);
      if (r.chance(0.3))
        for (unsigned int i = 1; i < n; ++i)
          sizes += ", " + text(size * r.uniform(0.3, 1.));
      set(segments + "Number of segments", n);
      set(segments + "Amplitude", sizes);
      set(segments + "Frequency", nu);
      set(segments + "Phase lag", r.chance(0.5) ? 1. / n : r.uniform(0., 1.));
      draw_direction(segments);
      set(segments + "Duty cycle", duty);
      if (r.chance(0.3))
        set(segments + "Phase", r.uniform(0., 1.));
      if (r.chance(0.4))
        set(segments + "Gap", r.log_uniform(0.02, 1.));
      if (r.chance(0.2))
        set(segments + "Saturation", size * r.uniform(0.4, 1.));
      double front = 0.05;
      if (smooth)
      {
        front = r.log_uniform(0.02, 0.5) * 2. * std::min(duty, 1. - duty);
        front = std::min(front, 0.5);
        set(segments + "Switching", "smooth");
        set(segments + "Front width", front);
        if (r.chance(0.2))
          set(segments + "Rate limit", 2.2 * size * nu / front);
      }
      else if (family_ == Family::robot || (family_ != Family::jumps && r.chance(0.5)))
        set(segments + "Rate limit", r.log_uniform(1.5, 20.) * size * nu);
      else
        scene_.kind = "segments square";
      if (family_ != Family::jumps && r.chance(0.5))
        set(segments + "Ramp duration", r.uniform(0.2, 1.) / nu);
      feature(L / n, 0.5 * front / nu);
    }

    void
    draw_formula(const double size)
    {
      const std::string section = stress_ + "Expression/";
      const double kind         = family_ == Family::event   ? 0.55
                                  : family_ == Family::jumps ? (r.chance(0.5) ? 0.75 : 0.97)
                                                             : r.uniform(0., family_ == Family::smooth ? 0.5 : 1.);
      const double n = r.whole(1, 3), phase = r.uniform(0., 6.3), drift = r.uniform(-2., 2.);
      double A = size;
      std::string formula;
      feature(L / (2. * n), 0.1 / nu);
      if (kind < 0.3) // 0 at the ends: may be far larger than a soft body's modulus
      {
        A       = strain() * (k + unit / 40.);
        formula = fmt::format("A*sin(pi*s/L)^2*(1-exp(-5*nu*t))*sin(2*pi*({}*s/L+({})*nu*t)+{})", n, drift, phase);
      }
      else if (kind < 0.5)
        formula = fmt::format("A/2*(sin(2*pi*({0}*s/L+nu*t))-sin(2*pi*{0}*s/L))+A/3*(cos(2*pi*({1})*nu*t)-1)"
                              "*sin(pi*s/L)",
                              n,
                              drift);
      else if (kind < 0.6)
      {
        const double width = family_ == Family::event ? r.log_uniform(3e-5, 3e-3) : r.log_uniform(1e-3, 0.3);
        formula            = fmt::format("A*sin(2*pi*(s/L+nu*t))*tanh(5*nu*t)+A*sin({}*pi*s/L)*exp(-((t/T-{})/{})^2)",
                              n,
                              r.uniform(0.05, 0.95),
                              width);
        at_most(30.);
        feature(L, width * T);
      }
      else if (kind < 0.7)
        formula = fmt::format("A*exp(-{}*nu*t)*sin(2*pi*nu*t)*cos(pi*{}*s/L+{})", r.uniform(0., 1.), n, phase);
      else if (kind < 0.8)
        formula = fmt::format("A*tanh({}*sin(2*pi*({}*s/L+nu*t)))", r.uniform(1., 8.), n);
      else if (kind < 0.9)
        formula =
          fmt::format("A*sin(2*pi*({}*s/L+nu*t+0.2*sin(2*pi*{}*nu*t)))*(1-exp(-nu*t*5))", n, r.uniform(0.1, 1.));
      else if (kind < 0.95)
      {
        scene_.kind = "expression with kinks";
        formula     = fmt::format("A*abs(sin(pi*({}*s/L+nu*t)))*min(1,nu*t)", n);
      }
      else
      {
        scene_.kind = "expression with jumps";
        formula     = fmt::format(
          "A*(mod(nu*t+{},1)<0.4 ? 1 : -0.5)*sin({}*pi*s/L{})", phase, n, family_ == Family::jumps ? "+2*pi*nu*t" : "");
      }
      set(section + "Active stress", formula);
      set(section + "Constants", fmt::format("A={}, nu={}", text(A), text(nu)));
    }

    void
    draw_prescribed_strain()
    {
      allows_laws_              = false;
      const std::string section = stress_ + "Prescribed strain/";
      const double e = strain(), kind = r.uniform(0., 1.), n = r.whole(1, 3);
      set("Model", one_of({"nonlinear", "auto", "kinematic"}));
      feature(0.5 * L / n, 0.1 / nu);
      if (kind < 0.5)
      {
        set(section + "Strain",
            r.chance(0.5) ? "e/2*(sin(2*pi*(n*s/L+nu*t))-sin(2*pi*n*s/L))"
                          : "e*sin(2*pi*(n*s/L-nu*t))*(1-exp(-(3*nu*t)^2))");
        set(section + "Constants", fmt::format("e={}, n={}, nu={}", text(e), n, text(nu)));
      }
      else if (kind < 0.8)
      {
        set(section + "Given by", "travelling wave");
        const std::string wave = stress_ + "Travelling wave/";
        set(wave + "Amplitude", e);
        set(wave + "Wave number", n);
        set(wave + "Frequency", nu);
        set(wave + "Ramp duration", r.uniform(0.3, 1.) / nu);
        if (r.chance(0.4))
        {
          set(wave + "Profile", "smoothed square");
          set(wave + "Front width", r.uniform(0.1, 0.5));
          feature(0.1 * L / n, 0.05 / nu);
        }
      }
      else
      {
        set(section + "Given by", "pulse");
        const std::string pulse = stress_ + "Pulse/";
        const double width      = r.log_uniform(0.08, 0.5) * L;
        set(pulse + "Amplitude", sign() * e);
        set(pulse + "Width", width);
        set(pulse + "Speed", nu * L);
        set(pulse + "Repetition period", 2. / nu);
        feature(width, 0.5 * width / (nu * L));
        if (width > 0.1 * L)
          set(pulse + "Ramp duration", 0.5 / nu);
      }
    }

    void
    draw_feedback(const double size)
    {
      const std::string section = stress_ + "Strain feedback/";
      const double kind         = r.uniform(0., 1.);
      std::string reflex, constants;
      at_most(kind < 0.6 ? 300. : 20.);
      if (kind < 0.3)
        reflex = one_of({"q*(w-1)", "q*(w-1)^3", "q*tanh(w-1)", "q*sin(pi*s/L)*(w-1)"});
      else if (kind < 0.6)
        reflex = one_of({"eta*w_t", "q*(w-1)+eta*w_t", "eta*w_t*w"});
      else if (kind < 0.8)
      {
        reflex = one_of({"q*(w_near-1)", "0.2*k*tanh(q/k*(w_near-1)/0.2)"});
        set(section + "Distance", sign() * r.uniform(0.05, 0.5) * L);
        if (r.chance(0.6))
          set(section + "Sensor length", r.uniform(0.05, 0.3) * L);
      }
      else
      {
        reflex = one_of({"q*(w_delayed-1)", "q*(w-w_delayed)"});
        set(section + "Delay", r.uniform(0.05, 0.5) / nu);
      }
      set(section + "Active stress",
          fmt::format("A*sin(2*pi*({}*s/L+({})*nu*t)+{})*tanh(3*nu*t)+{}",
                      r.whole(1, 2),
                      text(sign()),
                      text(r.uniform(0., 6.3)),
                      reflex));
      set(section + "Constants",
          fmt::format("A={}, nu={}, q={}, eta={}, k={}",
                      text(0.5 * size),
                      text(nu),
                      text(r.uniform(-0.5, 0.8) * k),
                      text(r.log_uniform(0.01, 1.) * k / nu),
                      text(k)));
      feature(L / 4., 0.1 / nu);
    }

    void
    draw_table(const double size)
    {
      at_most(100.);
      const std::string section = stress_ + "Table/";
      const unsigned int ns = r.whole(5, 33), nt = r.whole(9, 65);
      const bool periodic = r.chance(0.6);
      const double end = periodic || r.chance(0.3) ? 1. / nu : std::min(T, 8. / nu), n = r.whole(1, 2);
      const double phase = r.uniform(0., 6.3);
      std::string rows   = "s,t,m\n";
      for (unsigned int j = 0; j <= nt; ++j)
        for (unsigned int i = 0; i <= ns; ++i)
        {
          const double s = L * i / ns, t = end * j / nt, f = 2. * std::numbers::pi * (nu * t - (j == nt && periodic));
          rows += fmt::format("{:.17g},{:.17g},{:.17g}\n",
                              s,
                              t,
                              size *
                                (std::sin(2. * std::numbers::pi * n * s / L + f + phase) -
                                 std::sin(2. * std::numbers::pi * n * s / L + phase)) /
                                2.);
        }
      set(section + "File", file("actuation", rows));
      set(section + "Outside", periodic ? "periodic" : "hold");
      set(section + "Interpolation", one_of({"cubic", "cubic", "linear"}));
      feature(L / ns, end / nt);
    }

    void
    draw_sum(const double size)
    {
      const auto term   = [&](const unsigned int i) { return fmt::format("{}Sum/Term {}/", stress_, i); };
      const double kind = r.uniform(0., 1.);
      if (kind < 0.4)
      {
        set(term(1) + "Generator", "travelling wave");
        draw_wave(term(1), size, true);
      }
      else if (kind < 0.7)
      {
        set(term(1) + "Generator", "segments");
        draw_segments(term(1), size);
      }
      else
      {
        set(term(1) + "Generator", "pulse");
        draw_pulse(term(1), size);
      }
      scene_.kind = scene_.kind.ends_with("square") ? "sum square" : "sum";
      set(term(2) + "Generator", "expression");
      if (r.chance(0.5))
      {
        set(term(2) + "Combine", "multiply");
        set(term(2) + "Expression/Active stress", one_of({"0.5+0.5*s/L", "1-exp(-3*t/T)", "sin(pi*s/L)^2"}));
      }
      else
      {
        set(term(2) + "Factor", 0.4 * size);
        set(term(2) + "Expression/Active stress", one_of({"1", "s/L", "sin(7*t/T)"}));
        set(term(2) + "Window in s", text(r.uniform(0., 0.4) * L) + ", " + text(r.uniform(0.6, 1.1) * L));
        set(term(2) + "Window in t", text(r.uniform(0., 0.4) * T) + ", " + text(r.uniform(0.6, 1.1) * T));
        if (r.chance(0.8))
        {
          set(term(2) + "Edge width in s", 0.1 * L);
          set(term(2) + "Edge width in t", 0.1 * T);
          feature(0.1 * L, 0.05 * T);
        }
      }
    }

    /// A factor along the body or the ground, a formula or a table.
    std::string
    factor(const std::string &variable, const std::string &name, const std::string &interpolation, const double most)
    {
      const double q = r.uniform(0.05, most);
      if (r.chance(0.7))
      {
        if (variable == "x")
          return fmt::format("1+{}*sin(2*pi*x/{})", text(q), text(r.log_uniform(0.2, 4.) * L));
        const std::string shape =
          one_of({"cos(pi*s/L)", "sin(2*pi*s/L)", "(s/L-0.5)", "exp(-((s/L-0.4)/0.15)^2)", "tanh(10*(s/L-0.6))"});
        return fmt::format("1+({})*{}", text(sign() * q), shape);
      }
      std::string rows     = variable + ",value\n";
      const unsigned int n = r.whole(4, 12);
      for (unsigned int i = 0; i <= n; ++i)
        rows += fmt::format("{},{}\n",
                            (variable == "x" ? -1. + 3. * i / n : 1. * i / n) * L,
                            1. + 0.5 * q * (std::sin(3. * i) + r.uniform(-1., 1.)));
      if (r.chance(0.4))
        set(interpolation, "linear");
      feature(L / n, T);
      return file(name, rows);
    }
    void
    draw_initial_stretch()
    {
      set("Body/Initial stretch", factor("s", "stretch", "Body/Profile interpolation", 0.5 / std::max(1., steep_)));
    }
    void
    draw_laws()
    {
      const double kind = r.uniform(0., 1.);
      const auto has = [&](const double from, const double to) { return (kind >= from && kind < to) || r.chance(0.1); };
      if (has(0., 0.2))
        set("Body/Elastic modulus profile", factor("s", "modulus", "Body/Profile interpolation", 0.6));
      if (has(0.2, 0.35))
        set("Body/Friction profile", factor("s", "friction", "Body/Profile interpolation", 0.6));
      if (has(0.35, 0.5) && scene_.kind != "none")
        draw_initial_stretch();
      if (has(0.5, 0.65))
        set("Ground/Profile", factor("x", "ground", "Ground/Profile interpolation", 0.6));
      if (has(0.65, 0.85))
      {
        const bool formula = r.chance(0.7);
        set("Ground/Friction law", formula ? "expression" : "Newtonian");
        if (formula)
          set("Ground/Expression",
              one_of({"1/w", "(1+w^2)/(2*w)", "exp(2*(1-w))", "1/(0.2+w)", "w^1.5", "1+0.5*tanh(5*(1-w))"}));
      }
      if (has(0.85, 1.))
      {
        set("Ground/Backward ratio", r.log_uniform(0.1, 10.));
        set("Ground/Switching velocity", r.log_uniform(0.01, 1.) * nu * L);
      }
    }

    const Family family_;
    Random r;
    const unsigned int number_;
    const std::filesystem::path folder_;
    RandomScene scene_;
    double L = 1., gamma = 1., nu = 1., unit = 1., k = 1., p = 2., T = 1., steep_ = 1.;
    bool allows_laws_ = true;
  };

  /// Scene @p number of @p family; its tables are in @p folder.
  inline RandomScene
  random_scene(const Family family, const unsigned int number, const std::filesystem::path &folder = ".")
  {
    return SceneMachine(family, number, folder).scene();
  }
} // namespace crawler::test
