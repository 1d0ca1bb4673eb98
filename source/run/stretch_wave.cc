// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/stretch_wave.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace crawler
{
  namespace
  {
    /// Changes of the strain below this count as zero.
    constexpr double nothing = 1e-12;
    /// Largest part of the mean square of e in unexamined harmonics: a pulse that few samples see has half of it there,
    /// a signal that is on for a tenth of the period a tenth.
    constexpr double max_unresolved = 0.3;
    /// Motion of the extremes of the stretch, over the largest |e|, beyond which the samples, means over pieces of the
    /// body at few times, have not seen its cause: it is at most twice the largest |e| otherwise.
    constexpr double max_swing = 4.;
    /// Resolution of the table of each harmonic, and of the search for the number of waves on the body.
    constexpr unsigned int steps_per_wave = 4, search_steps_per_wave = 16;

    constexpr unsigned int n_harmonics = 8;
    using Harmonics                    = std::array<double, n_harmonics>;
    struct Complex
    {
      Harmonics re{}, im{};
    };

    /// Number of pieces of the body processed side by side; their total is filled up with pieces at rest.
    constexpr std::size_t together = 4;

    /// Harmonics of all pieces.
    class Pieces
    {
    public:
      explicit Pieces(const std::size_t n_pieces)
        : n(n_pieces)
        , filled((n + together - 1) / together * together)
        , numbers_(2 * n_harmonics * filled, 0.)
      {
      }

      /// Real parts [filled] of harmonic @p h.
      double *
      re(const unsigned int h)
      {
        return &numbers_[2 * h * filled];
      }
      const double *
      re(const unsigned int h) const
      {
        return &numbers_[2 * h * filled];
      }
      double *
      im(const unsigned int h)
      {
        return re(h) + filled;
      }
      const double *
      im(const unsigned int h) const
      {
        return re(h) + filled;
      }

      std::size_t n, filled;

    private:
      std::vector<double> numbers_;
    };

    double
    square(const double x)
    {
      return x * x;
    }

    /// Table of cos and sin of 2 pi i/n, i = 0 ... n - 1.
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

    /// Number of waves by the mean phase of the fundamental from piece to piece.
    double
    from_phases(const Pieces &E)
    {
      const double *const x = E.re(0), *const y = E.im(0);
      double re = 0., im = 0.;
      for (std::size_t i = 0; i + 1 < E.n; ++i)
      {
        re += x[i] * x[i + 1] + y[i] * y[i + 1];
        im += x[i] * y[i + 1] - y[i] * x[i + 1];
      }
      return -std::atan2(im, re) / (2. * std::numbers::pi) * static_cast<double>(E.n);
    }

    /// Number of waves of the largest S, to a sixteenth, among those that the pieces distinguish: each harmonic gives
    /// |int E_n e^(iks) ds|^2 as a table over k.
    double
    search(const Pieces &E)
    {
      const std::size_t half = E.n / 2, n_table = steps_per_wave * half + 1;
      // Folding the body about its middle: cosines see the even part, sines the odd one; both directions are one.
      std::vector<Complex> even(half), odd(half);
      std::vector<double> cosines(half, 1.), sines(half, 0.);
      std::vector<std::array<double, 2>> step(half);
      for (std::size_t i = 0; i < half; ++i)
      {
        const std::size_t left = half - 1 - i, right = half + i;
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          even[i].re[n] = E.re(n)[right] + E.re(n)[left];
          even[i].im[n] = E.im(n)[right] + E.im(n)[left];
          odd[i].re[n]  = E.re(n)[right] - E.re(n)[left];
          odd[i].im[n]  = E.im(n)[right] - E.im(n)[left];
        }
        const double angle =
          2. * std::numbers::pi / steps_per_wave * (static_cast<double>(i) + 0.5) / static_cast<double>(E.n);
        step[i] = {{std::cos(angle), std::sin(angle)}};
      }
      std::vector<std::array<Harmonics, 2>> power(n_table); // in both directions
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

    /// Power sum_n sum_i |E_n|^2
    double
    power(const Pieces &E)
    {
      double sum = 0.;
      for (unsigned int n = 0; n < n_harmonics; ++n)
        for (std::size_t i = 0; i < E.n; ++i)
          sum += square(E.re(n)[i]) + square(E.im(n)[i]);
      return sum;
    }

    /// Function S of the number of waves of the fundamental on the body, nu = q L/P.
    class Beam
    {
    public:
      explicit Beam(Pieces E)
        : E_(std::move(E))
        , all_(static_cast<double>(E_.n) * power(E_))
      {
      }

      struct Value
      {
        double S = 0., slope = 0., curvature = 0.;
      };
      Value
      at(double nu) const;

      struct Peak
      {
        double nu, S;
      };
      /// Largest S near @p nu, its number of waves to round-off.
      Peak
      best(double nu) const;

    private:
      Pieces E_;
      double all_;
    };

    Beam::Value
    Beam::at(const double nu) const
    {
      const auto n_pieces    = static_cast<double>(E_.n);
      const double per_piece = 2. * std::numbers::pi * nu / n_pieces, middle = 0.5 * (n_pieces - 1.);
      // Factors e^(i w q s) at all pieces, s from the middle; and their powers.
      const std::size_t filled = E_.filled;
      std::vector<double> s(filled), re(filled), im(filled), turn_re(filled, 1.), turn_im(filled, 0.);
      const double step_re = std::cos(per_piece), step_im = std::sin(per_piece);
      re[0] = std::cos(per_piece * middle);
      im[0] = -std::sin(per_piece * middle);
      for (std::size_t i = 0; i < filled; ++i)
      {
        s[i] = static_cast<double>(i) - middle;
        if (i == 0)
          continue;
        re[i] = re[i - 1] * step_re - im[i - 1] * step_im;
        im[i] = re[i - 1] * step_im + im[i - 1] * step_re;
      }
      Value value;
      for (unsigned int n = 0; n < n_harmonics; ++n)
      {
        // Integrals of E_n e^(i n w q s), with powers of s in pieces.
        std::array<double, together> f_re{}, f_im{}, s_re{}, s_im{}, ss_re{}, ss_im{};
        const double *const E_re = E_.re(n), *const E_im = E_.im(n);
        for (std::size_t first = 0; first < filled; first += together)
          for (std::size_t l = 0; l < together; ++l)
          {
            const std::size_t i = first + l;
            const double c = turn_re[i] * re[i] - turn_im[i] * im[i], d = turn_re[i] * im[i] + turn_im[i] * re[i];
            turn_re[i]     = c;
            turn_im[i]     = d;
            const double x = E_re[i] * c - E_im[i] * d, y = E_re[i] * d + E_im[i] * c;
            const double sx = s[i] * x, sy = s[i] * y;
            f_re[l] += x;
            f_im[l] += y;
            s_re[l] += sx;
            s_im[l] += sy;
            ss_re[l] += s[i] * sx;
            ss_im[l] += s[i] * sy;
          }
        const auto sum = [](const std::array<double, together> &parts) {
          return std::accumulate(parts.begin(), parts.end(), 0.);
        };
        const double k = 2. * std::numbers::pi * (n + 1.) / n_pieces;
        const double a = sum(f_re), b = sum(f_im), a_s = sum(s_re), b_s = sum(s_im);
        value.S += (square(a) + square(b)) / all_;
        value.slope += 2. * k * (b * a_s - a * b_s) / all_;
        value.curvature += 2. * k * k * (square(a_s) + square(b_s) - a * sum(ss_re) - b * sum(ss_im)) / all_;
      }
      return value;
    }

    Beam::Peak
    Beam::best(double nu) const
    {
      constexpr unsigned int max_corrections = 30;
      constexpr double most = 0.5 / search_steps_per_wave, last = 1e-7;
      // Newton's method for a slope of 0, which goes uphill where S is not concave. Digits double, so that this last
      // correction leaves round-off.
      double S = 0.;
      for (unsigned int i = 0; i < max_corrections; ++i)
      {
        const Value here = at(nu);
        const double correction =
          here.curvature < 0. ? std::clamp(-here.slope / here.curvature, -most, most) : std::copysign(most, here.slope);
        nu += correction;
        S = here.S + correction * (here.slope + 0.5 * correction * here.curvature);
        if (std::abs(correction) < last)
          break;
      }
      return {nu, S};
    }

    /// Best number of waves on the body, with its power S and that of the wave which runs the other way.
    struct Largest
    {
      double nu, S, opposite;
    };
    Largest
    largest_wave(Pieces E, const std::size_t n_s)
    {
      // Pairs of pieces take half the time. A wave with more than half of all e is the largest, since waves of other
      // numbers are orthogonal: so the search is near the phase from piece to piece, else among all. If pairs of pieces
      // find nearly all they see as much as the whole.
      constexpr double half_of_all = 0.5, nearly_all = 0.9;
      Pieces pairs(n_s / 2);
      for (unsigned int n = 0; n < n_harmonics; ++n)
        for (std::size_t i = 0; i < pairs.n; ++i)
        {
          pairs.re(n)[i] = E.re(n)[2 * i] + E.re(n)[2 * i + 1];
          pairs.im(n)[i] = E.im(n)[2 * i] + E.im(n)[2 * i + 1];
        }
      const double of_pairs = static_cast<double>(pairs.n) * power(pairs) / (static_cast<double>(n_s) * power(E));
      Beam beam(pairs);
      Beam::Peak peak = beam.best(from_phases(pairs));
      bool is_best    = true;
      double found    = peak.S * of_pairs;
      if (found < half_of_all)
      {
        peak.nu = search(pairs);
        found   = beam.at(peak.nu).S * of_pairs;
        is_best = false;
        if (found < half_of_all)
          peak.nu = search(E);
      }
      if (found < nearly_all)
      {
        beam    = Beam(std::move(E));
        is_best = false;
      }
      if (!is_best)
        peak = beam.best(peak.nu);
      return {peak.nu, peak.S, beam.at(-peak.nu).S};
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
    Pieces E(n_s);
    double largest = 0., squares = 0.;
    // Odd harmonics have the other sign half a period later.
    const std::size_t half = n_t / 2;
    std::vector<double> odd(n_s), even(n_s);
    for (std::size_t j = 0; j < half; ++j)
    {
      for (std::size_t i = 0; i < n_s; ++i)
      {
        const double e = stretch[j][i] - mean[i], later = stretch[j + half][i] - mean[i];
        largest = std::max({largest, std::abs(e), std::abs(later)});
        squares += per_phase * (e * e + later * later);
        odd[i]  = e - later;
        even[i] = e + later;
      }
      for (unsigned int n = 0; n < n_harmonics; ++n)
      {
        const double re = per_phase * turns[(n + 1) * j % n_t][0], im = -per_phase * turns[(n + 1) * j % n_t][1];
        const double *const x = n % 2 == 0 ? odd.data() : even.data();
        double *const E_re = E.re(n), *const E_im = E.im(n);
        for (std::size_t i = 0; i < n_s; ++i)
        {
          E_re[i] += x[i] * re;
          E_im[i] += x[i] * im;
        }
      }
    }
    if (largest <= nothing || swing > max_swing * largest || squares - 2. * power(E) > max_unresolved * squares)
      return std::nullopt;

    const Largest wave = largest_wave(std::move(E), n_s);
    return StretchWave{length / (period * wave.nu), std::max(wave.S - wave.opposite, 0.)};
  }
} // namespace crawler
