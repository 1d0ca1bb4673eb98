// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/stretch_wave.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace crawler
{
  namespace
  {
    /// A change of the strain that is smaller than this is none.
    constexpr double nothing = 1e-12;
    /// Of the mean square of e, at most this part may be in harmonics that are not looked at: a pulse that few samples
    /// see has half of it there, a signal that is on for a tenth of the period a tenth.
    constexpr double most_unresolved = 0.3;
    /// Extremes of the stretch move by at most twice the largest |e|; by this many of it only if the samples, means
    /// over pieces of the body at few times, have not seen what moved them.
    constexpr double most_swing = 4.;
    /// Of the table of each harmonic, and of the search for the number of waves on the body.
    constexpr unsigned int steps_per_wave = 4, search_steps_per_wave = 16;

    constexpr unsigned int n_harmonics = 8;
    using Harmonics                    = std::array<double, n_harmonics>;
    struct Complex
    {
      Harmonics re{}, im{};
    };

    double
    square(const double x)
    {
      return x * x;
    }

    /// cos and sin of 2 pi i/n, i = 0 ... n - 1.
    std::vector<std::array<double, 2>>
    circle(const std::size_t n)
    {
      std::vector<std::array<double, 2>> points(n);
      for (std::size_t i = 0; i < n; ++i)
      {
        const double angle = 2. * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
        points[i]          = {{std::cos(angle), std::sin(angle)}};
      }
      return points;
    }

    Complex
    weighted_sum(const std::vector<Complex> &x, const std::vector<double> &weights)
    {
      Complex sum;
      for (std::size_t i = 0; i < x.size(); ++i)
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          sum.re[n] += weights[i] * x[i].re[n];
          sum.im[n] += weights[i] * x[i].im[n];
        }
      return sum;
    }

    /// The number of waves by the mean phase of the fundamental from piece to piece.
    double
    from_phases(const std::vector<Complex> &E)
    {
      double re = 0., im = 0.;
      for (std::size_t i = 0; i + 1 < E.size(); ++i)
      {
        re += E[i].re[0] * E[i + 1].re[0] + E[i].im[0] * E[i + 1].im[0];
        im += E[i].re[0] * E[i + 1].im[0] - E[i].im[0] * E[i + 1].re[0];
      }
      return -std::atan2(im, re) / (2. * std::numbers::pi) * static_cast<double>(E.size());
    }

    /// The number of waves of the largest S, to a sixteenth, among those that the pieces tell apart: each harmonic
    /// gives |int E_n e^(iks) ds|^2 as a table over k.
    double
    search(const std::vector<Complex> &E)
    {
      const std::size_t half = E.size() / 2, n_table = steps_per_wave * half + 1;
      // The body is folded about its middle: cosines see what is even, sines what is odd, and both directions are one.
      std::vector<Complex> even(half), odd(half);
      std::vector<double> cosines(half, 1.), sines(half, 0.);
      std::vector<std::array<double, 2>> step(half);
      for (std::size_t i = 0; i < half; ++i)
      {
        const Complex &left = E[half - 1 - i], &right = E[half + i];
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          even[i].re[n] = right.re[n] + left.re[n];
          even[i].im[n] = right.im[n] + left.im[n];
          odd[i].re[n]  = right.re[n] - left.re[n];
          odd[i].im[n]  = right.im[n] - left.im[n];
        }
        const double angle =
          2. * std::numbers::pi / steps_per_wave * (static_cast<double>(i) + 0.5) / static_cast<double>(E.size());
        step[i] = {{std::cos(angle), std::sin(angle)}};
      }
      std::vector<std::array<Harmonics, 2>> power(n_table); // of both directions
      for (auto &here : power)
      {
        const Complex a = weighted_sum(even, cosines), b = weighted_sum(odd, sines);
        for (std::size_t i = 0; i < half; ++i)
        {
          const double c = cosines[i], s = sines[i];
          cosines[i] = c * step[i][0] - s * step[i][1];
          sines[i]   = s * step[i][0] + c * step[i][1];
        }
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          here[0][n] = square(a.re[n] - b.im[n]) + square(a.im[n] + b.re[n]);
          here[1][n] = square(a.re[n] + b.im[n]) + square(a.im[n] - b.re[n]);
        }
      }
      constexpr unsigned int finer = search_steps_per_wave / steps_per_wave;
      double largest = -1., best = 0.;
      for (const unsigned int direction : {0, 1})
        for (std::size_t j = 0; j < finer * (n_table - 1); ++j)
        {
          double S = 0.;
          for (std::size_t n = 1; n <= n_harmonics && n * j < finer * (n_table - 1); ++n)
          {
            const std::size_t m = n * j / finer;
            const double part   = static_cast<double>(n * j % finer) / finer;
            S += (1. - part) * power[m][direction][n - 1] + part * power[m + 1][direction][n - 1];
          }
          if (S > largest)
          {
            largest = S;
            best    = (direction == 0 ? 1. : -1.) * static_cast<double>(j) / search_steps_per_wave;
          }
        }
      return best;
    }

    /// sum_n sum_i |E_n|^2
    double
    power(const std::vector<Complex> &E)
    {
      double sum = 0.;
      for (const Complex &here : E)
        for (unsigned int n = 0; n < n_harmonics; ++n)
          sum += square(here.re[n]) + square(here.im[n]);
      return sum;
    }

    /// S as a function of the number of waves of the fundamental on the body, nu = q L/P.
    class Beam
    {
    public:
      /// @p E: [piece] of the body.
      explicit Beam(std::vector<Complex> E)
        : E_(std::move(E))
        , all_(static_cast<double>(E_.size()) * power(E_))
      {
      }

      struct Value
      {
        double S = 0., slope = 0., curvature = 0.;
      };
      Value
      at(double nu) const;

      /// The number of waves of the largest S near @p nu, to round-off.
      double
      best(double nu) const;

    private:
      std::vector<Complex> E_;
      double all_;
    };

    Beam::Value
    Beam::at(const double nu) const
    {
      const double per_piece = 2. * std::numbers::pi * nu / static_cast<double>(E_.size());
      const double middle    = 0.5 * (static_cast<double>(E_.size()) - 1.);
      Complex f, f_s, f_ss; // int E_n e^(i n w q s), with powers of s in pieces from the middle
      const double step_re = std::cos(per_piece), step_im = std::sin(per_piece);
      double re = std::cos(per_piece * middle), im = -std::sin(per_piece * middle);
      for (std::size_t i = 0; i < E_.size(); ++i)
      {
        const double s = static_cast<double>(i) - middle;
        double turn_re = 1., turn_im = 0.;
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          const double next_re = turn_re * re - turn_im * im;
          turn_im              = turn_re * im + turn_im * re;
          turn_re              = next_re;
          const double x       = E_[i].re[n] * turn_re - E_[i].im[n] * turn_im,
                       y       = E_[i].re[n] * turn_im + E_[i].im[n] * turn_re;
          f.re[n] += x;
          f.im[n] += y;
          f_s.re[n] += s * x;
          f_s.im[n] += s * y;
          f_ss.re[n] += s * s * x;
          f_ss.im[n] += s * s * y;
        }
        const double next_re = re * step_re - im * step_im;
        im                   = re * step_im + im * step_re;
        re                   = next_re;
      }
      Value value;
      for (unsigned int n = 0; n < n_harmonics; ++n)
      {
        const double k = 2. * std::numbers::pi * (n + 1.) / static_cast<double>(E_.size());
        value.S += (square(f.re[n]) + square(f.im[n])) / all_;
        value.slope += 2. * k * (f.im[n] * f_s.re[n] - f.re[n] * f_s.im[n]) / all_;
        value.curvature +=
          2. * k * k * (square(f_s.re[n]) + square(f_s.im[n]) - f.re[n] * f_ss.re[n] - f.im[n] * f_ss.im[n]) / all_;
      }
      return value;
    }

    double
    Beam::best(double nu) const
    {
      constexpr unsigned int most_corrections = 30;
      constexpr double most = 0.5 / search_steps_per_wave, last = 1e-7;
      // Newton's method for a slope of 0, which goes uphill where S is not concave. Digits double, so that this last
      // correction leaves round-off.
      for (unsigned int i = 0; i < most_corrections; ++i)
      {
        const Value here = at(nu);
        const double correction =
          here.curvature < 0. ? std::clamp(-here.slope / here.curvature, -most, most) : std::copysign(most, here.slope);
        nu += correction;
        if (std::abs(correction) < last)
          break;
      }
      return nu;
    }
  } // namespace

  std::optional<StretchWave>
  measure_wave(const std::vector<std::vector<double>> &stretch,
               const double period,
               const double length,
               const double swing)
  {
    const std::size_t n_t = stretch.size(), n_s = stretch.front().size();
    const auto per_phase = 1. / static_cast<double>(n_t);
    std::vector<double> mean(n_s, 0.);
    for (const auto &w : stretch)
      for (std::size_t i = 0; i < n_s; ++i)
        mean[i] += per_phase * w[i];
    const auto turns = circle(n_t);
    std::vector<Complex> E(n_s);
    double largest = 0., squares = 0.;
    // Half a period later odd harmonics have the other sign.
    const std::size_t half = n_t / 2;
    for (std::size_t j = 0; j < half; ++j)
    {
      Complex turn;
      for (unsigned int n = 0; n < n_harmonics; ++n)
      {
        turn.re[n] = per_phase * turns[(n + 1) * j % n_t][0];
        turn.im[n] = -per_phase * turns[(n + 1) * j % n_t][1];
      }
      for (std::size_t i = 0; i < n_s; ++i)
      {
        const double e = stretch[j][i] - mean[i], later = stretch[j + half][i] - mean[i];
        largest = std::max({largest, std::abs(e), std::abs(later)});
        squares += per_phase * (e * e + later * later);
        const double odd = e - later, even = e + later;
        for (unsigned int n = 0; n < n_harmonics; n += 2)
        {
          E[i].re[n] += odd * turn.re[n];
          E[i].im[n] += odd * turn.im[n];
          E[i].re[n + 1] += even * turn.re[n + 1];
          E[i].im[n + 1] += even * turn.im[n + 1];
        }
      }
    }
    if (largest <= nothing || swing > most_swing * largest || squares - 2. * power(E) > most_unresolved * squares)
      return std::nullopt;

    // Half as many pieces take half the time. What finds more than half of all e is the largest, since waves of other
    // numbers are orthogonal: so near the phase from piece to piece, else among all. If pairs of pieces find nearly all
    // they see as much as the whole.
    constexpr double half_of_all = 0.5, nearly_all = 0.9;
    std::vector<Complex> pairs(n_s / 2);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      for (unsigned int n = 0; n < n_harmonics; ++n)
      {
        pairs[i].re[n] = E[2 * i].re[n] + E[2 * i + 1].re[n];
        pairs[i].im[n] = E[2 * i].im[n] + E[2 * i + 1].im[n];
      }
    const double of_pairs = static_cast<double>(pairs.size()) * power(pairs) / (static_cast<double>(n_s) * power(E));
    Beam beam(pairs);
    double nu    = beam.best(from_phases(pairs));
    double found = beam.at(nu).S * of_pairs;
    if (found < half_of_all)
    {
      nu    = search(pairs);
      found = beam.at(nu).S * of_pairs;
      if (found < half_of_all)
        nu = search(E);
    }
    if (found < nearly_all)
      beam = Beam(std::move(E));
    nu = beam.best(nu);
    return StretchWave{length / (period * nu), std::max(beam.at(nu).S - beam.at(-nu).S, 0.)};
  }
} // namespace crawler
