// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/gauss_panels.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/active_stress/shaped_wave.h>
#include <crawler/scene/period.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string section = "Active stress/Optimal wave/";

    /// Panels of the polynomials through a formula are at most this part of the body long.
    constexpr double longest_panel = 1. / 16.;
    /// More body lengths would take more memory than such a run is worth.
    constexpr double most_lengths = 1e4;
    /// The leading order is reported for so many strides at most.
    constexpr double most_reported = 100.;

    class AtPoints : public ActiveStressAtPoints
    {
    public:
      AtPoints(const ShapedWave::Settings &wave, const std::vector<double> &points)
        : wave_(wave)
        , points_(points)
        , x_(points.size())
        , V_(points.size())
        , F_(points.size())
      {
        std::size_t panel = 0;
        for (const double s : points)
          start_.push_back(wave.shape.value(s, panel));
      }

      void
      values(const double t, const std::span<double> m) override
      {
        const double ct = wave_.speed * t, L = wave_.body.length;
        const double friction = wave_.chi * wave_.body.friction_coefficient;
        const double elastic  = wave_.chi * wave_.body.elastic_modulus / wave_.speed;
        const double tail = wave_.shape.integral(ct, panel_), head = wave_.shape.integral(L + ct, panel_);
        const double mean = (head - tail) / L;
        for (std::size_t i = 0; i < m.size(); ++i)
          x_[i] = points_[i] + ct;
        wave_.shape.values_and_integrals(x_, panel_, V_, F_);
        for (std::size_t i = 0; i < m.size(); ++i)
          m[i] = friction * (F_[i] - tail - points_[i] * mean) - elastic * (V_[i] - start_[i]);
      }

    private:
      const ShapedWave::Settings &wave_;
      const std::vector<double> points_;
      std::vector<double> start_;     ///< V(s)
      std::vector<double> x_, V_, F_; ///< at one time: x = s + ct, V(x) and its integral
      std::size_t panel_ = 0;
    };

    /// m_t = chi [ gamma c ( V(s+ct) - V(ct) - (s/L) ( V(L+ct) - V(ct) ) ) - k V'(s+ct) ]
    class RateAtPoints : public ActiveStressAtPoints
    {
    public:
      RateAtPoints(const ShapedWave::Settings &wave, const std::vector<double> &points)
        : wave_(wave)
        , points_(points)
      {
      }

      void
      values(const double t, const std::span<double> rate) override
      {
        const double ct = wave_.speed * t, L = wave_.body.length;
        const double friction = wave_.chi * wave_.body.friction_coefficient * wave_.speed;
        const double elastic  = wave_.chi * wave_.body.elastic_modulus;
        const double tail = wave_.shape.value(ct, panel_), head = wave_.shape.value(L + ct, panel_);
        for (std::size_t i = 0; i < rate.size(); ++i)
        {
          const double x = points_[i] + ct;
          rate[i]        = friction * (wave_.shape.value(x, panel_) - tail - points_[i] / L * (head - tail)) -
                    elastic * wave_.shape.derivative(x, panel_);
        }
      }

    private:
      const ShapedWave::Settings &wave_;
      const std::vector<double> points_;
      std::size_t panel_ = 0;
    };

    ShapeFunction
    shape_from_formula(const OptimalWaveParameters &parameters,
                       const double length,
                       const double end_time,
                       const double from,
                       const double to)
    {
      const std::string entry = section + "Shape formula";
      const auto formula      = read_formula({.quantity        = "shape",
                                              .formula         = parameters.shape_formula,
                                              .constants       = parameters.shape_constants,
                                              .formula_entry   = entry,
                                              .constants_entry = section + "Shape constants",
                                              .variables       = {"x", "t"}},
                                        length,
                                        end_time);
      if (formula->uses(1))
        throw InputError(fmt::format("the shape \"{}\" depends on t; a formula of x is expected, since the wave only "
                                     "moves it",
                                     parameters.shape_formula),
                         entry);
      return ShapeFunction(
        [&](const std::span<const double> x, const std::span<double> values) {
          FormulaAtPoints(formula, {x.begin(), x.end()}).values(0., values);
        },
        from,
        to,
        longest_panel * length,
        entry);
    }

    ShapeFunction
    shape_from_table(const std::string &name, const double from, const double to)
    {
      const std::string entry = section + "Shape file";
      const CsvNumbers numbers =
        read_csv_numbers(name, {"x", "f"}, "the name of a CSV file with the header x,f", entry);
      const std::vector<double> &x = numbers.columns[0], &f = numbers.columns[1];
      for (std::size_t i = 1; i < x.size(); ++i)
        if (x[i] <= x[i - 1])
          throw InputError(fmt::format("row {} of \"{}\" has x = {:g} after x = {:g}, but increasing x are expected",
                                       numbers.rows[i],
                                       name,
                                       x[i],
                                       x[i - 1]),
                           entry);
      if (x.size() < 4)
        throw InputError(
          fmt::format("\"{}\" has {} rows after the header, but at least 4 are expected", name, x.size()), entry);
      const double round_off = 1e-12 * (to - from);
      if (x.front() > from + round_off || x.back() < to - round_off)
        throw InputError(
          fmt::format("\"{}\" has x from {:g} to {:g}, but the whole range from {:g} to {:g} is expected, "
                      "which comes to the body until the end time",
                      name,
                      x.front(),
                      x.back(),
                      from,
                      to),
          entry);
      return ShapeFunction(x, f);
    }

    ShapedWave::Settings
    settings_of(const OptimalWaveParameters &parameters, const Body &body, const double end_time)
    {
      if (parameters.choose_wave_by == "energy")
        throw InputError(
          fmt::format("the wave is chosen by energy, but with Shape = {} only wave speed is expected: the "
                      "waves of one energy are known for Fourier coefficients only",
                      parameters.shape),
          section + "Choose wave by");
      const double c = parameters.wave_speed, way = c * end_time;
      if (c == 0.)
        throw InputError("the wave speed is 0, but a number that is not 0 is expected", section + "Wave speed");
      if (!(std::abs(way) <= most_lengths * body.length))
        throw InputError(fmt::format("the wave runs {:.3g} body lengths until the end time, but at most {:g} are "
                                     "expected with Shape = {}",
                                     std::abs(way) / body.length,
                                     most_lengths,
                                     parameters.shape),
                         section + "Wave speed");
      const double from = std::min(0., way), to = body.length + std::max(0., way);
      return {body,
              parameters.perturbation_parameter,
              c,
              parameters.shape == "table" ? shape_from_table(parameters.shape_file, from, to)
                                          : shape_from_formula(parameters, body.length, end_time, from, to)};
    }
  } // namespace


  ShapedWave::ShapedWave(const OptimalWaveParameters &parameters, const Body &body, const double end_time)
    : end_time_(end_time)
    , shape_(parameters.shape)
    , settings_(settings_of(parameters, body, end_time))
  {
  }

  std::unique_ptr<ActiveStressAtPoints>
  ShapedWave::at(const std::vector<double> &points) const
  {
    return std::make_unique<AtPoints>(settings_, points);
  }

  std::unique_ptr<ActiveStressAtPoints>
  ShapedWave::rate_at(const std::vector<double> &points) const
  {
    return std::make_unique<RateAtPoints>(settings_, points);
  }

  std::optional<double>
  ShapedWave::period() const
  {
    if (!period_)
      period_ = find_period(*this, settings_.body.length, end_time_);
    return *period_;
  }

  std::vector<double>
  ShapedWave::breaks_in_space() const
  {
    std::vector<double> places;
    for (const double x : settings_.shape.kinks())
      if (x > 0. && x < settings_.body.length)
        places.push_back(x);
    return places;
  }

  ShapedWave::LeadingOrder
  ShapedWave::leading_order() const
  {
    const Body &body = settings_.body;
    const double c = settings_.speed, L = body.length, chi = settings_.chi;
    const double strides = std::abs(c) * end_time_ / L;
    const GaussPanels in_s(0., L, 16),
      in_t(0., end_time_, static_cast<unsigned int>(std::ceil(16. * std::clamp(strides, 1., 1e6))));
    std::vector<double> start;
    std::size_t panel = 0;
    for (const double s : in_s.points())
      start.push_back(settings_.shape.value(s, panel));
    LeadingOrder result{0., 0., 1., 1.};
    double e_e         = 0.; // int e'^2 ds
    const auto at_time = [&](const double t, double &e_v, double &v_v) {
      const double mean = (settings_.shape.integral(L + c * t, panel) - settings_.shape.integral(c * t, panel)) / L;
      e_v = v_v = e_e = 0.;
      for (std::size_t i = 0; i < start.size(); ++i)
      {
        const double V = settings_.shape.value(in_s.points()[i] + c * t, panel), e = V - start[i], v = V - mean;
        e_v += in_s.weights()[i] * e * v;
        v_v += in_s.weights()[i] * v * v;
        e_e += in_s.weights()[i] * e * e;
        result.min_stretch = std::min(result.min_stretch, 1. + chi / c * e);
        result.max_stretch = std::max(result.max_stretch, 1. + chi / c * e);
      }
    };
    double e_v, v_v;
    for (std::size_t j = 0; j < in_t.points().size(); ++j)
    {
      at_time(in_t.points()[j], e_v, v_v);
      result.displacement -= in_t.weights()[j] * body.friction_exponent() * chi * chi / (c * L) * e_v;
      result.energy += in_t.weights()[j] * body.friction_coefficient * chi * chi * v_v;
    }
    at_time(end_time_, e_v, v_v);
    result.energy += 0.5 * body.elastic_modulus * chi / c * chi / c * e_e;
    return result;
  }

  void
  ShapedWave::report(std::ostream &out) const
  {
    const Body &body = settings_.body;
    out << fmt::format("Optimal wave: speed c = {:.10g}, multiplier alpha = {:.10g}, shape by {}",
                       settings_.speed,
                       body.friction_exponent() / (body.length * body.friction_coefficient * settings_.speed),
                       shape_);
    if (std::abs(settings_.speed) * end_time_ <= most_reported * body.length)
    {
      const LeadingOrder order = leading_order();
      out << fmt::format(", leading-order displacement {:.8g}, energy {:.8g}, stretch {:.4g} to {:.4g}{}",
                         order.displacement,
                         order.energy,
                         order.min_stretch,
                         order.max_stretch,
                         order.min_stretch > 0. ? "" : " (NOT admissible: the body would invert)");
    }
    out << '\n';
  }

  std::unique_ptr<ActiveStress>
  create_optimal_wave(const OptimalWaveParameters &parameters, const Body &body, const double end_time)
  {
    if (parameters.shape == "Fourier")
      return std::make_unique<OptimalWave>(parameters, body, end_time);
    return std::make_unique<ShapedWave>(parameters, body, end_time);
  }
} // namespace crawler
