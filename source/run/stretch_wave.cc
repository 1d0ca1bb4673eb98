// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/stretch_wave.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

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
    /// Harmonics of all pieces.
    using Pieces = std::vector<Complex>;

    double
    square(const double x)
    {
      return x * x;
    }

    /// Number of waves by the mean phase of the fundamental from piece to piece.
    double
    from_phases(const Pieces &E)
    {
      double re = 0., im = 0.;
      for (std::size_t i = 0; i + 1 < E.size(); ++i)
      {
        re += E[i].re[0] * E[i + 1].re[0] + E[i].im[0] * E[i + 1].im[0];
        im += E[i].re[0] * E[i + 1].im[0] - E[i].im[0] * E[i + 1].re[0];
      }
      return -std::atan2(im, re) / (2. * std::numbers::pi) * static_cast<double>(E.size());
    }

    /// Power sum_n sum_i |E_n|^2
    double
    power(const Pieces &E)
    {
      double sum = 0.;
      for (const Complex &one : E)
        for (unsigned int n = 0; n < n_harmonics; ++n)
          sum += square(one.re[n]) + square(one.im[n]);
      return sum;
    }

    /// S and its derivatives.
    struct Value
    {
      double S = 0., slope = 0., curvature = 0.;
    };

    /// Function S of the number of waves of the fundamental on the body, nu = q L/P.
    Value
    at(const Pieces &E, const double nu)
    {
      const auto n_pieces = static_cast<double>(E.size());
      const double middle = 0.5 * (n_pieces - 1.);
      Complex step, turn, f, f_s, f_ss; // integrals of E_n e^(i n w q s), with powers of s in pieces, from the middle
      for (unsigned int n = 0; n < n_harmonics; ++n)
      {
        const double angle = 2. * std::numbers::pi * (n + 1.) * nu / n_pieces;
        step.re[n]         = std::cos(angle);
        step.im[n]         = std::sin(angle);
        turn.re[n]         = std::cos(angle * middle);
        turn.im[n]         = -std::sin(angle * middle);
      }
      for (std::size_t i = 0; i < E.size(); ++i)
      {
        const double s = static_cast<double>(i) - middle;
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          const double c = turn.re[n], d = turn.im[n];
          const double x = E[i].re[n] * c - E[i].im[n] * d, y = E[i].re[n] * d + E[i].im[n] * c;
          f.re[n] += x;
          f.im[n] += y;
          f_s.re[n] += s * x;
          f_s.im[n] += s * y;
          f_ss.re[n] += s * s * x;
          f_ss.im[n] += s * s * y;
          turn.re[n] = c * step.re[n] - d * step.im[n];
          turn.im[n] = c * step.im[n] + d * step.re[n];
        }
      }
      const double all = n_pieces * power(E);
      Value value;
      for (unsigned int n = 0; n < n_harmonics; ++n)
      {
        const double k = 2. * std::numbers::pi * (n + 1.) / n_pieces, a = f.re[n], b = f.im[n];
        value.S += (square(a) + square(b)) / all;
        value.slope += 2. * k * (b * f_s.re[n] - a * f_s.im[n]) / all;
        value.curvature += 2. * k * k * (square(f_s.re[n]) + square(f_s.im[n]) - a * f_ss.re[n] - b * f_ss.im[n]) / all;
      }
      return value;
    }

    /// Number of waves of the largest S, to a sixteenth, among those that the pieces distinguish: each harmonic gives
    /// |int E_n e^(iks) ds|^2 as a table over k.
    double
    search(const Pieces &E)
    {
      constexpr int finer = search_steps_per_wave / steps_per_wave;
      const int half      = static_cast<int>(steps_per_wave * E.size()) / 2;
      std::vector<Harmonics> power;
      for (int j = -half; j <= half; ++j)
      {
        const auto step = std::polar(1., std::numbers::pi * j / half);
        std::complex<double> turn(1.);
        Complex f;
        for (const Complex &piece : E)
        {
          for (unsigned int n = 0; n < n_harmonics; ++n)
          {
            f.re[n] += piece.re[n] * turn.real() - piece.im[n] * turn.imag();
            f.im[n] += piece.re[n] * turn.imag() + piece.im[n] * turn.real();
          }
          turn *= step;
        }
        auto &here = power.emplace_back();
        for (unsigned int n = 0; n < n_harmonics; ++n)
          here[n] = square(f.re[n]) + square(f.im[n]);
      }
      double largest = -1., best = 0.;
      for (int j = -finer * half; j <= finer * half; ++j)
      {
        double S = 0.;
        for (int n = 1; n <= static_cast<int>(n_harmonics) && n * std::abs(j) < finer * half; ++n)
        {
          const int place = finer * half + n * j, m = place / finer;
          const double part = static_cast<double>(place % finer) / finer;
          S += (1. - part) * power[m][n - 1] + part * power[m + 1][n - 1];
        }
        if (S > largest)
        {
          largest = S;
          best    = static_cast<double>(j) / search_steps_per_wave;
        }
      }
      return best;
    }

    struct Peak
    {
      double nu, S;
    };
    /// Largest S near @p nu, its number of waves to round-off.
    Peak
    best(const Pieces &E, double nu)
    {
      constexpr unsigned int max_corrections = 30;
      constexpr double most = 0.5 / search_steps_per_wave, last = 1e-7;
      // Newton's method for a slope of 0, which goes uphill where S is not concave. Digits double, so that this last
      // correction leaves round-off.
      double S = 0.;
      for (unsigned int i = 0; i < max_corrections; ++i)
      {
        const Value here = at(E, nu);
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
    largest_wave(const Pieces &E, const std::size_t n_s)
    {
      // Pairs of pieces take half the time. A wave with more than half of all e is the largest, since waves of other
      // numbers are orthogonal: so the search is near the phase from piece to piece, else among all. If pairs of pieces
      // find nearly all they see as much as the whole.
      constexpr double half_of_all = 0.5, nearly_all = 0.9;
      Pieces pairs(n_s / 2);
      for (std::size_t i = 0; i < pairs.size(); ++i)
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          pairs[i].re[n] = E[2 * i].re[n] + E[2 * i + 1].re[n];
          pairs[i].im[n] = E[2 * i].im[n] + E[2 * i + 1].im[n];
        }
      const double of_pairs = 0.5 * power(pairs) / power(E);
      Peak peak             = best(pairs, from_phases(pairs));
      bool is_best          = true;
      double found          = peak.S * of_pairs;
      if (found < half_of_all)
      {
        peak.nu = search(pairs);
        found   = at(pairs, peak.nu).S * of_pairs;
        is_best = false;
        if (found < half_of_all)
          peak.nu = search(E);
      }
      const Pieces &seen = found < nearly_all ? E : pairs;
      if (!is_best || found < nearly_all)
        peak = best(seen, peak.nu);
      return {peak.nu, peak.S, at(seen, -peak.nu).S};
    }
  } // namespace

  std::optional<StretchWave>
  measure_wave(const std::vector<std::vector<double>> &stretch, const double period, const double swing)
  {
    const std::size_t n_t = stretch.size(), n_s = stretch.front().size();
    const auto per_phase = 1. / static_cast<double>(n_t);
    std::vector<double> mean(n_s, 0.);
    for (const auto &w : stretch)
      for (std::size_t i = 0; i < n_s; ++i)
        mean[i] += per_phase * w[i];
    Pieces E(n_s);
    double largest = 0., squares = 0.;
    const std::size_t half = n_t / 2;
    for (std::size_t j = 0; j < half; ++j)
    {
      Complex turn;
      for (std::size_t n = 0; n < n_harmonics; ++n)
      {
        const double angle = 2. * std::numbers::pi * static_cast<double>((n + 1) * j % n_t) / static_cast<double>(n_t);
        turn.re[n]         = per_phase * std::cos(angle);
        turn.im[n]         = -per_phase * std::sin(angle);
      }
      for (std::size_t i = 0; i < n_s; ++i)
      {
        const double e = stretch[j][i] - mean[i], later = stretch[j + half][i] - mean[i];
        largest = std::max({largest, std::abs(e), std::abs(later)});
        squares += per_phase * (e * e + later * later);
        // Odd harmonics have the other sign half a period later.
        for (unsigned int n = 0; n < n_harmonics; ++n)
        {
          const double x = n % 2 == 0 ? e - later : e + later;
          E[i].re[n] += x * turn.re[n];
          E[i].im[n] += x * turn.im[n];
        }
      }
    }
    if (largest <= nothing || swing > max_swing * largest || squares - 2. * power(E) > max_unresolved * squares)
      return std::nullopt;
    const Largest wave = largest_wave(E, n_s);
    return StretchWave{1. / (period * wave.nu), std::max(wave.S - wave.opposite, 0.)};
  }
} // namespace crawler
