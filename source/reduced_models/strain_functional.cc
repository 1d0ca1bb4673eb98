// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/strain_functional.h>

#include <algorithm>

namespace crawler
{
  /// State at one time; lists over the points of the quadrature.
  struct StrainFunctional::State
  {
    explicit State(const std::size_t n)
      : m(n)
      , by_B(n)
      , by_rate(n)
    {
    }

    GivenMotion motion;
    std::vector<double> m, by_B, by_rate;
  };

  StrainFunctional::StrainFunctional(const unsigned int n_space_panels, const unsigned int n_time_panels)
    : points(GaussPanels(0., 1., n_space_panels).points_and_ends())
    , times(GaussPanels(0., 1., n_time_panels).points_and_ends())
    , space_(0., 1., n_space_panels)
    , time_(0., 1., n_time_panels)
    , n_(space_.points().size())
    , time_weights_(time_.weights())
  {
    time_weights_.insert(time_weights_.end(), {0., 0.});
  }

  StrainSamples
  StrainFunctional::sample(const ActiveStress &strain) const
  {
    StrainSamples samples;
    samples.resize(points.size() * times.size());
    const auto at = strain.at(points), rate_at = strain.rate_at(points);
    for (std::size_t i = 0; i < times.size(); ++i)
    {
      at->values(times[i], {&samples.strain[i * points.size()], points.size()});
      rate_at->values(times[i], {&samples.rate[i * points.size()], points.size()});
    }
    return samples;
  }

  bool
  StrainFunctional::evaluate(const std::size_t time,
                             const StrainSamples &samples,
                             const BodyAtPoints &body,
                             State &state) const
  {
    const double *const e = &samples.strain[time * points.size()], *const e_t = &samples.rate[time * points.size()];
    if (!std::all_of(e, e + points.size(), [](const double one) { return 1. + one > 0.; }))
      return false;
    state.motion.find(space_, {e, n_}, {e_t, n_}, body, /*with_slopes=*/true);
    space_.running_integral(state.motion.gv, state.m);
    for (std::size_t i = 0; i < n_; ++i)
      state.m[i] -= body.elastic_modulus[i] * e[i];
    return true;
  }

  std::optional<StrainFunctional::Values>
  StrainFunctional::values(const StrainSamples &samples, const BodyAtPoints &body) const
  {
    const auto &weights = space_.weights();
    State state(n_);
    Values values{};
    for (std::size_t time = 0; time < times.size(); ++time)
    {
      if (!evaluate(time, samples, body, state))
        return std::nullopt;
      const double *const e = &samples.strain[time * points.size()], *const e_t = &samples.rate[time * points.size()];
      double dissipation_rate = 0., positive_power = 0., square = 0., elastic_energy = 0.;
      for (std::size_t i = 0; i < n_; ++i)
      {
        dissipation_rate += weights[i] * state.motion.gv[i] * state.motion.v[i];
        positive_power += weights[i] * std::max(-state.m[i] * e_t[i], 0.);
        square += weights[i] * e[i] * e[i];
        elastic_energy += 0.5 * weights[i] * body.elastic_modulus[i] * e[i] * e[i];
      }
      values[displacement] += time_weights_[time] * state.motion.velocity;
      values[dissipation] += time_weights_[time] * dissipation_rate;
      values[positive_work] += time_weights_[time] * positive_power;
      values[mean_square] += time_weights_[time] * square;
      if (time + 2 == times.size()) // the start
        values[stress_work] -= elastic_energy;
      if (time + 1 == times.size())
        values[stress_work] += elastic_energy;
    }
    values[stress_work] += values[dissipation];
    return values;
  }

  StrainSamples
  StrainFunctional::weights(const Number number, const StrainSamples &samples, const BodyAtPoints &body) const
  {
    const auto &w                = space_.weights();
    const std::vector<double> &k = body.elastic_modulus;
    State state(n_);
    StrainSamples result;
    result.resize(samples.strain.size());
    for (std::size_t time = 0; time < times.size(); ++time)
    {
      const std::size_t first = time * points.size();
      const double *const e = &samples.strain[first], *const e_t = &samples.rate[first];
      double *const by_e = &result.strain[first], *const by_rate = &result.rate[first];
      const double weight = time_weights_[time];
      if (number == stress_work && weight == 0.) // energies at start and end
        for (std::size_t i = 0; i < n_; ++i)
          by_e[i] = (time + 1 == times.size() ? 1. : -1.) * k[i] * w[i] * e[i];
      if (weight == 0.)
        continue;
      if (number == mean_square)
      {
        for (std::size_t i = 0; i < n_; ++i)
          by_e[i] = 2. * weight * w[i] * e[i];
        continue;
      }
      evaluate(time, samples, body, state);
      const auto dg = [&](const std::size_t i) { return state.motion.w_dg[i] / state.motion.w[i]; };
      if (number == displacement)
        for (std::size_t i = 0; i < n_; ++i)
        {
          by_e[i]       = -weight * w[i] * dg(i) * state.motion.v[i] / state.motion.g_mean;
          state.by_B[i] = weight * w[i] * (1. - state.motion.g[i] / state.motion.g_mean);
        }
      else if (number == dissipation || number == stress_work)
        for (std::size_t i = 0; i < n_; ++i)
        {
          by_e[i]       = weight * w[i] * dg(i) * state.motion.v[i] * state.motion.v[i];
          state.by_B[i] = 2. * weight * w[i] * state.motion.gv[i];
        }
      else
      {
        std::vector<double> &by_m = state.by_rate, &by_force = state.by_B; // derivatives by m and g v
        for (std::size_t i = 0; i < n_; ++i)
          by_m[i] = -state.m[i] * e_t[i] > 0. ? -weight * w[i] * e_t[i] : 0.;
        space_.running_integral_transposed(by_m, by_force);
        double by_drift = 0.;
        for (std::size_t i = 0; i < n_; ++i)
          by_drift += by_force[i] * state.motion.g[i];
        for (std::size_t i = 0; i < n_; ++i)
        {
          const double of_force = by_force[i] - by_drift * w[i] / state.motion.g_mean;
          by_e[i]               = of_force * dg(i) * state.motion.v[i] - k[i] * by_m[i];
          state.by_B[i]         = of_force * state.motion.g[i];
        }
      }
      space_.running_integral_transposed(state.by_B, state.by_rate);
      std::copy_n(state.by_rate.begin(), n_, by_rate);
      if (number == positive_work)
        for (std::size_t i = 0; i < n_; ++i)
          if (-state.m[i] * e_t[i] > 0.)
            by_rate[i] -= weight * w[i] * state.m[i];
    }
    return result;
  }
} // namespace crawler
