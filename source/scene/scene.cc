// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/scene/known_stress.h>
#include <crawler/scene/scene.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace crawler
{
  namespace
  {
    std::vector<double>
    times(std::vector<double> values, const double factor)
    {
      for (double &value : values)
        value *= factor;
      return values;
    }

    /// An active stress in other units. @p pieces may be null.
    class ScaledActiveStress : public KnownStress
    {
    public:
      ScaledActiveStress(const ActiveStress &stress, const Units &units, const TimeSegments *pieces)
        : stress_(stress)
        , units_(units)
        , pieces_(pieces)
      {
        if (stress.prescribed_strain() != nullptr)
          facts_.prescribed_strain =
            in_units(*stress.prescribed_strain(), Units{units.length, units.time, /*force=*/1.});
        if (const StretchFeedback *feedback = stress.feedback())
          facts_.feedback = StretchFeedback{{feedback->facts.uses_rate,
                                             feedback->facts.distance / units.length,
                                             feedback->facts.delay / units.time,
                                             feedback->facts.sensor_length / units.length},
                                            [this](const std::vector<double> &points) { return feedback_at(points); }};
        facts_.search = [&stress, T = units.time]() {
          auto found = stress.repetition();
          if (found)
            found = {found->period / T, found->from / T};
          return found;
        };
        facts_.breaks_in_space = times(stress.breaks_in_space(), 1. / units.length);
        facts_.breaks_in_time  = times(stress.breaks_in_time(), 1. / units.time);
      }

      const StressFailures *
      failures() const override
      {
        return stress_.failures();
      }
      void
      report(std::ostream &out) const override
      {
        stress_.report(out);
      }
      std::optional<Bounds>
      bounds(const Box &box) const override
      {
        auto bounds = stress_.bounds(
          {box.s_from * units_.length, box.s_to * units_.length, box.t_from * units_.time, box.t_to * units_.time});
        if (bounds)
          *bounds = {bounds->value / std::abs(units_.force), bounds->rate * units_.time / std::abs(units_.force)};
        return bounds;
      }

    private:
      std::unique_ptr<ActiveStressAtPoints>
      evaluator(const std::vector<double> &points, const bool rate) const override
      {
        const auto places = times(points, units_.length);
        auto physical     = rate ? stress_.rate_at(places) : stress_.at(places);
        if (!physical)
          return nullptr;
        const double unit = rate ? units_.force / units_.time : units_.force;
        return stress_at_points([this, at = std::move(physical), unit](const double t, const std::span<double> m) {
          at->values(physical_time(t), m);
          for (double &value : m)
            value /= unit;
        });
      }

      std::unique_ptr<FeedbackAtPoints>
      feedback_at(const std::vector<double> &points) const
      {
        return feedback_at_points(
          [this, at = stress_.feedback()->at(times(points, units_.length)), rates = std::vector<double>()](
            const double t, const StretchSeen &seen, const FeedbackStress &m) mutable {
            rates.assign(seen.rate.begin(), seen.rate.end());
            for (double &value : rates)
              value /= units_.time;
            at->values(physical_time(t), {seen.stretch, rates, seen.near, seen.delayed}, m);
            for (const auto &part : {m.m, m.m_w, m.m_near})
              for (double &value : part)
                value /= units_.force;
            for (double &value : m.m_rate)
              value /= units_.force * units_.time;
          });
      }

      double
      physical_time(const double t) const
      {
        return (pieces_ != nullptr ? pieces_->inside(t) : t) * units_.time;
      }

      const ActiveStress &stress_;
      const Units units_;
      const TimeSegments *pieces_;
    };

    void
    require(const char *name, const double value, const double least, const double most)
    {
      if (!(value >= least && value <= most))
        throw InputError(fmt::format("{} is {:.3g}, but a number from {:g} to {:g} is expected; check the units of the "
                                     "body and of the end time",
                                     name,
                                     value,
                                     least,
                                     most));
    }

    /// Largest |m| at some points and times; infinite if a value is not finite. Failures of the generator are skipped:
    /// the run ends there, if it gets so far.
    double
    largest_active_stress(const Scene &scene, const unsigned int n_times)
    {
      constexpr unsigned int n = 37;
      std::vector<double> m(n + 1);
      const auto stress = scene.active_stress->at(equal_parts(0., scene.body.length, n));
      double largest    = 0.;
      for (const double t : equal_parts(0., scene.end_time, n_times))
      {
        const auto *failures         = scene.active_stress->failures();
        const unsigned long n_before = failures != nullptr ? failures->count : 0;
        stress->values(t, m);
        failures = scene.active_stress->failures();
        if (failures != nullptr && failures->count > n_before)
          continue;
        for (const double value : m)
          largest = std::isfinite(value) ? std::max(largest, std::abs(value)) : std::numeric_limits<double>::infinity();
      }
      return largest;
    }

    /// Names of the features that are present.
    std::string
    listed(const std::vector<std::pair<bool, std::string>> &features)
    {
      std::string names;
      for (const auto &[is_there, name] : features)
        if (is_there && !name.empty())
          names += (names.empty() ? "" : ", ") + name;
      return names;
    }
  } // namespace

  std::string
  Scene::general_features() const
  {
    return listed({{profiles.elastic_modulus != nullptr, "Body/Elastic modulus profile"},
                   {profiles.friction != nullptr, "Body/Friction profile"},
                   {!friction->is_power_law, "Ground/Friction law"},
                   {true, features_beyond_strain()}});
  }

  std::string
  Scene::features_beyond_strain() const
  {
    return listed({{profiles.initial_stretch != nullptr, "Body/Initial stretch"},
                   {ground.profile != nullptr, "Ground/Profile"},
                   {ground.direction.is_uneven(), "Ground/Backward ratio"},
                   {active_stress && active_stress->feedback() != nullptr, "an active stress with feedback"}});
  }

  std::vector<double>
  Scene::breaks_in_space() const
  {
    std::vector<double> places = active_stress ? active_stress->breaks_in_space() : std::vector<double>();
    for (const auto &profile : {profiles.elastic_modulus, profiles.friction, profiles.initial_stretch})
      if (profile)
      {
        const auto more = profile->breaks();
        places.insert(places.end(), more.begin(), more.end());
      }
    if (active_stress && feels_elsewhere())
      places = with_echoes(std::move(places), active_stress->feedback()->facts, body.length);
    return distinct_breaks_in_space(std::move(places), body.length);
  }

  std::optional<Scene>
  with_fronts(const Scene &scene, const double part)
  {
    const auto *const known = dynamic_cast<const KnownStress *>(scene.active_stress.get());
    Scene smooth            = scene;
    smooth.active_stress    = known != nullptr ? known->with_fronts(part) : nullptr;
    return smooth.active_stress ? std::optional(std::move(smooth)) : std::nullopt;
  }

  Units
  natural_units(const Scene &scene)
  {
    // Limits that keep squares of the units, and of numbers made from them, in the range of doubles. Stiffer bodies
    // lose the digits of the energy balance, softer ones have layers that no mesh resolves.
    constexpr double smallest = 1e-100, largest = 1e100;
    constexpr double softest = 1e-12, stiffest = 1e11;

    const Body &body = scene.body;
    const Units units{
      body.length, scene.end_time, body.friction_coefficient * body.length / scene.end_time * body.length};
    require("Body/Length", units.length, smallest, largest);
    require("Time/End time", units.time, smallest, largest);
    require("the force gamma L^2/T", units.force, smallest, largest);
    require("the stiffness k T/(gamma L^2)", body.elastic_modulus / units.force, softest, stiffest);
    return units;
  }

  double
  stiffness(const Scene &scene)
  {
    return scene.body.elastic_modulus / natural_units(scene).force;
  }

  void
  require_computable_stress(const Scene &scene)
  {
    constexpr double weakest = 1e-20, strongest = 1e20;
    const Units units = natural_units(scene);
    const double unit = std::max(scene.body.elastic_modulus, units.force);
    double strain     = largest_active_stress(scene, 37) / unit; // an unusual number of waves
    if (strain < weakest)                                        // may be a short event
      strain = largest_active_stress(scene, 8191) / unit;
    // Shorter events may have arbitrarily small values beside them; they are searched for later.
    if (strain < weakest)
      if (const auto bounds = scene.active_stress->bounds({0., scene.body.length, 0., scene.end_time});
          bounds && bounds->value > weakest * unit)
        return;
    if (strain != 0. && !(strain >= weakest && strain <= strongest))
      throw InputError(fmt::format(
        "the largest active stress that sampling finds, relative to the larger of k and gamma L^2/T, is {:.3g}, "
        "but 0 or a number from {:g} to {:g} is expected",
        strain,
        weakest,
        strongest));
  }

  std::unique_ptr<const ActiveStress>
  in_units(const ActiveStress &stress, const Units &units, const TimeSegments *pieces)
  {
    return std::make_unique<ScaledActiveStress>(stress, units, pieces);
  }

  Scene
  in_units(const Scene &scene, const Units &units, const TimeSegments *pieces)
  {
    Scene scaled          = scene;
    const double friction = units.force * units.time / units.length / units.length;
    scaled.body.length /= units.length;
    scaled.body.elastic_modulus /= units.force;
    scaled.body.friction_coefficient /= friction;
    scaled.friction      = scene.friction->scaled(1. / friction);
    scaled.active_stress = in_units(*scene.active_stress, units, pieces);
    scaled.end_time /= units.time;
    for (auto *const profile : {&scaled.profiles.elastic_modulus,
                                &scaled.profiles.friction,
                                &scaled.profiles.initial_stretch,
                                &scaled.ground.profile})
      *profile = in_units(*profile, units.length);
    scaled.ground.direction.switching_velocity /= units.velocity();
    return scaled;
  }
} // namespace crawler
