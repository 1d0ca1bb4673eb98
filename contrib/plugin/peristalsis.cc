// SPDX-License-Identifier: LGPL-2.1-or-later
//
// An active stress as a plug-in: waves of contraction that run from s = L to s = 0 and set in within a start-up time.
//
//   m(s,t) = height (1 - cos(2 pi (waves s/L + frequency t)))/2 (1 - exp(-t/start))
#include <crawler/scene/stress_plugin.h>

#include <numbers>
#include <ostream>

namespace
{
  struct Settings
  {
    double length;    ///< L [length]
    double height;    ///< largest m [force]
    double waves;     ///< number of waves per body length [1]
    double frequency; ///< [1/time]
    double start;     ///< start-up time [time]
  };

  enum class Quantity
  {
    stress, ///< m [force]
    rate    ///< m_t [force/time]
  };

  /// What depends on place only is computed once; values() runs for every stage of every time step.
  class AtPoints : public crawler::ActiveStressAtPoints
  {
  public:
    AtPoints(const Settings &settings, const Quantity quantity, const std::vector<double> &points)
      : settings_(settings)
      , quantity_(quantity)
    {
      for (const double s : points)
        phases_.push_back(2. * std::numbers::pi * settings.waves * s / settings.length);
    }

    void
    values(const double t, const std::span<double> m) override
    {
      const double omega = 2. * std::numbers::pi * settings_.frequency, decay = std::exp(-t / settings_.start);
      for (std::size_t i = 0; i < m.size(); ++i)
      {
        const double phase = phases_[i] + omega * t;
        if (quantity_ == Quantity::stress)
          m[i] = 0.5 * settings_.height * (1. - std::cos(phase)) * (1. - decay);
        else
          m[i] = 0.5 * settings_.height *
                 (omega * std::sin(phase) * (1. - decay) + (1. - std::cos(phase)) * decay / settings_.start);
      }
    }

  private:
    const Settings settings_;
    const Quantity quantity_;
    std::vector<double> phases_;
  };

  class Peristalsis : public crawler::ActiveStress
  {
  public:
    explicit Peristalsis(const Settings &settings)
      : settings_(settings)
    {
    }

    std::unique_ptr<crawler::ActiveStressAtPoints>
    at(const std::vector<double> &points) const override
    {
      return std::make_unique<AtPoints>(settings_, Quantity::stress, points);
    }

    /// Not needed for a run; some estimates of errors use it, and a strain must have it.
    std::unique_ptr<crawler::ActiveStressAtPoints>
    rate_at(const std::vector<double> &points) const override
    {
      return std::make_unique<AtPoints>(settings_, Quantity::rate, points);
    }

    void
    report(std::ostream &out) const override
    {
      out << "Contraction up to m = " << settings_.height << ", " << settings_.waves << " waves, frequency "
          << settings_.frequency << ", start-up time " << settings_.start << '\n';
    }

  private:
    const Settings settings_;
  };

  std::unique_ptr<crawler::ActiveStress>
  create(const crawler::PluginInput &input)
  {
    const auto &p = input.parameters;
    const Settings settings{input.length,
                            p.number("height", 0.3 * input.elastic_modulus),
                            p.number("waves", 1.),
                            p.number("frequency", 1.),
                            p.number("start", 0.1 * input.end_time)};
    if (!(settings.start > 0.))
      throw std::invalid_argument("start is " + std::to_string(settings.start) + ", but a positive time is expected");
    return std::make_unique<Peristalsis>(settings);
  }
} // namespace

CRAWLER_ACTIVE_STRESS_PLUGIN("peristalsis", create)
