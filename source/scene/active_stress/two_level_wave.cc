// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/two_level_wave.h>
#include <crawler/scene/active_stress/waves.h>
#include <crawler/scene/scene.h>

#include <fmt/format.h>

#include <cmath>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string two_level_wave_section = "Active stress/Two-level wave/";

    /// Frequency of the wave that does the work W = gamma c^2 L T X [1/time].
    double
    frequency_by_work(const TwoLevelWaveParameters &p, const Scene &scene, const double X)
    {
      const auto refuse = [](const std::string &found_and_expected, const std::string &what) {
        crawler::refuse(two_level_wave_section + "Given by",
                        "{} is expected where the work is given, since the work of {} depends on the phase",
                        found_and_expected,
                        what);
      };
      if (!scene.profiles.is_plain())
        refuse("the body is not uniform, but no profile", "non-uniform bodies");
      if (p.wave_number != std::round(p.wave_number))
        refuse(fmt::format("the wave number is {:g}, but a whole one", p.wave_number), "other waves");
      if (p.ramp_duration > 0.)
        refuse("there is a ramp, but Ramp duration = 0", "the ramp");
      const double L = scene.body.length,
                   c = std::sqrt(p.work / (scene.body.friction_coefficient * L * scene.end_time * X));
      return p.wave_number * c / L;
    }

    /// Numbers of a wave of speed c: D = c T (<e> - <g e>/<g>) and W = gamma c^2 L T X, X = <g e^2> - <g e>^2/<g>, with
    /// the means over a period; a constant added to the factor e changes neither. Here g is that of gamma = 1.
    TwoLevelWave::Numbers
    numbers_of(const TwoLevelWaveParameters &p, const Scene &scene)
    {
      const Body &body = scene.body;
      const double low = p.smallest_strain, high = p.largest_strain;
      if (const auto stretch = stretch_without_friction(*scene.friction, 1. + low, 1. + high))
        refuse(two_level_wave_section + "Largest strain",
               "the friction law has no positive value at the stretch {:.6g}, which is between "
               "the two strains; smaller strains, or another law, are expected",
               *stretch);
      const auto friction = [&](const double w) { return scene.friction->value(w) / body.friction_coefficient; };
      if (!(low < high))
        refuse(two_level_wave_section + "Largest strain",
               "the largest strain is {:g}, but one above the smallest, {:g}, is expected",
               high,
               low);
      const double share = p.share.value_or(1. / (1. + std::sqrt(friction(1. + high) / friction(1. + low))));
      double mean = 0., g_sum = 0., ge = 0., gee = 0.;
      const auto add = [&](const double weight, const double level) { // levels from -1/2, emin, to 1/2, emax
        const double e = (high - low) * level, g = weight * friction(1. + 0.5 * (low + high) + e);
        mean += weight * e;
        g_sum += g;
        ge += g * e;
        gee += g * e * e;
      };
      add(share - p.front_width, 0.5);
      add(1. - share - p.front_width, -0.5);
      constexpr unsigned int n = 1024; // all derivatives vanish at both ends of a front
      for (unsigned int i = 0; i < n; ++i)
        add(2. * p.front_width / n, smooth_step((i + 0.5) / n) - 0.5);
      const double X = gee - ge * ge / g_sum;
      return {share,
              p.given_by == "frequency"    ? p.frequency
              : p.given_by == "wave speed" ? p.wave_number * p.wave_speed / body.length
                                           : frequency_by_work(p, scene, X),
              std::abs(mean - ge / g_sum) / std::sqrt(X),
              largest_merit(*scene.friction, 1. + low, 1. + high) * std::sqrt(body.friction_coefficient)};
    }

    std::unique_ptr<const ActiveStress>
    strain_of(const TwoLevelWaveParameters &p, const Scene &scene)
    {
      const auto numbers = numbers_of(p, scene);
      TravellingWaveParameters wave;
      wave.amplitude              = 0.5 * (p.largest_strain - p.smallest_strain);
      wave.offset                 = 0.5 * (p.largest_strain + p.smallest_strain);
      wave.wave_number            = p.wave_number;
      wave.direction              = p.direction;
      wave.frequency              = numbers.frequency;
      wave.phase                  = p.phase;
      wave.profile                = {"smoothed square", numbers.share, p.front_width};
      wave.envelope.ramp_duration = p.ramp_duration;
      return std::make_unique<TravellingWave>(wave, scene.body.length, scene.end_time);
    }
  } // namespace

  void
  TwoLevelWaveParameters::add_parameters(Declarations &declarations)
  {
    const Range strains{.lower = -1., .upper = 1e6, .upper_included = true};
    declarations.number("Smallest strain", smallest_strain, strains, "1")
      .means("Smallest strain emin, on the rest of each period.");
    declarations.number("Largest strain", largest_strain, strains, "1")
      .means("Largest strain emax, on a share of each period; above the smallest strain.");
    declarations.number("Share", share, {.lower = 0., .upper = 1.}, "1")
      .means("Share of each period at the largest strain; automatic: the one for which the wave goes farthest, 1/(1 + "
             "((1+emax)/(1+emin))^(a/2)) with a = 1 - p.");
    declarations.number("Front width", front_width, {.lower = 0., .upper = 0.5, .upper_included = true}, "1")
      .means("Width of each front between the two strains, a smooth step, as a share of the period.");
    declarations.number("Wave number", wave_number, {.lower = 0., .upper = 1000., .upper_included = true}, "1")
      .means("Number n of waves on the body; only whole ones reach the bound.");
    declare_direction(direction, declarations);
    declarations.choice("Given by", given_by, {"frequency", "wave speed", "work"})
      .means("What determines the speed of the wave; frequency = wave number * wave speed/L.");
    declarations.number("Frequency", frequency, not_negative(), "1/time")
      .means("Frequency f; with 0 the wave stands still. Used if given by frequency.");
    declarations.number("Wave speed", wave_speed, not_negative(), "length/time")
      .means("Speed of the wave along the body. Used if given by wave speed.");
    declarations.number("Work", work, positive(), "force length")
      .means("Work that the wave does until the end time. Used if given by work; then the wave number must be whole "
             "and there is no ramp.");
    declarations.number("Phase", phase, any_number(), "1").means("Phase of the wave at s = 0, t = 0, in radians.");
    declarations.number("Ramp duration", ramp_duration, not_negative(), "time")
      .means("Time in which the strain grows by a smooth step from 0 at t = 0 to its full size; the nonlinear model "
             "starts from rest and needs it.");
  }

  TwoLevelWave::TwoLevelWave(const TwoLevelWaveParameters &parameters, const Scene &scene)
  try : PrescribedStrain({.given_by = "two-level wave"}, scene, strain_of(parameters, scene)), parameters_(parameters),
    numbers_(numbers_of(parameters, scene))
  {
  }
  catch (const InputError &error) // names entries of the travelling wave
  {
    const std::string speed = parameters.given_by == "frequency"    ? "Frequency"
                              : parameters.given_by == "wave speed" ? "Wave speed"
                                                                    : "Work";
    throw InputError(error.what(),
                     error.entry.starts_with(two_level_wave_section) ? error.entry
                     : error.entry.ends_with("/Frequency")           ? two_level_wave_section + speed
                                                                     : two_level_wave_section + "Front width");
  }

  void
  TwoLevelWave::report(std::ostream &out) const
  {
    const auto &[share, frequency, merit, bound] = numbers_;
    out << fmt::format("Two-level wave: strain {:g} on the share {:.6g} of each period and {:g} on the rest, frequency "
                       "{:.8g}, speed {:.8g}\n",
                       parameters_.largest_strain,
                       share,
                       parameters_.smallest_strain,
                       frequency,
                       frequency * scene_.body.length / parameters_.wave_number);
    if (scene_.profiles.is_plain())
      out << fmt::format("Displacement/sqrt(work * duration/(friction coefficient * length)) is {:.6g} for whole waves "
                         "at full strain; no gait with these strains exceeds {:.6g}\n",
                         merit,
                         bound);
    PrescribedStrain::report(out);
  }
} // namespace crawler
