// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/strain.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crawler
{
  namespace
  {
    class WaveAtPoints : public StrainAtPoints
    {
    public:
      WaveAtPoints(const NaturalWave &wave, const std::vector<double> &points)
        : wave_(wave)
        , n_points_(points.size())
      {
        for (const auto &harmonic : wave_.harmonics)
          for (const double s : points)
          {
            sine_.push_back(std::sin(harmonic.q * s));
            cosine_.push_back(std::cos(harmonic.q * s));
          }
      }

      // With theta = q c t: e = (a (cos theta - 1) - b sin theta) sin qs + (a sin theta + b (cos theta - 1)) cos qs.
      void
      strain(const double t, const std::span<double> e) override
      {
        combine(e, [&](const NaturalWave::Harmonic &h) {
          const double theta = h.q * wave_.speed * t, half = std::sin(0.5 * theta);
          const double st = std::sin(theta), ct_minus_1 = -2. * half * half;
          return std::pair(h.a * ct_minus_1 - h.b * st, h.a * st + h.b * ct_minus_1);
        });
      }

      void
      rate(const double t, const std::span<double> e_t) override
      {
        combine(e_t, [&](const NaturalWave::Harmonic &h) {
          const double theta = h.q * wave_.speed * t, rate = h.q * wave_.speed;
          const double st = std::sin(theta), ct = std::cos(theta);
          return std::pair(-rate * (h.a * st + h.b * ct), rate * (h.a * ct - h.b * st));
        });
      }

    private:
      template <typename Factors>
      void
      combine(const std::span<double> result, const Factors &factors) const
      {
        std::fill(result.begin(), result.end(), 0.);
        for (std::size_t h = 0; h < wave_.harmonics.size(); ++h)
        {
          const auto [of_sine, of_cosine] = factors(wave_.harmonics[h]);
          const double *sine = sine_.data() + h * n_points_, *cosine = cosine_.data() + h * n_points_;
          for (std::size_t i = 0; i < n_points_; ++i)
            result[i] += of_sine * sine[i] + of_cosine * cosine[i];
        }
      }

      const NaturalWave &wave_;
      const std::size_t n_points_;
      std::vector<double> sine_, cosine_; ///< [harmonic][point]
    };

    class StiffAtPoints : public StrainAtPoints
    {
    public:
      StiffAtPoints(const Scene &scene, const std::vector<double> &points)
        : k_(scene.body.elastic_modulus)
        , stress_(scene.active_stress->at(points))
        , rate_(scene.active_stress->rate_at(points))
      {
      }

      void
      strain(const double t, const std::span<double> e) override
      {
        stress_->values(t, e);
        for (double &value : e)
          value /= -k_;
      }
      void
      rate(const double t, const std::span<double> e_t) override
      {
        rate_->values(t, e_t);
        for (double &value : e_t)
          value /= -k_;
      }

    private:
      const double k_;
      const std::unique_ptr<ActiveStressAtPoints> stress_, rate_;
    };
  } // namespace

  unsigned int
  NaturalWave::n_waves() const
  {
    double q = 0.;
    for (const Harmonic &harmonic : harmonics)
      q = std::max(q, harmonic.q);
    return static_cast<unsigned int>(std::lround(q / (2. * std::numbers::pi)));
  }

  NaturalWave
  natural_wave(const Scene &scene, const OptimalWave &wave)
  {
    const double c = wave.wave().speed, chi = wave.perturbation_parameter();
    const WaveShape &shape = wave.shape();
    NaturalWave result{c * scene.end_time / scene.body.length,
                       scene.body.friction_exponent(),
                       scene.body.elastic_modulus / natural_units(scene).force,
                       {}};
    for (unsigned int n = 1; n <= shape.a.size(); ++n)
      if (shape.power(n) != 0.)
        result.harmonics.push_back({2. * std::numbers::pi * n, chi * (shape.a[n - 1] / c), chi * (shape.b[n - 1] / c)});
    return result;
  }

  std::unique_ptr<StrainAtPoints>
  LeadingOrderStrain::at(const std::vector<double> &points) const
  {
    return std::make_unique<WaveAtPoints>(wave_, points);
  }

  std::unique_ptr<StrainAtPoints>
  StiffStrain::at(const std::vector<double> &points) const
  {
    return std::make_unique<StiffAtPoints>(scene_, points);
  }

  std::optional<FieldBounds>
  LeadingOrderStrain::bounds(const SpaceTimeBox &) const
  {
    FieldBounds sum{0., 0.};
    for (const NaturalWave::Harmonic &harmonic : wave_.harmonics)
    {
      const double amplitude = std::hypot(harmonic.a, harmonic.b);
      sum.value += 2. * amplitude;
      sum.rate += harmonic.q * std::abs(wave_.speed) * amplitude;
    }
    return sum;
  }

  std::optional<FieldBounds>
  StiffStrain::bounds(const SpaceTimeBox &box) const
  {
    auto bounds = scene_.active_stress->bounds(box);
    if (bounds)
      *bounds = {bounds->value / scene_.body.elastic_modulus, bounds->rate / scene_.body.elastic_modulus};
    return bounds;
  }
} // namespace crawler
