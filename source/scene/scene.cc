// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/scene/scene.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <typeinfo>

namespace crawler
{
  namespace
  {
    /// Values of a function of s and t, in other units.
    class ScaledAtPoints : public ActiveStressAtPoints
    {
    public:
      /// @p unit is that of the values; @p pieces may be null.
      ScaledAtPoints(std::unique_ptr<ActiveStressAtPoints> stress,
                     const double time_unit,
                     const double unit,
                     const TimeSegments *pieces)
        : stress_(std::move(stress))
        , time_unit_(time_unit)
        , unit_(unit)
        , pieces_(pieces)
      {
      }

      void
      values(const double t, const std::span<double> m) override
      {
        stress_->values((pieces_ != nullptr ? pieces_->inside(t) : t) * time_unit_, m);
        for (double &value : m)
          value /= unit_;
      }

    private:
      const std::unique_ptr<ActiveStressAtPoints> stress_;
      const double time_unit_, unit_;
      const TimeSegments *pieces_;
    };

    class ScaledStrainAtPoints : public StrainAtPoints
    {
    public:
      ScaledStrainAtPoints(std::unique_ptr<StrainAtPoints> strain, const double time_unit)
        : strain_(std::move(strain))
        , time_unit_(time_unit)
      {
      }

      void
      strain(const double t, const std::span<double> e) override
      {
        strain_->strain(t * time_unit_, e);
      }
      void
      rate(const double t, const std::span<double> e_t) override
      {
        strain_->rate(t * time_unit_, e_t);
        for (double &value : e_t)
          value *= time_unit_;
      }

    private:
      const std::unique_ptr<StrainAtPoints> strain_;
      const double time_unit_;
    };

    std::vector<double>
    times(std::vector<double> values, const double factor)
    {
      for (double &value : values)
        value *= factor;
      return values;
    }

    /// A strain history in other units.
    class ScaledStrainHistory : public StrainHistory
    {
    public:
      ScaledStrainHistory(const StrainHistory &history, const Units &units)
        : history_(history)
        , units_(units)
      {
      }

      std::unique_ptr<StrainAtPoints>
      at(const std::vector<double> &points) const override
      {
        return std::make_unique<ScaledStrainAtPoints>(history_.at(times(points, units_.length)), units_.time);
      }

    private:
      const StrainHistory &history_;
      const Units units_;
    };

    class ScaledFeedbackAtPoints : public FeedbackAtPoints
    {
    public:
      ScaledFeedbackAtPoints(std::unique_ptr<FeedbackAtPoints> feedback, const Units &units, const TimeSegments *pieces)
        : feedback_(std::move(feedback))
        , units_(units)
        , pieces_(pieces)
      {
      }

      void
      values(const double t, const StretchSeen &seen, const FeedbackStress &m) override
      {
        rate_.assign(seen.rate.begin(), seen.rate.end());
        for (double &value : rate_)
          value /= units_.time;
        feedback_->values((pieces_ != nullptr ? pieces_->inside(t) : t) * units_.time,
                          {seen.stretch, rate_, seen.near, seen.delayed},
                          m);
        for (const auto &part : {m.m, m.m_w, m.m_near})
          for (double &value : part)
            value /= units_.force;
        for (double &value : m.m_rate)
          value /= units_.force * units_.time;
      }

    private:
      const std::unique_ptr<FeedbackAtPoints> feedback_;
      const Units units_;
      const TimeSegments *pieces_;
      std::vector<double> rate_;
    };

    class ScaledFeedback : public StretchFeedback
    {
    public:
      ScaledFeedback(const StretchFeedback &feedback, const Units &units, const TimeSegments *pieces)
        : feedback_(feedback)
        , units_(units)
        , pieces_(pieces)
      {
      }

      std::unique_ptr<FeedbackAtPoints>
      at(const std::vector<double> &points) const override
      {
        return std::make_unique<ScaledFeedbackAtPoints>(feedback_.at(times(points, units_.length)), units_, pieces_);
      }
      bool
      uses_rate() const override
      {
        return feedback_.uses_rate();
      }
      double
      distance() const override
      {
        return feedback_.distance() / units_.length;
      }
      double
      delay() const override
      {
        return feedback_.delay() / units_.time;
      }
      double
      sensor_length() const override
      {
        return feedback_.sensor_length() / units_.length;
      }

