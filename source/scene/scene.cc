// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/scene/scene.h>

#include <fmt/format.h>

#include <cmath>

namespace crawler
{
  namespace
  {
    class ScaledAtPoints : public ActiveStressAtPoints
    {
    public:
      ScaledAtPoints(std::unique_ptr<ActiveStressAtPoints> stress, const Units &units)
        : stress_(std::move(stress))
        , units_(units)
      {
      }

      void
      values(const double t, const std::span<double> m) override
      {
        stress_->values(t * units_.time, m);
        for (double &value : m)
          value /= units_.force;
      }

    private:
      const std::unique_ptr<ActiveStressAtPoints> stress_;
      const Units units_;
    };

    /// An active stress in other units.
    class ScaledActiveStress : public ActiveStress
    {
    public:
      ScaledActiveStress(const ActiveStress &stress, const Units &units)
        : stress_(stress)
        , units_(units)
      {
      }

      std::unique_ptr<ActiveStressAtPoints>
      at(const std::vector<double> &points) const override
      {
        std::vector<double> physical(points);
        for (double &s : physical)
          s *= units_.length;
        return std::make_unique<ScaledAtPoints>(stress_.at(physical), units_);
      }

      void
      report(std::ostream &out) const override
      {
        stress_.report(out);
      }

    private:
      const ActiveStress &stress_;
      const Units units_;
    };
  } // namespace

  Units
  natural_units(const Scene &scene)
  {
    // Squares of these, and of what is made of them, must not leave the range of doubles.
    constexpr double smallest = 1e-100, largest = 1e100;
    constexpr double softest = 1e-20, stiffest = 1e20;

    const Body &body = scene.body;
    const Units units{
      body.length, scene.end_time, body.friction_coefficient * body.length / scene.end_time * body.length};
    const auto require = [](const char *name, const double value, const double least, const double most)
    {
      if (!(value >= least && value <= most))
        throw InputError(fmt::format("{} is {:.3g}, but a number from {:g} to {:g} is expected; check the units of the "
                                     "body and of the end time",
                                     name,
                                     value,
                                     least,
                                     most));
    };
    require("Body/Length", units.length, smallest, largest);
    require("Time/End time", units.time, smallest, largest);
    require("the force gamma L^2/T", units.force, smallest, largest);
    require("the stiffness k T/(gamma L^2)", body.elastic_modulus / units.force, softest, stiffest);
    return units;
  }

  Scene
  in_units(const Scene &scene, const Units &units)
  {
    Scene scaled;
    const double friction            = units.force * units.time / units.length / units.length;
    scaled.body                      = scene.body;
    scaled.body.length               = scene.body.length / units.length;
    scaled.body.elastic_modulus      = scene.body.elastic_modulus / units.force;
    scaled.body.friction_coefficient = scene.body.friction_coefficient / friction;
    scaled.friction                  = scene.friction->scaled(1. / friction);
    scaled.active_stress             = std::make_unique<ScaledActiveStress>(*scene.active_stress, units);
    scaled.end_time                  = scene.end_time / units.time;
    return scaled;
  }
} // namespace crawler
