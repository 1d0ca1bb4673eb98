// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/gauss_panels.h>
#include <crawler/base/told_apart.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/active_stress/shaped_wave.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/period.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string shaped_wave_section = "Active stress/Optimal wave/";

    /// Longest panel of the polynomials through a formula, relative to the body.
    constexpr double longest_panel = 1. / 16.;
    /// Largest number of body lengths; more would take too much memory.
    constexpr double max_lengths = 1e4;
    /// Largest number of strides for which the leading order is reported.
    constexpr double max_reported = 100.;

    /// The points, then both ends of the body.
    std::vector<double>
    with_ends(std::vector<double> points, const double length)
    {
      points.insert(points.end(), {0., length});
      return points;
    }

    ShapeFunction
    shape_from_formula(const OptimalWaveParameters &parameters,
                       const double length,
                       const double end_time,
                       const double from,
                       const double to)
    {
      const std::string entry = shaped_wave_section + "Shape formula";
      const auto formula      = read_formula({.quantity        = "shape",
                                              .formula         = parameters.shape_formula,
                                              .constants       = parameters.shape_constants,
                                              .formula_entry   = entry,
                                              .constants_entry = shaped_wave_section + "Shape constants",
                                              .variables       = {"x", "t"}},
                                        length,
                                        end_time);
      if (formula->uses(1))
        refuse(entry,
               "the shape \"{}\" depends on t; a formula of x is expected, since the wave only "
               "moves it",
               parameters.shape_formula);
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
      const std::string entry = shaped_wave_section + "Shape file";
      CsvNumbers numbers      = read_csv_numbers(name, {"x", "f"}, "the name of a CSV file with the header x,f", entry);
      std::vector<double> &x  = numbers.columns[0];
      const std::vector<double> &f = numbers.columns[1];
      for (std::size_t i = 1; i < x.size(); ++i)
        if (x[i] <= x[i - 1])
          refuse(entry,
                 "row {} of \"{}\" has x = {:g} after x = {:g}, but increasing x are expected",
                 numbers.rows[i],
                 name,
                 x[i],
                 x[i - 1]);
      if (x.size() < 4)
        refuse(entry, "\"{}\" has {} rows after the header, but at least 4 are expected", name, x.size());
      const double most = 1e-6 * (to - from);
      if (x.front() > from + most || x.back() < to - most)
        refuse(entry,
               "\"{}\" has x from {} to {}, but the whole range from {} to {} is expected, which "
               "reaches the body before the end time",
               name,
               told_apart(x.front(), {from}),
               told_apart(x.back(), {to}),
               told_apart(from, {x.front()}),
               told_apart(to, {x.back()}));
      x.front() = std::min(x.front(), from);
      x.back()  = std::max(x.back(), to);
      return ShapeFunction(x, f);
    }

    ShapeFunction
    shape_of(const OptimalWaveParameters &parameters, const Body &body, const double end_time)
    {
      if (parameters.choose_wave_by == "energy")
        refuse(shaped_wave_section + "Choose wave by",
               "the wave is chosen by energy, but with Shape = {} only wave speed is expected: the "
               "waves of one energy are known for Fourier coefficients only",
               parameters.shape);
      const double c = parameters.wave_speed, way = c * end_time;
      if (c == 0.)
        throw InputError("the wave speed is 0, but a number that is not 0 is expected",
                         shaped_wave_section + "Wave speed");
      if (!(std::abs(way) <= max_lengths * body.length))
        refuse(shaped_wave_section + "Wave speed",
               "the wave runs {:.3g} body lengths until the end time, but at most {:g} are "
               "expected with Shape = {}",
               std::abs(way) / body.length,
               max_lengths,
               parameters.shape);
      const double from = std::min(0., way), to = body.length + std::max(0., way);
      return parameters.shape == "table" ? shape_from_table(parameters.shape_file, from, to)
                                         : shape_from_formula(parameters, body.length, end_time, from, to);
    }
  } // namespace

  ShapedWave::ShapedWave(const OptimalWaveParameters &parameters, const Body &body, const double end_time)
    : end_time_(end_time)
    , shape_name_(parameters.shape)
    , body_(body)
    , chi_(parameters.perturbation_parameter)
    , speed_(parameters.wave_speed)
    , shape_(shape_of(parameters, body, end_time))
  {
    facts_.search          = [=, this]() { return find_repetition(*this, body_.length, end_time); };
    facts_.breaks_in_space = within(shape_.kinks(), body.length); // kinks at the start, V(s)
  }

  /// Evaluates m, or m_t = chi [ gamma c ( V(s+ct) - V(ct) - (s/L) ( V(L+ct) - V(ct) ) ) - k V'(s+ct) ].
  std::unique_ptr<ActiveStressAtPoints>
  ShapedWave::evaluator(const std::vector<double> &points, const bool rate) const
  {
    std::vector<double> places = with_ends(points, body_.length), V(places.size()),
                        F      = V; // V and its integral at one time
    std::size_t panel          = 0;
    shape_.values_and_integrals(places, panel, V, F);
    return stress_at_points([=, this, start = V, x = places](const double t, const std::span<double> m) mutable {
      const double ct = speed_ * t, L = body_.length;
      const double friction = chi_ * body_.friction_coefficient, elastic = chi_ * body_.elastic_modulus;
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = places[i] + ct;
      shape_.values_and_integrals(x, panel, V, F);
      const std::size_t n = m.size(); // then both ends of the body
      if (rate)
        for (std::size_t i = 0; i < n; ++i)
          m[i] = friction * speed_ * (V[i] - V[n] - places[i] / L * (V[n + 1] - V[n])) -
                 elastic * shape_.derivative(x[i], panel);
      else
        for (std::size_t i = 0; i < n; ++i)
          m[i] = friction * (F[i] - F[n] - places[i] * ((F[n + 1] - F[n]) / L)) - elastic / speed_ * (V[i] - start[i]);
    });
  }

  ShapedWave::LeadingOrder
  ShapedWave::leading_order() const
  {
    const Body &body = body_;
    const double c = speed_, L = body.length, chi = chi_;
    const double strides = std::abs(c) * end_time_ / L;
    const GaussPanels in_s(0., L, 16),
      in_t(0., end_time_, static_cast<unsigned int>(std::ceil(16. * std::clamp(strides, 1., 1e6))));
    const std::vector<double> places = with_ends(in_s.points(), L);
    std::vector<double> start = places, x = places, values = places, integrals = places;
    std::size_t panel = 0;
    shape_.values_and_integrals(places, panel, start, integrals);
    LeadingOrder result{0., 0., 1., 1.};
    double e_e         = 0.; // int e'^2 ds
    const auto at_time = [&](const double t, double &e_v, double &v_v) {
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = places[i] + c * t;
      shape_.values_and_integrals(x, panel, values, integrals);
      const std::size_t n = in_s.points().size();
      const double mean   = (integrals[n + 1] - integrals[n]) / L;
      e_v = v_v = e_e = 0.;
      for (std::size_t i = 0; i < n; ++i)
      {
        const double e = values[i] - start[i], v = values[i] - mean;
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
    const Body &body = body_;
    out << fmt::format("Optimal wave: speed c = {:.10g}, multiplier alpha = {:.10g}, shape by {}",
                       speed_,
                       body.friction_exponent() / (body.length * body.friction_coefficient * speed_),
                       shape_name_);
    if (std::abs(speed_) * end_time_ <= max_reported * body.length)
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
} // namespace crawler