    private:
      const StretchFeedback &feedback_;
      const Units units_;
      const TimeSegments *pieces_;
    };

    /// An active stress in other units.
    class ScaledActiveStress : public ActiveStress
    {
    public:
      ScaledActiveStress(const ActiveStress &stress, const Units &units, const TimeSegments *pieces)
        : stress_(stress)
        , units_(units)
        , pieces_(pieces)
      {
        if (stress.prescribed_strain() != nullptr)
          strain_.emplace(*stress.prescribed_strain(), units);
        if (stress.feedback() != nullptr)
          feedback_.emplace(*stress.feedback(), units, pieces);
      }

      std::unique_ptr<ActiveStressAtPoints>
      at(const std::vector<double> &points) const override
      {
        return std::make_unique<ScaledAtPoints>(
          stress_.at(times(points, units_.length)), units_.time, units_.force, pieces_);
      }

      std::unique_ptr<ActiveStressAtPoints>
      rate_at(const std::vector<double> &points) const override
      {
        auto rate = stress_.rate_at(times(points, units_.length));
        return rate
                 ? std::make_unique<ScaledAtPoints>(std::move(rate), units_.time, units_.force / units_.time, pieces_)
                 : nullptr;
      }

      std::vector<double>
      breaks_in_space() const override
      {
        return times(stress_.breaks_in_space(), 1. / units_.length);
      }

      std::vector<double>
      breaks_in_time() const override
      {
        return times(stress_.breaks_in_time(), 1. / units_.time);
      }

      const StrainHistory *
      prescribed_strain() const override
      {
        return strain_ ? &*strain_ : nullptr;
      }

      const StressFailures *
      failures() const override
      {
        return stress_.failures();
      }

      std::optional<double>
      period() const override
      {
        const auto physical = stress_.period();
        return physical ? std::optional(*physical / units_.time) : std::nullopt;
      }

      std::optional<double>
      stride() const override
      {
        const auto physical = stress_.stride();
        return physical ? std::optional(*physical / units_.time) : std::nullopt;
      }

      void
      report(std::ostream &out) const override
      {
        stress_.report(out);
      }

      const StretchFeedback *
      feedback() const override
      {
        return feedback_ ? &*feedback_ : nullptr;
      }

    private:
      const ActiveStress &stress_;
      const Units units_;
      const TimeSegments *pieces_;
      std::optional<ScaledStrainHistory> strain_;
      std::optional<ScaledFeedback> feedback_;
    };
  } // namespace

  namespace
  {
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

    /// Looked for at some points and times; infinite if it is not a finite number at one of them. What a generator
    /// itself calls a failure is left out: the run ends there, if it comes so far.
    double
    largest_active_stress(const Scene &scene, const unsigned int n_times)
    {
      constexpr unsigned int n = 37;
      std::vector<double> points(n + 1), m(n + 1);
      for (unsigned int i = 0; i <= n; ++i)
        points[i] = scene.body.length * i / n;
      const auto stress = scene.active_stress->at(points);
      double largest    = 0.;
      for (unsigned int j = 0; j <= n_times; ++j)
      {
        const auto *failures         = scene.active_stress->failures();
        const unsigned long n_before = failures != nullptr ? failures->count : 0;
        stress->values(scene.end_time * j / n_times, m);
        failures = scene.active_stress->failures();
        if (failures != nullptr && failures->count > n_before)
          continue;
        for (const double value : m)
          largest = std::isfinite(value) ? std::max(largest, std::abs(value)) : std::numeric_limits<double>::infinity();
      }
      return largest;
    }
  } // namespace

  namespace
  {
    /// Asked for in every residual, and a comparison of types is faster than dynamic_cast.
    bool
    has_power_law(const Scene &scene)
    {
      const FrictionLaw &law = *scene.friction;
      return typeid(law) == typeid(PowerFriction);
    }
  } // namespace

