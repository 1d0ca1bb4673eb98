// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/model_error.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crawler
{
  namespace
  {
    constexpr double pi = std::numbers::pi;

    constexpr unsigned int n_corrections = 3;
    /// Factor on the change of the displacement by the last correction, for all omitted corrections.
    constexpr double safety = 3.;
    /// Share of the error for the grid.
    constexpr double grid_share = 0.3;
    /// Ratio of the last change to the largest one beyond which the corrections are not trusted.
    constexpr double slowest_decay = 0.7;

    /// Change of the displacement that is nothing but round-off, relative to the length.
    constexpr double round_off = 1e-15;

    /// Approximate motion on a grid: n_s points in the middle of equal parts of the body, n_t equal steps.
    struct Motion
    {
      std::size_t n_s = 0, n_t = 0;
      std::vector<double> e;   ///< strain, [t][s] with n_t + 1 times
      std::vector<double> B_t; ///< int_0^s e_t
      /// True if f = m_s + k e_s is B_t up to a function of time, which no mode of a correction sees; else f is 0.
      bool is_wave = false;

      double
      place(const std::size_t i) const
      {
        return (static_cast<double>(i) + 0.5) / static_cast<double>(n_s);
      }
      double
      time(const std::size_t n) const
      {
        return static_cast<double>(n) / static_cast<double>(n_t);
      }
    };

    Motion
    motion_of(const ActiveStress &strain, const std::size_t n_s, const std::size_t n_t, const bool is_wave)
    {
      const std::vector<double> zero(n_s * (n_t + 1));
      Motion motion{n_s, n_t, zero, zero, is_wave};
      std::vector<double> points(n_s), e_t(n_s);
      for (std::size_t i = 0; i < n_s; ++i)
        points[i] = motion.place(i);
      const auto at = strain.at(points), rate_at = strain.rate_at(points);
      for (std::size_t n = 0; n <= n_t; ++n)
      {
        at->values(motion.time(n), {motion.e.data() + n * n_s, n_s});
        rate_at->values(motion.time(n), e_t);
        double sum = 0.;
        for (std::size_t i = 0; i < n_s; ++i)
        {
          motion.B_t[n * n_s + i] = (sum + 0.5 * e_t[i]) / static_cast<double>(n_s);
          sum += e_t[i];
        }
      }
      return motion;
    }

    /// Solver for u_t = k u_ss - r in modes cos(j pi s), j = 1 ... n_modes.
    class Correction
    {
    public:
      Correction(const Motion &motion, const FrictionLaw &friction, const double stiffness)
        : motion_(motion)
        , friction_(friction)
        , stiffness_(stiffness)
        , n_modes_(motion.n_s * 2 / 3)
        , cosine_(n_modes_ * motion.n_s)
        , sine_(cosine_.size())
        , modes_((motion.n_t + 1) * n_modes_, 0.)
        , residual_(modes_.size())
      {
        for (std::size_t j = 1; j <= n_modes_; ++j)
          for (std::size_t i = 0; i < motion.n_s; ++i)
          {
            const double angle                = static_cast<double>(j) * pi * motion.place(i);
            cosine_[(j - 1) * motion.n_s + i] = std::cos(angle);
            sine_[(j - 1) * motion.n_s + i]   = -static_cast<double>(j) * pi * std::sin(angle);
          }
      }

      /// Computes the displacement with the present correction, or NaN if a stretch is not positive; keeps the
      /// residual.
      double
      displacement()
      {
        const std::size_t n_s = motion_.n_s, n_t = motion_.n_t;
        const double dt = 1. / static_cast<double>(n_t), mean = 1. / static_cast<double>(n_s);
        std::vector<double> w(n_s), u_t(n_s), v(n_s), g(n_s), rates(n_modes_);
        double sum = 0.;
        for (std::size_t n = 0; n <= n_t; ++n)
        {
          const std::size_t before = n == 0 ? 0 : n - 1, after = n == n_t ? n_t : n + 1;
          const double span = dt * static_cast<double>(after - before);
          std::fill(u_t.begin(), u_t.end(), 0.);
          const double *e = motion_.e.data() + n * n_s, *B_t = motion_.B_t.data() + n * n_s;
          for (std::size_t i = 0; i < n_s; ++i)
            w[i] = 1. + e[i];
          if (is_corrected_)
            for (std::size_t j = 0; j < n_modes_; ++j)
            {
              const double mode = modes_[n * n_modes_ + j];
              const double rate = (modes_[after * n_modes_ + j] - modes_[before * n_modes_ + j]) / span;
              const double *c = cosine_.data() + j * n_s, *s = sine_.data() + j * n_s;
              for (std::size_t i = 0; i < n_s; ++i)
              {
                w[i] += mode * s[i];
                u_t[i] += rate * c[i];
              }
            }
          if (!(*std::min_element(w.begin(), w.end()) > 0.))
            return std::nan("");
          friction_.values(w, g);
          double g_mean = 0., v_mean = 0., covariance = 0.;
          for (std::size_t i = 0; i < n_s; ++i)
          {
            v[i] = B_t[i] + u_t[i];
            g_mean += mean * g[i];
            v_mean += mean * v[i];
          }
          for (std::size_t i = 0; i < n_s; ++i)
            covariance += mean * (g[i] - g_mean) * (v[i] - v_mean);
          const double velocity = -covariance / g_mean;
          sum += (n == 0 || n == n_t ? 0.5 : 1.) * dt * velocity;
          for (std::size_t i = 0; i < n_s; ++i)
            v[i] = g[i] * (v[i] - v_mean + velocity) - u_t[i];
          if (motion_.is_wave)
            for (std::size_t i = 0; i < n_s; ++i)
              v[i] -= B_t[i];
          for (std::size_t j = 0; j < n_modes_; ++j)
          {
            double product  = 0.;
            const double *c = cosine_.data() + j * n_s;
            for (std::size_t i = 0; i < n_s; ++i)
              product += v[i] * c[i];
            residual_[n * n_modes_ + j] = 2. * mean * product;
          }
        }
        return sum;
      }

      /// Computes a new correction, from the residual of the last one.
      void
      correct()
      {
        const double dt = 1. / static_cast<double>(motion_.n_t);
        for (std::size_t j = 0; j < n_modes_; ++j)
        {
          const double q = static_cast<double>(j + 1) * pi, z = stiffness_ * q * q * dt, decay = std::exp(-z);
          // Integrals over a step of exp(-z (1-x)) times 1-x and x.
          const double both   = z < 1e-3 ? 1. - z / 2. + z * z / 6. : -std::expm1(-z) / z;
          const double at_end = z < 1e-3 ? 0.5 - z / 6. + z * z / 24. : (1. - both) / z, at_start = both - at_end;
          for (std::size_t n = 0; n < motion_.n_t; ++n)
          {
            const std::size_t now = n * n_modes_ + j, next = now + n_modes_;
            modes_[next] = decay * modes_[now] - dt * (at_start * residual_[now] + at_end * residual_[next]);
          }
        }
        is_corrected_ = true;
      }

    private:
      const Motion &motion_;
      const FrictionLaw &friction_;
      const double stiffness_;
      const std::size_t n_modes_;
      std::vector<double> cosine_, sine_;    ///< [mode][point]: cos(j pi s) and its derivative
      std::vector<double> modes_, residual_; ///< [time][mode]
      bool is_corrected_ = false;
    };

    /// Displacement to second order in the strain, -a int <(e - <e>)(B_t - <B_t>)> dt, on the same grid.
    double
    second_order_displacement(const Motion &motion, const double a)
    {
      const std::size_t n_s = motion.n_s, n_t = motion.n_t;
      double sum = 0.;
      for (std::size_t n = 0; n <= n_t; ++n)
      {
        const double *e = motion.e.data() + n * n_s, *B_t = motion.B_t.data() + n * n_s;
        double e_mean = 0., B_t_mean = 0., product = 0.;
        for (std::size_t i = 0; i < n_s; ++i)
        {
          e_mean += e[i];
          B_t_mean += B_t[i];
          product += e[i] * B_t[i];
        }
        const double mean = 1. / static_cast<double>(n_s);
        sum += (n == 0 || n == n_t ? 0.5 : 1.) * (product * mean - e_mean * mean * B_t_mean * mean);
      }
      return -a * sum / static_cast<double>(n_t);
    }

    /// True if there is no strain at t = 0: the layers of a sudden start are no part of the motion.
    bool
    starts_at_rest(const Motion &motion)
    {
      constexpr double part = 1e-8; // round-off, also of numbers in a table
      const auto largest    = [&](const std::size_t n) {
        double result = 0.;
        for (std::size_t i = 0; i < n; ++i)
          result = std::max(result, std::abs(motion.e[i]));
        return result;
      };
      return largest(motion.n_s) <= part * largest(motion.e.size());
    }

    ModelErrors
    estimate(const Motion &motion, const Scene &scene)
    {
      Correction correction(motion, *scene.friction, scene.body.elastic_modulus);
      std::array<double, n_corrections + 1> D{};
      std::array<double, n_corrections> change{};
      D[0] = correction.displacement();
      for (unsigned int i = 0; i < n_corrections; ++i)
      {
        correction.correct();
        D[i + 1]  = correction.displacement();
        change[i] = std::abs(D[i + 1] - D[i]);
        if (!std::isfinite(D[i + 1]))
          return {};
      }
      const double last = change.back(), rest = safety * last;
      ModelErrors errors;
      errors.displacement = D.back();
      errors.changes      = change;
      errors.known = last <= std::max(round_off, slowest_decay * *std::max_element(change.begin(), change.end() - 1));
      const double series = second_order_displacement(motion, scene.body.friction_exponent());
      errors.kinematic    = (1. + grid_share) * std::abs(D.back() - D.front()) + rest;
      errors.perturbation = (1. + grid_share) * std::abs(D.back() - series) + rest;
      return errors;
    }
  } // namespace

  ModelErrors
  estimate_model_errors(const Scene &scene, const NaturalWave &wave)
  {
    constexpr double per_wave = 24., max_steps = 20000., max_points = 256.;
    const double strides = std::max(1., std::abs(wave.speed));
    // Layers at the ends are as thick as the reach of the elastic force within a stride.
    const double layer = std::sqrt(scene.body.elastic_modulus / strides);
    const double n_s   = std::min(max_points, std::max(per_wave * wave.n_waves(), 2. / layer));
    const double n_t   = per_wave * wave.n_waves() * std::ceil(strides);
    if (!(n_t <= max_steps))
      return {};
    const Motion motion = motion_of(
      leading_order_strain(wave), static_cast<std::size_t>(n_s), static_cast<std::size_t>(n_t), /*is_wave=*/true);
    return estimate(motion, scene);
  }

  ModelErrors
  estimate_model_errors(const Scene &scene, const ActiveStress &strain)
  {
    constexpr std::size_t most = 512;
    constexpr double tolerance = 0.1;
    ModelErrors last;
    for (std::size_t n = 32; n <= most; n *= 2)
    {
      const Motion motion = motion_of(strain, n, n, /*is_wave=*/false);
      if (!starts_at_rest(motion))
        return {};
      const ModelErrors now = estimate(motion, scene);
      if (last.known && now.known && std::abs(now.kinematic - last.kinematic) <= tolerance * now.kinematic)
        return now;
      last = now;
    }
    return {};
  }
} // namespace crawler
