// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/strain_functional.h>

#include <algorithm>

namespace crawler
{
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
                             GivenMotion &motion,
                             std::vector<double> &m) const
  {
    const double *const e = &samples.strain[time * points.size()], *const e_t = &samples.rate[time * points.size()];
    if (!std::all_of(e, e + points.size(), [](const double one) { return 1. + one > 0.; }))
      return false;
    motion.find(space_, {e, n_}, {e_t, n_}, body, /*with_slopes=*/true);
    space_.running_integral(motion.gv, m);
    for (std::size_t i = 0; i < n_; ++i)
      m[i] -= body.elastic_modulus[i] * e[i];
    return true;
  }

  std::optional<StrainFunctional::Values>
  StrainFunctional::values(const StrainSamples &samples, const BodyAtPoints &body) const
  {
    const auto &weights = space_.weights();
    GivenMotion motion;
    std::vector<double> m(n_);
    Values values{};
    for (std::size_t time = 0; time < times.size(); ++time)
    {
      if (!evaluate(time, samples, body, motion, m))
        return std::nullopt;
      const double *const e = &samples.strain[time * points.size()], *const e_t = &samples.rate[time * points.size()];
      double dissipation_rate = 0., positive_power = 0., square = 0., elastic_energy = 0.;
      for (std::size_t i = 0; i < n_; ++i)
      {
        dissipation_rate += weights[i] * motion.gv[i] * motion.v[i];
        positive_power += weights[i] * std::max(-m[i] * e_t[i], 0.);
        square += weights[i] * e[i] * e[i];
        elastic_energy += 0.5 * weights[i] * body.elastic_modulus[i] * e[i] * e[i];
      }
      values[displacement] += time_weights_[time] * motion.velocity;
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
    GivenMotion motion;
    std::vector<double> m(n_), by_B(n_), by_m(n_);
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
      evaluate(time, samples, body, motion, m);
      const auto dg = [&](const std::size_t i) { return motion.w_dg[i] / motion.w[i]; };
      if (number == displacement)
        for (std::size_t i = 0; i < n_; ++i)
        {
          by_e[i] = -weight * w[i] * dg(i) * motion.v[i] / motion.g_mean;
          by_B[i] = weight * w[i] * (1. - motion.g[i] / motion.g_mean);
        }
      else if (number == dissipation || number == stress_work)
        for (std::size_t i = 0; i < n_; ++i)
        {
          by_e[i] = weight * w[i] * dg(i) * motion.v[i] * motion.v[i];
          by_B[i] = 2. * weight * w[i] * motion.gv[i];
        }
      else
      {
        std::vector<double> &by_force = by_B; // derivative by g v
        for (std::size_t i = 0; i < n_; ++i)
          by_m[i] = -m[i] * e_t[i] > 0. ? -weight * w[i] * e_t[i] : 0.;
        space_.running_integral_transposed(by_m, by_force);
        double by_drift = 0.;
        for (std::size_t i = 0; i < n_; ++i)
          by_drift += by_force[i] * motion.g[i];
        for (std::size_t i = 0; i < n_; ++i)
        {
          const double of_force = by_force[i] - by_drift * w[i] / motion.g_mean;
          by_e[i]               = of_force * dg(i) * motion.v[i] - k[i] * by_m[i];
          by_B[i]               = of_force * motion.g[i];
        }
      }
      space_.running_integral_transposed(by_B, {by_rate, n_});
      if (number == positive_work)
        for (std::size_t i = 0; i < n_; ++i)
          if (-m[i] * e_t[i] > 0.)
            by_rate[i] -= weight * w[i] * m[i];
    }
    return result;
  }
} // namespace crawler
