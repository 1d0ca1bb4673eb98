// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/known_stress.h>
#include <crawler/scene/strain_extremes.h>
#include <crawler/studies/optimize/scene_family.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace crawler
{
  namespace
  {
    const std::string list_of_variables = "Optimize/Variables";

    /// Throws InputError if no limit bounds the displacement.
    void
    require_limit(const OptimizeParameters &p, const std::vector<Variable> &variables)
    {
      const auto holds = [&](const LimitEntry &limit) {
        return p.*limit.value && limit.value != &OptimizeParameters::largest_stress_rate;
      };
      if (p.objective == "cost of transport" || std::ranges::any_of(limit_entries, holds))
        return;
      for (const Variable &variable : variables) // ranges are not meant as limits
        if (variable.path.starts_with("Active stress/Modes/Coefficients"))
          throw InputError(
            "there is no limit on strain, stress or work: the " + p.objective +
              " has no maximum (doc/theory.md, \"Gait efficiency\"); at least one of Work, Positive work, Dissipation, "
              "Largest strain and Smallest strain, Mean-square strain, Largest stress is expected",
            list_of_variables);
    }

    std::vector<Variable>
    variables_of_gait(Form &form)
    {
      const OptimizeParameters &p     = form.parameters.optimize;
      std::vector<Variable> variables = read_variables(form, list_of_variables);
      if (p.smallest_strain && p.largest_strain && *p.smallest_strain == 0. && *p.largest_strain == 0.)
        refuse_entry(list_of_variables,
                     "no strain is allowed, so no gait moves the body; a range of strain is expected");
      require_limit(p, variables);
      return variables;
    }

    /// Active stress, or its rate; where this is unknown, differences of the stress.
    StressByFunctions
    stress_of(const Scene &scene, const bool rate)
    {
      const ActiveStress &stress = *scene.active_stress;
      const double T = scene.end_time, beside = 1e-5 * T;
      return StressByFunctions([=, &stress](const std::vector<double> &points, bool) {
        if (auto own = rate ? stress.rate_at(points) : stress.at(points))
          return own;
        return stress_at_points([=, at = stress.at(points), before = std::vector<double>(points.size())](
                                  const double t, const std::span<double> m) mutable {
          const double from = std::max(t - beside, 0.), to = std::min(t + beside, T);
          at->values(from, before);
          at->values(to, m);
          for (std::size_t i = 0; i < before.size(); ++i)
            m[i] = (m[i] - before[i]) / (to - from);
        });
      });
    }

    std::vector<double>
    stress_samples(const Parameters &parameters, const bool rate)
    {
      constexpr unsigned int n_s = 33, n_t = 129;
      const Scene scene = parameters.create_scene();
      std::vector<double> m(1ul * n_s * n_t);
      const auto at = stress_of(scene, rate).at(equal_parts(0., scene.body.length, n_s - 1));
      for (unsigned int j = 0; const double t : equal_parts(0., scene.end_time, n_t - 1))
        at->values(t, std::span(m).subspan(1ul * j++ * n_s, n_s));
      return m;
    }

    GaitWishes
    wishes_of(const OptimizeParameters &p)
    {
      GaitWishes wishes;
      const GaitObjective objective             = objective_of(p);
      wishes.numbers[objective.motion]          = true;
      wishes.numbers[objective.energy]          = objective.power_of_energy != 0.;
      wishes.numbers[GaitNumber::friction_time] = objective.power_of_time != 0.;
      for (const LimitEntry &limit : limit_entries)
        if (limit.number && p.*limit.value)
          wishes.numbers[*limit.number] = true;
      wishes.strain      = p.smallest_strain || p.largest_strain;
      wishes.stress      = p.largest_stress.has_value();
      wishes.stress_rate = p.largest_stress_rate.has_value();
      return wishes;
    }
  } // namespace

  GaitObjective
  objective_of(const OptimizeParameters &parameters)
  {
    GaitObjective objective = *std::ranges::find(gait_objectives, parameters.objective, &GaitObjective::name);
    objective.sign          = parameters.direction == "forward" ? 1. : -1.;
    return objective;
  }

  SceneFamily::SceneFamily(Form &its_form)
    : form(its_form)
    , variables(variables_of_gait(its_form))
  {
  }

  SceneFamily::~SceneFamily()
  {
    for (const Variable &variable : variables)
      form.declarations.set(variable.path, to_text(variable.start));
  }

  Parameters
  SceneFamily::parameters(const std::vector<double> &x)
  {
    for (std::size_t i = 0; i < x.size(); ++i)
      form.declarations.set(variables[i].path, to_text(x[i]));
    return form.parameters;
  }

  std::vector<double>
  SceneFamily::start(const unsigned long number) const
  {
    const OptimizeParameters &own = form.parameters.optimize;
    std::mt19937_64 random(own.seed * 1000003ul + number);
    std::vector<double> x;
    for (const Variable &variable : variables)
    {
      const double part  = static_cast<double>(random() >> 11) * 0x1p-52 - 1.; // from -1 to 1, the same on all machines
      const double shift = number == 0 ? 0. : own.spread * part * (variable.to - variable.from);
      x.push_back(std::clamp(variable.start + shift, variable.from, variable.to));
    }
    return x;
  }

  double
  SceneFamily::scale(const std::vector<double> &x, const std::size_t i) const
  {
    constexpr double least = 0.01, of_unknown = 0.1;
    const Variable &variable = variables[i];
    const double range = variable.to - variable.from, size = std::max(std::abs(x[i]), std::abs(variable.start));
    return size > 0. ? std::clamp(size, least * range, range) : of_unknown * range;
  }

  std::vector<SceneFamily::StencilPoint>
  SceneFamily::stencil(const std::vector<double> &x, const std::size_t i, const double relative_step) const
  {
    const Variable &variable = variables[i];
    const double step        = relative_step * scale(x, i);
    // Offsets in steps, and weights in 1/(12 steps).
    using Weights                  = std::vector<std::pair<double, double>>;
    static const Weights central   = {{-2., 1.}, {-1., -8.}, {1., 8.}, {2., -1.}},
                         one_sided = {{0., -25.}, {1., 48.}, {2., -36.}, {3., 16.}, {4., -3.}};
    const bool is_central          = x[i] - 2. * step >= variable.from && x[i] + 2. * step <= variable.to;
    const double d                 = x[i] + 2. * step > variable.to ? -step : step; // inwards
    std::vector<StencilPoint> points;
    for (const auto &[place, weight] : is_central ? central : one_sided)
    {
      points.push_back({place * d, weight / (12. * d), x});
      points.back().x[i] += points.back().offset;
    }
    return points;
  }

  std::vector<std::vector<double>>
  SceneFamily::differences(const std::vector<double> &x,
                           const std::function<std::vector<double>(const Parameters &)> &values,
                           const double relative_step)
  {
    std::vector<std::vector<double>> result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      for (const StencilPoint &point : stencil(x, i, relative_step))
      {
        const std::vector<double> there = values(parameters(point.x));
        result[i].resize(there.size());
        for (std::size_t p = 0; p < there.size(); ++p)
          result[i][p] += point.weight * there[p];
      }
    return result;
  }

  LimitedValues
  SceneFamily::stress(const std::vector<double> &x, const bool rate, const bool with_gradients)
  {
    constexpr double step = 1e-4;
    const auto samples    = [rate](const Parameters &there) { return stress_samples(there, rate); };
    return {samples(parameters(x)),
            with_gradients ? differences(x, samples, step) : std::vector<std::vector<double>>()};
  }

  double
  SceneFamily::largest_stress(const std::vector<double> &x, const bool rate)
  {
    constexpr unsigned int n_s = 65, n_t = 257;
    const Scene scene             = parameters(x).create_scene();
    const StrainExtremes extremes = find_extremes(stress_of(scene, rate), scene.body.length, scene.end_time, n_s, n_t);
    return std::max(-extremes.smallest.strain, extremes.largest.strain);
  }

  GaitModel::GaitModel(SceneFamily &its_family)
    : family(its_family)
    , wishes(wishes_of(family.form.parameters.optimize))
  {
  }

  GaitValues
  GaitModel::evaluate(const std::vector<double> &x, const bool with_gradients, const std::vector<std::size_t> &places)
  {
    GaitValues values;
    try
    {
      if (with_gradients)
        values.gradients.fill(std::vector<double>(x.size()));
      compute(x, with_gradients, places, values);
      if (wishes.stress)
        values.stress = family.stress(x, /*rate=*/false, with_gradients);
      if (wishes.stress_rate)
        values.stress_rate = family.stress(x, /*rate=*/true, with_gradients);
    }
    catch (const InputError &error)
    {
      values.problem = error.what();
    }
    return values;
  }
} // namespace crawler