  bool
  Scene::is_plain() const
  {
    return profiles.is_plain() && ground.is_plain() && active_stress->feedback() == nullptr && has_power_law(*this);
  }

  std::string
  Scene::general_features() const
  {
    std::string names;
    const auto add = [&names](const bool present, const char *name) {
      if (present)
        names += (names.empty() ? "" : ", ") + std::string(name);
    };
    add(profiles.elastic_modulus != nullptr, "Body/Elastic modulus profile");
    add(profiles.friction != nullptr, "Body/Friction profile");
    add(profiles.initial_stretch != nullptr, "Body/Initial stretch");
    add(ground.profile != nullptr, "Ground/Profile");
    add(!has_power_law(*this), "Ground/Friction law");
    add(ground.direction.ratio != 1., "Ground/Backward ratio");
    add(active_stress && active_stress->feedback() != nullptr, "an active stress with feedback");
    return names;
  }

  double
  Scene::friction_exponent() const
  {
    constexpr double small = 1e-3;
    return friction->exponent(small);
  }

  std::pair<double, double>
  Scene::end_moduli() const
  {
    const double k = body.elastic_modulus;
    if (!profiles.elastic_modulus)
      return {k, k};
    return {k * profiles.elastic_modulus->value(0.), k * profiles.elastic_modulus->value(body.length)};
  }

  std::vector<double>
  Scene::breaks_in_space() const
  {
    std::vector<double> places = active_stress->breaks_in_space();
    for (const auto &profile : {profiles.elastic_modulus, profiles.friction, profiles.initial_stretch})
      if (profile)
      {
        const auto more = profile->breaks();
        places.insert(places.end(), more.begin(), more.end());
      }
    return distinct_breaks_in_space(std::move(places), body.length);
  }

  Units
  natural_units(const Scene &scene)
  {
    // Squares of these, and of what is made of them, must not leave the range of doubles. Stiffer bodies lose the
    // digits of the energy balance, softer ones have layers that no mesh reaches.
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

  void
  require_computable_stress(const Scene &scene)
  {
    constexpr double weakest = 1e-20, strongest = 1e20;
    const Units units = natural_units(scene);
    const double unit = std::max(scene.body.elastic_modulus, units.force);
    double strain     = largest_active_stress(scene, 37) / unit; // no usual number of waves
    if (strain < weakest)                                        // it may be a short event
      strain = largest_active_stress(scene, 8191) / unit;
    if (strain != 0. && !(strain >= weakest && strain <= strongest))
      throw InputError(fmt::format(
        "the largest active stress that sampling finds, relative to the larger of k and gamma L^2/T, is {:.3g}, "
        "but 0 or a number from {:g} to {:g} is expected",
        strain,
        weakest,
        strongest));
  }

  Scene
  in_units(const Scene &scene, const Units &units, const TimeSegments *pieces)
  {
    Scene scaled;
    const double friction            = units.force * units.time / units.length / units.length;
    scaled.body                      = scene.body;
    scaled.body.length               = scene.body.length / units.length;
    scaled.body.elastic_modulus      = scene.body.elastic_modulus / units.force;
    scaled.body.friction_coefficient = scene.body.friction_coefficient / friction;
    scaled.friction                  = scene.friction->scaled(1. / friction);
    scaled.active_stress             = std::make_unique<ScaledActiveStress>(*scene.active_stress, units, pieces);
    scaled.end_time                  = scene.end_time / units.time;
    for (const auto member : {&BodyProfiles::elastic_modulus, &BodyProfiles::friction, &BodyProfiles::initial_stretch})
      scaled.profiles.*member = in_units(scene.profiles.*member, units.length);
    scaled.ground.profile                      = in_units(scene.ground.profile, units.length);
    scaled.ground.direction                    = scene.ground.direction;
    scaled.ground.direction.switching_velocity = scene.ground.direction.switching_velocity / units.velocity();
    return scaled;
  }
} // namespace crawler
