// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/optimal_wave.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string section = "Active stress/Optimal wave/";
  } // namespace

  void
  OptimalWaveParameters::add_parameters(Declarations &declarations)
  {
    declarations.number("Perturbation parameter", perturbation_parameter, any_number(), "1")
      .means("Perturbation parameter chi: the active stress is proportional to it, the displacement to its square.");
    declarations.choice("Shape", shape, {"Fourier", "expression", "table"})
      .means("How the velocity wave V(x) is given: by Fourier coefficients, a formula or a table. The active stress "
             "moves V along the body; x = s at t = 0.");
    declarations.numbers("Sine coefficients", sine_coefficients, "length/time")
      .means("Fourier coefficients a_1, a_2, ... of the velocity wave.");
    declarations.numbers("Cosine coefficients", cosine_coefficients, "length/time")
      .means("Fourier coefficients b_1, b_2, ... of the velocity wave: as many as there are sine coefficients, or a "
             "single 0 for none.");
    declarations.text("Shape formula", shape_formula, "a formula of x", "length/time")
      .means("The velocity wave V as a formula of x, continuous, like that of Active stress/Expression; it need not "
             "repeat after the length of the body. Used if Shape is expression.");
    declarations.constants("Shape constants", shape_constants, {"Shape formula"})
      .means("Constants that the formula may use.");
    declarations.file("Shape file", shape_file, "the name of a CSV file")
      .means(
        "Table with the header x,f: values of the velocity wave V at increasing x, with a cubic spline through them; "
        "from min(0, cT) to L + max(0, cT) for the wave speed c and the end time T. Used if Shape is table.");
    declarations.choice("Choose wave by", choose_wave_by, {"energy", "wave speed"})
      .means("Whether the wave is given by its speed, or is one of those that spend a given energy (only for Shape = "
             "Fourier).");
    declarations.number("Energy", energy, positive(), "force length")
      .means(
        "Energy H that the wave spends until the end time (chi^2 H in all). Used if the wave is chosen by energy.");
    declarations.choice("Root", root, {"largest admissible displacement", "largest displacement", "index"})
      .means("Which of the waves of that energy: the one that goes farthest among those whose leading-order stretch "
             "stays positive, or among all, or the one with the number Root index.");
    declarations.whole_number("Root index", root_index, 1, 100000)
      .means("Number of the wave, the slowest being 1 (crawler check lists them). Used if Root is index.");
    declarations.number("Wave speed", wave_speed, any_number(), "length/time")
      .means("Wave speed c, not 0; a positive one runs from s = L to s = 0. Used if the wave is chosen by wave speed.");
  }

  OptimalWave::OptimalWave(const OptimalWaveParameters &parameters, const Body &body, const double end_time)
    : body_(body)
    , chi_(parameters.perturbation_parameter)
    , end_time_(end_time)
    , shape_{parameters.sine_coefficients, parameters.cosine_coefficients}
  {
    if (shape_.b.size() == 1 && shape_.b[0] == 0.)
      shape_.b.assign(shape_.a.size(), 0.);
    if (shape_.a.size() == 1 && shape_.a[0] == 0.)
      shape_.a.assign(shape_.b.size(), 0.);
    if (shape_.a.size() != shape_.b.size())
      refuse(section + "Cosine coefficients",
             "{} sine and {} cosine coefficients; equally many of both are expected, or a single 0",
             shape_.a.size(),
             shape_.b.size());
    if (shape_.delta_2() == 0.)
      throw InputError("all coefficients of the wave are 0; at least one that is not is expected (for a body at "
                       "rest set Active stress/Generator = none)",
                       section + "Sine coefficients");
    if (parameters.choose_wave_by == "energy")
      choose_by_energy(parameters);
    else if (parameters.wave_speed == 0.)
      throw InputError("the wave speed is 0, but a number that is not 0 is expected", section + "Wave speed");
    else
      wave_ = describe_wave(body_, shape_, chi_, end_time_, parameters.wave_speed);
    require_computable();
    facts_.has_rate      = false;
    unsigned int divisor = 0;
    for (unsigned int n = 1; n <= shape_.a.size(); ++n)
      if (shape_.power(n) != 0.)
        divisor = std::gcd(divisor, n);
    if (divisor != 0 && chi_ != 0.)
      facts_.repetition = {body_.length / (std::abs(wave_.speed) * divisor), 0.};
  }

  void
  OptimalWave::require_computable() const
  {
    constexpr double most   = 1e8; // a stride takes at least ten steps, and a run has at most 1e9
    const std::string entry = section + (roots_ ? "Energy" : "Wave speed");
    const double strides    = std::abs(wave_.speed) / body_.length * end_time_;
    if (!(strides <= most))
      refuse(entry,
             "the wave with speed {:g} makes {:.3g} strides until the end time, but at most {:g} "
             "are expected",
             wave_.speed,
             strides,
             most);
    for (const double value : {wave_.multiplier, wave_.displacement, wave_.min_stretch, wave_.max_stretch})
      if (!std::isfinite(value))
        refuse(entry,
               "the wave with speed {:g} would deform the body without bounds; a faster one, or "
               "a smaller Perturbation parameter, is expected",
               wave_.speed);
  }

  void
  OptimalWave::choose_by_energy(const OptimalWaveParameters &parameters)
  {
    const bool by_index = parameters.root == "index";
    roots_              = find_wave_roots(
      body_, shape_, chi_, end_time_, parameters.energy, by_index ? std::max(25u, parameters.root_index) : 25);
    const auto &list = roots_->roots;
    if (list.empty())
      refuse_entry(section + "Energy",
                   "no wave spends the energy H = {}; H from the smallest, {}, to below {} is expected",
                   parameters.energy,
                   roots_->smallest_energy,
                   roots_->largest_energy);
    if (by_index)
    {
      if (parameters.root_index > list.size())
        refuse(section + "Root index",
               "Root index is {}, but a whole number from 1 to {} is expected: that many waves spend the energy H = {}",
               parameters.root_index,
               list.size(),
               parameters.energy);
      chosen_ = parameters.root_index - 1;
    }
    else
    {
      const bool any = parameters.root == "largest displacement";
      bool found     = false;
      for (std::size_t i = 0; i < list.size(); ++i)
        if ((any || list[i].admissible()) && (!found || list[i].displacement > list[chosen_].displacement))
        {
          chosen_ = i;
          found   = true;
        }
      if (!found)
        refuse(section + "Perturbation parameter",
               "Perturbation parameter is {}, but a smaller one is expected: no wave of energy "
               "H = {} ({} in all) is admissible, the leading-order stretch becomes negative",
               parameters.perturbation_parameter,
               parameters.energy,
               list.size());
    }
    wave_ = list[chosen_];
  }

  std::unique_ptr<ActiveStressAtPoints>
  OptimalWave::evaluator(const std::vector<double> &points, bool) const
  {
    std::vector<unsigned int> numbers; // of the harmonics that are there
    std::vector<double> q;
    for (unsigned int n = 1; n <= shape_.a.size(); ++n)
      if (shape_.power(n) != 0.)
      {
        numbers.push_back(n);
        q.push_back(2. * std::numbers::pi * n / body_.length);
      }
    return waves_at_points(q, points, [this, numbers, q](const std::size_t i, const double t) {
      // Expansion of sin q(s+ct) and cos q(s+ct) in the formula of the class: constant + cosine cos qs + sine sin qs.
      const double c = wave_.speed, theta = q[i] * c * t, a = shape_.a[numbers[i] - 1], b = shape_.b[numbers[i] - 1];
      const double st = std::sin(theta), ct = std::cos(theta);
      const double half = std::sin(0.5 * theta), ct_minus_1 = -2. * half * half;
      const double friction = chi_ * body_.friction_coefficient / q[i];
      const double elastic  = chi_ * body_.elastic_modulus / c;
      const double constant = friction * (a * ct - b * st);
      const double cosine   = -constant - elastic * (a * st + b * ct_minus_1);
      const double sine     = friction * (a * st + b * ct) - elastic * (a * ct_minus_1 - b * st);
      return std::array<double, 3>{{constant, sine, cosine}};
    });
  }

  void
  OptimalWave::report(std::ostream &out) const
  {
    out << fmt::format("Optimal wave: speed c = {:.10g}, multiplier alpha = {:.10g}, leading-order displacement "
                       "{:.8g}, stretch {:.4g} to {:.4g}{}\n",
                       wave_.speed,
                       wave_.multiplier,
                       wave_.displacement,
                       wave_.min_stretch,
                       wave_.max_stretch,
                       wave_.admissible() ? "" : " (NOT admissible: the body would invert)");
    if (shape_.a.size() > 1)
      out << fmt::format("Coefficients: sine {}; cosine {}\n", fmt::join(shape_.a, ", "), fmt::join(shape_.b, ", "));
    if (!roots_)
      return;
    const auto &list = roots_->roots;
    out << fmt::format("Waves of this energy, slowest first{}{}:\n"
                       "    index         speed    multiplier  displacement  min stretch  max stretch\n",
                       roots_->double_roots ? " (double roots: this is the smallest energy)" : "",
                       roots_->complete ? "" : fmt::format("; the first {} of more", list.size()));
    // Excerpt of long lists: the slowest, those around the chosen one, and the last.
    constexpr std::size_t around = 12;
    bool gap                     = false;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      const bool shown =
        list.size() <= 60 || i < around || i + 3 > list.size() || (i + around > chosen_ && i < chosen_ + around);
      if (shown)
        out << fmt::format("  {:>7}  {:>12.6f}  {:>12.6f}  {:>12.6g}  {:>11.4g}  {:>11.4g}{}{}\n",
                           i + 1,
                           list[i].speed,
                           list[i].multiplier,
                           list[i].displacement,
                           list[i].min_stretch,
                           list[i].max_stretch,
                           list[i].admissible() ? "" : "  inadmissible",
                           i == chosen_ ? "  <- chosen" : "");
      else if (!gap)
        out << "      ...\n";
      gap = !shown;
    }
  }
} // namespace crawler
