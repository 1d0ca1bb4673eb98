// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A plug-in that goes wrong in the way, at the place and from the time on that its parameters say (plugin.py).
#include <crawler/scene/stress_plugin.h>

#include <limits>
#include <numbers>

namespace
{
  struct Fault
  {
    std::string kind;
    double s, t;
  };

  class AtPoints : public crawler::ActiveStressAtPoints
  {
  public:
    AtPoints(Fault fault, const std::vector<double> &points)
      : fault_(std::move(fault))
      , points_(points)
    {
    }

    void
    values(const double t, const std::span<double> m) override
    {
      for (std::size_t i = 0; i < m.size(); ++i)
      {
        m[i] = 0.1 * std::sin(2. * std::numbers::pi * (points_[i] + t));
        if (t < fault_.t || points_[i] < fault_.s)
          continue;
        if (fault_.kind == "throw")
          throw std::runtime_error("the valve is shut");
        if (fault_.kind == "throw number")
          throw 42;
        if (fault_.kind == "nan")
          m[i] = std::numeric_limits<double>::quiet_NaN();
        if (fault_.kind == "nan at place" && points_[i] == fault_.s)
          m[i] = std::numeric_limits<double>::quiet_NaN();
      }
    }

  private:
    const Fault fault_;
    const std::vector<double> points_;
  };

  class Faulty : public crawler::ActiveStress
  {
  public:
    explicit Faulty(Fault fault)
      : fault_(std::move(fault))
    {
    }

    std::unique_ptr<crawler::ActiveStressAtPoints>
    at(const std::vector<double> &points) const override
    {
      if (fault_.kind == "no evaluator")
        return nullptr;
      return std::make_unique<AtPoints>(fault_, points);
    }

    std::optional<double>
    period() const override
    {
      return fault_.kind == "period" ? std::optional(-1.) : std::nullopt;
    }

    std::vector<double>
    breaks_in_space() const override
    {
      if (fault_.kind == "breaks")
        throw std::runtime_error("no breaks here");
      return {};
    }

    std::vector<double>
    breaks_in_time() const override
    {
      return fault_.kind == "break in time" ? std::vector<double>{fault_.t} : std::vector<double>();
    }

    const crawler::StretchFeedback *
    feedback() const override
    {
      return feedback_.facts.sees_near() || feedback_.facts.delay != 0. ? &feedback_ : nullptr;
    }

  private:
    const Fault fault_;
    const crawler::StretchFeedback feedback_ = {{.distance      = fault_.kind == "distance" ? fault_.s : 0.,
                                                 .delay         = fault_.kind == "delay" ? fault_.s : 0.,
                                                 .sensor_length = fault_.kind == "sensor length" ? fault_.s : 0.},
                                                {}};
  };

  std::unique_ptr<crawler::ActiveStress>
  create(const crawler::PluginInput &input)
  {
    const Fault fault{
      input.parameters.text("kind", ""), input.parameters.number("s", 0.), input.parameters.number("t", 0.)};
    if (fault.kind == "factory")
      throw std::runtime_error("this body\nis too short");
    return fault.kind == "nothing" ? nullptr : std::make_unique<Faulty>(fault);
  }
} // namespace

CRAWLER_ACTIVE_STRESS_PLUGIN("faulty", create)
