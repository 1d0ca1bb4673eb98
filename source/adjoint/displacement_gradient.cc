// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/displacement_gradient.h>
#include <crawler/adjoint/forces_at_points.h>
#include <crawler/lanes/lane_adjoint.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    /// f' from f(-2), f(-1), f(1), f(2).
    double
    fourth_order(const std::array<double, 4> &values, const double step)
    {
      return (8. * (values[2] - values[1]) - (values[3] - values[0])) / (12. * step);
    }

  } // namespace

  bool
  have_similar_breaks(const Scene &scene, const Scene &other)
  {
    return BreakMap(breaks_in_space_of(scene), breaks_in_space_of(other)).is_one_to_one() &&
           BreakMap(breaks_in_time_of(scene), breaks_in_time_of(other)).is_good();
  }

  DisplacementGradient::DisplacementGradient(const RecordedRun &run)
    : run_(run)
  {
  }

  std::vector<std::optional<double>>
  DisplacementGradient::derivatives(const std::span<const Variation> variations)
  {
    LaneAdjoint adjoint(run_.natural, run_.method);
    const LaneTables &tables   = adjoint.tables();
    const LaneSetup &setup     = tables.setup;
    const std::size_t n_points = tables.points.size(), n = run_.steps.end().size();
    const RadauTableau &tableau = radau_tableau(setup.n_stages);
    const std::size_t per_cell  = setup.degree + 1;
    std::vector<double> weights(n_points);
    for (std::size_t i = 0; i < n_points; ++i)
      weights[i] = setup.sizes[i / per_cell] * setup.weights[i % per_cell];

    ForcesAtPoints own(run_.scene, run_.scene, tables.points);
    std::vector<std::array<std::unique_ptr<ForcesAtPoints>, 4>> others(variations.size());
    for (std::size_t i = 0; i < variations.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        others[i][k] = std::make_unique<ForcesAtPoints>(*variations[i].scenes[k], run_.scene, tables.points);
    std::vector<std::array<double, 4>> sums(variations.size());
    std::vector<double> at_edges(variations.size()); ///< of them, at start and end
    constexpr std::size_t most_samples = 4000000;
    const bool keeps_stress            = run_.steps.n_steps() * tableau.n * n_points <= most_samples;
    local_ = {tables.points, std::vector<double>(n_points, 0.), std::vector<double>(n_points, 0.), {}, {}};

    std::vector<double> y = run_.steps.end(), u(n), v(n), mu_at(n_points), mu_s(n_points);
    StateAtPoints at(n_points);
    const auto see = [&](const std::size_t step, const std::span<const double> mu, const std::span<const double> zeta) {
      std::vector<double> zeta_at(n_points), zeta_s(n_points);
      if (!zeta.empty())
        evaluate_at_points(setup, zeta.data(), zeta_at, zeta_s);
      const double *z = run_.steps.z(step);
      for (std::size_t d = 0; d < n; ++d)
        y[d] -= z[(tableau.n - 1) * n + d];
      for (unsigned int i = tableau.n; i-- > 0;)
      {
        for (std::size_t d = 0; d < n; ++d)
          u[d] = y[d] + z[i * n + d];
        radau::stage_rate(static_cast<int>(tableau.n),
                          tableau.inverse.data(),
                          static_cast<int>(i),
                          1. / run_.steps.size(step),
                          z,
                          static_cast<int>(n),
                          v.data());
        evaluate_at_points(setup, u.data(), at.u, at.e);
        evaluate_at_points(setup, v.data(), at.v, at.rate);
        for (std::size_t p = 0; p < n_points; ++p)
          at.w[p] = 1. + at.e[p];
        evaluate_at_points(setup, mu.data() + i * n, mu_at, mu_s);
        const double t = run_.steps.time(step) - (1. - tableau.c[i]) * run_.steps.size(step);
        own.evaluate(t, run_.steps.time(step), at);
        for (std::size_t p = 0; p < n_points; ++p)
        {
          local_.elastic_modulus[p] += own.elastic(p, at.e[p]) * mu_s[p];
          local_.friction[p] += own.friction(p) * mu_at[p];
        }
        if (keeps_stress)
        {
          local_.times.push_back(t * run_.units.time);
          for (std::size_t p = n_points; p-- > 0;)
            local_.stress.push_back(mu_s[p] /
                                    (run_.steps.size(step) * tableau.b[i] * run_.units.force * run_.units.time));
        }
        for (std::size_t number = 0; number < others.size(); ++number)
          for (std::size_t k = 0; k < 4; ++k)
          {
            ForcesAtPoints &forces = *others[number][k];
            forces.evaluate(t, run_.steps.time(step), at);
            for (std::size_t p = 0; p < n_points; ++p) // the differences, since the sums nearly cancel
              sums[number][k] += weights[p] * ((forces.body_force(p) - own.body_force(p)) * mu_s[p] +
                                               (forces.friction(p) - own.friction(p)) * mu_at[p]);
            const bool is_start = step == 0 && i == 0, is_end = i + 1 == tableau.n;
            if (!(is_start || is_end) || !forces.has_between(t, is_start))
              continue;
            const std::vector<double> between = forces.between(t, is_start);
            double sum                        = 0.;
            for (std::size_t p = 0; p < n_points; ++p)
              sum -= weights[p] * between[p] * (is_end ? zeta_s[p] : -mu_s[p] / (run_.steps.size(step) * tableau.b[i]));
            sums[number][k] += sum;
            // Where friction is not linear in the velocity an impulse is more than its size.
            if (is_start || run_.steps.time(step) == 1. || (setup.laws & LaneLaws::nonlinear_in_velocity) != 0)
              at_edges[number] = std::max(at_edges[number], std::abs(sum));
          }
      }
    };
    evaluate_at_points(setup, y.data(), at.u, at.e);
    for (std::size_t number = 0; number < others.size(); ++number)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t p = 0; p < n_points; ++p)
          sums[number][k] += weights[p] * (others[number][k]->longer(p) - 1.) * at.u[p];
    if (!adjoint.solve(run_.steps, adjoint.gradient_of_displacement(), see))
      throw std::runtime_error("the adjoint of a step did not converge");

    const double natural_displacement = run_.displacement / run_.units.length;
    std::vector<std::optional<double>> result;
    for (std::size_t i = 0; i < variations.size(); ++i)
    {
      constexpr double nothing = 1e-7;
      std::array<double, 4> lengths;
      for (std::size_t k = 0; k < 4; ++k)
        lengths[k] = others[i][k]->units().length;
      const double derivative = run_.units.length * fourth_order(sums[i], variations[i].step) +
                                natural_displacement * fourth_order(lengths, variations[i].step);
      if (run_.units.length * at_edges[i] <= nothing * variations[i].step * std::abs(derivative))
        result.push_back(derivative);
      else
        result.push_back(std::nullopt);
    }
    for (double &s : local_.s)
      s *= run_.units.length;
    std::reverse(local_.times.begin(), local_.times.end());
    std::reverse(local_.stress.begin(), local_.stress.end());
    return result;
  }
} // namespace crawler
