// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/optimize/scene_family.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    std::vector<double>
    stress_samples(const Parameters &parameters, const bool rate)
    {
      constexpr unsigned int n_s = 33, n_t = 129;
      const Scene scene          = parameters.create_scene();
      const ActiveStress &stress = *scene.active_stress;
      std::vector<double> points, m, before(n_s), after(n_s), now(n_s);
      for (unsigned int i = 0; i < n_s; ++i)
        points.push_back(scene.body.length * i / (n_s - 1));
      const auto at    = stress.at(points);
      const auto rates = rate ? stress.rate_at(points) : nullptr;
      const double T = scene.end_time, beside = 1e-5 * T;
      for (unsigned int j = 0; j < n_t; ++j)
      {
        const double t = T * j / (n_t - 1);
        if (!rate)
          at->values(t, now);
        else if (rates)
          rates->values(t, now);
        else
        {
          const double from = std::max(t - beside, 0.), to = std::min(t + beside, T);
          at->values(from, before);
          at->values(to, after);
          for (unsigned int i = 0; i < n_s; ++i)
            now[i] = (after[i] - before[i]) / (to - from);
        }
        m.insert(m.end(), now.begin(), now.end());
      }
      return m;
    }
  } // namespace

  SceneFamily::SceneFamily(Form &form, std::vector<Variable> variables)
    : form_(form)
    , variables_(std::move(variables))
  {
  }

  SceneFamily::~SceneFamily()
  {
    for (const Variable &variable : variables_)
      form_.declarations.set(variable.path, to_text(variable.start));
  }

  double
  SceneFamily::scale(const std::vector<double> &x, const std::size_t i) const
  {
    constexpr double least = 0.01, of_unknown = 0.1;
    const Variable &variable = variables_[i];
    const double range = variable.to - variable.from, size = std::max(std::abs(x[i]), std::abs(variable.start));
    return size > 0. ? std::clamp(size, least * range, range) : of_unknown * range;
  }

  SceneFamily::Stencil
  SceneFamily::stencil(const std::vector<double> &x, const std::size_t i, const double relative_step) const
  {
    const Variable &variable = variables_[i];
    const double step        = relative_step * scale(x, i);
    if (x[i] - 2. * step >= variable.from && x[i] + 2. * step <= variable.to)
      return {{-2. * step, -step, step, 2. * step},
              {1. / (12. * step), -8. / (12. * step), 8. / (12. * step), -1. / (12. * step)}};
    const double d = x[i] + 2. * step > variable.to ? -step : step; // inwards
    return {{0., d, 2. * d, 3. * d, 4. * d},
            {-25. / (12. * d), 48. / (12. * d), -36. / (12. * d), 16. / (12. * d), -3. / (12. * d)}};
  }

  std::vector<double>
  SceneFamily::differences(const std::vector<double> &x,
                           const std::function<std::vector<double>(const Parameters &)> &values,
                           const double relative_step)
  {
    std::vector<double> result;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      const Stencil around = stencil(x, i, relative_step);
      for (std::size_t k = 0; k < around.places.size(); ++k)
      {
        std::vector<double> other = x;
        other[i] += around.places[k];
        const std::vector<double> there = values(parameters(other));
        result.resize(there.size() * x.size());
        for (std::size_t p = 0; p < there.size(); ++p)
          result[p * x.size() + i] += around.weights[k] * there[p];
      }
    }
    return result;
  }

  LimitedValues
  SceneFamily::stress(const std::vector<double> &x, const bool rate, const bool with_gradients)
  {
    constexpr double step = 1e-4;
    const auto samples    = [rate](const Parameters &there) { return stress_samples(there, rate); };
    LimitedValues result{samples(parameters(x)), nullptr};
    if (with_gradients)
      result.jacobian = std::make_shared<const std::vector<double>>(differences(x, samples, step));
    return result;
  }
} // namespace crawler
