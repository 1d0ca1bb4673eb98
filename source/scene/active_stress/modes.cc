// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/modes.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crawler
{
  namespace
  {
    using std::numbers::pi;

    /// Fourier modes 1, sin x, cos x, sin 2x, ... at x = 2 pi @p turns.
    void
    fourier(const double turns, std::vector<double> &phi)
    {
      const double x = 2. * pi * (turns - std::floor(turns));
      phi[0]         = 1.;
      for (std::size_t k = 1; 2 * k < phi.size(); ++k)
      {
        const double angle = static_cast<double>(k) * x;
        phi[2 * k - 1]     = std::sin(angle);
        phi[2 * k]         = std::cos(angle);
      }
    }

    /// Replaces the Fourier modes @p phi by their derivatives by x.
    void
    differentiate_fourier(std::vector<double> &phi)
    {
      phi[0] = 0.;
      for (std::size_t k = 1; 2 * k < phi.size(); ++k)
      {
        const double sine = phi[2 * k - 1], n = static_cast<double>(k);
        phi[2 * k - 1] = n * phi[2 * k];
        phi[2 * k]     = -n * sine;
      }
    }

    /// The n + 3 cubic B-splines on @p n cells of [0, 1], with all knots beyond the ends at the ends, or their
    /// derivatives (de Boor).
    void
    splines(const double x, const unsigned int n, const bool rate, std::vector<double> &psi)
    {
      const auto knot = [&](const int i) { return std::clamp((i - 3.) / n, 0., 1.); };
      const int cell  = std::clamp(static_cast<int>(x * n), 0, static_cast<int>(n) - 1);
      std::ranges::fill(psi, 0.);
      double basis[4] = {1., 0., 0., 0.}; // of the splines cell ... cell + 3
      for (int degree = 1; degree <= 3; ++degree)
      {
        const bool is_last = rate && degree == 3; // N' = 3 ( N_i/(t_(i+3)-t_i) - N_(i+1)/(t_(i+4)-t_(i+1)) )
        double before      = 0.;
        for (int i = 0; i < degree; ++i)
        {
          const double right = knot(cell + 4 + i), left = knot(cell + 4 + i - degree);
          const double share = basis[i] / (right - left);
          basis[i]           = before + (is_last ? -3. : right - x) * share;
          before             = (is_last ? 3. : x - left) * share;
        }
        basis[degree] = before;
      }
      for (int i = 0; i < 4; ++i)
        psi[static_cast<std::size_t>(cell + i)] = basis[i];
    }
  } // namespace

  void
  ModesParameters::add_parameters(Declarations &declarations)
  {
    declarations.whole_number("Harmonics", harmonics, 0, 64)
      .means(
        "Number N of harmonics along the body. The modes there are 1, sin x, cos x, ..., sin Nx, cos Nx with x = 2 "
        "pi s/L.");
    declarations.choice("In time", in_time, {"travelling", "harmonics", "splines"})
      .means("How the modes change in time: as a wave that travels without changing its shape, by Fourier modes of a "
             "period, or by cubic B-splines over the whole duration.");
    declarations.number("Wave speed", wave_speed, any_number(), "length/time")
      .means("Speed c of a travelling wave m(s + ct); a positive one runs from s = L to s = 0.");
    declarations.number("Period", period, positive(), "time").means("Period P of the harmonics in time.");
    declarations.whole_number("Time harmonics", time_harmonics, 1, 64)
      .means("Number M of harmonics in time: 1, sin y, cos y, ..., cos My with y = 2 pi t/P.");
    declarations.whole_number("Time cells", time_cells, 1, 1000)
      .means("Number of equal parts of the duration for the splines; there are three more splines than parts.");
    declarations.flag("From rest", from_rest)
      .means("Whether the value of the modes at t = 0 is subtracted; of the splines, the first, the only one that is "
             "not 0 there, is left out. The nonlinear model needs this for a prescribed strain.");
    declarations.numbers("Coefficients", coefficients, "force")
      .means("Coefficients of the modes: for a travelling wave, of all modes along the body; otherwise of those with "
             "the first function of time, then with the second, and so on. Missing ones are 0. Where numbers of the "
             "scene are named, as in Optimize/Variables, Coefficients[2] is the second of them.");
  }

  Modes::Modes(const ModesParameters &parameters, const double length, const double end_time)
    : parameters_(parameters)
    , length_(length)
    , end_time_(end_time)
    , n_space_(2 * parameters.harmonics + 1)
    , c_(parameters.coefficients)
  {
    const std::size_t n_splines = parameters.time_cells + 3;
    if (parameters.in_time == "harmonics")
      n_time_ = 2 * parameters.time_harmonics + 1;
    else if (parameters.in_time == "splines")
      n_time_ = n_splines - (parameters.from_rest ? 1 : 0);
    if (c_.size() > n_space_ * n_time_)
      refuse("Active stress/Modes/Coefficients",
             "there are {} coefficients, but at most {} are expected: one for each of {} modes "
             "along the body{}",
             c_.size(),
             n_space_ * n_time_,
             n_space_,
             n_time_ > 1 ? fmt::format(" and {} functions of time", n_time_) : "");
    c_.resize(n_space_ * n_time_);
    if (parameters.in_time == "travelling" && parameters.wave_speed != 0.)
      facts_.repetition = {length / std::abs(parameters.wave_speed), 0.};
    else if (parameters.in_time == "harmonics")
      facts_.repetition = {parameters.period, 0.};
    else if (parameters.in_time == "splines")
      for (unsigned int i = 1; i < parameters.time_cells; ++i)
        facts_.breaks_in_time.push_back(end_time * i / parameters.time_cells);
    std::vector<double> start(n_space_);
    if (parameters.from_rest)
      amplitudes(0., false, start);
    at_rest_ = start;
  }

  void
  Modes::time_functions(const double t, const bool rate, std::vector<double> &psi) const
  {
    if (parameters_.in_time == "harmonics")
    {
      fourier(t / parameters_.period, psi);
      if (rate)
        differentiate_fourier(psi);
      for (double &one : psi)
        one *= rate ? 2. * pi / parameters_.period : 1.;
      return;
    }
    const bool leaves_out = parameters_.from_rest;
    std::vector<double> all(n_time_ + (leaves_out ? 1 : 0));
    splines(std::clamp(t / end_time_, 0., 1.), parameters_.time_cells, rate, all);
    std::copy(all.begin() + (leaves_out ? 1 : 0), all.end(), psi.begin());
    for (double &one : psi)
      one *= rate ? 1. / end_time_ : 1.;
  }

  void
  Modes::amplitudes(const double t, const bool rate, std::vector<double> &amplitudes) const
  {
    std::vector<double> psi(std::max(n_time_, n_space_));
    if (parameters_.in_time != "travelling")
    {
      psi.resize(n_time_);
      time_functions(t, rate, psi);
      for (std::size_t k = 0; k < n_space_; ++k)
      {
        amplitudes[k] = 0.;
        for (std::size_t j = 0; j < n_time_; ++j)
          amplitudes[k] += c_[j * n_space_ + k] * psi[j];
      }
      return;
    }
    // sin n(x + y) = sin nx cos ny + cos nx sin ny
    const double c = parameters_.wave_speed;
    fourier(c * t / length_, psi);
    const double turn = rate ? 2. * pi * c / length_ : 1.;
    if (rate)
      differentiate_fourier(psi);
    amplitudes[0] = c_[0] * turn * psi[0];
    for (std::size_t k = 1; 2 * k < n_space_; ++k)
    {
      const double sine = turn * psi[2 * k - 1], cosine = turn * psi[2 * k];
      amplitudes[2 * k - 1] = c_[2 * k - 1] * cosine - c_[2 * k] * sine;
      amplitudes[2 * k]     = c_[2 * k - 1] * sine + c_[2 * k] * cosine;
    }
  }

  std::unique_ptr<ActiveStressAtPoints>
  Modes::evaluator(const std::vector<double> &points, const bool rate) const
  {
    std::vector<double> phi, at_point(n_space_); // [point][mode]
    for (const double s : points)
    {
      fourier(s / length_, at_point);
      phi.insert(phi.end(), at_point.begin(), at_point.end());
    }
    return stress_at_points(
      [this, rate, phi, a = std::vector<double>(n_space_)](const double t, const std::span<double> m) mutable {
        amplitudes(t, rate, a);
        if (!rate)
          for (std::size_t k = 0; k < n_space_; ++k)
            a[k] -= at_rest_[k];
        for (std::size_t i = 0; i < m.size(); ++i)
        {
          double sum = 0.;
          for (std::size_t k = 0; k < n_space_; ++k)
            sum += a[k] * phi[i * n_space_ + k];
          m[i] = sum;
        }
      });
  }
} // namespace crawler
