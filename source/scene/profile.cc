// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/cubic_spline.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/formula/formula_breaks.h>
#include <crawler/formula/formula_gradient.h>
#include <crawler/parameters/plain_text.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/profile.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace crawler
{
  namespace
  {
    /// Makes a profile with the jumps and kinks in [0, @p length], none if this is 0.
    std::shared_ptr<const Profile>
    formula_profile(const std::shared_ptr<const Formula> &formula, const double length)
    {
      constexpr std::size_t most = 64; // more are no jumps of a material
      auto breaks                = length > 0. ? formula_breaks(formula, length, 0.).in_space : std::nullopt;
      if (!breaks || breaks->size() > most)
        breaks.emplace();
      return std::make_shared<Profile>(
        [gradient = FormulaGradient(formula)](
          const std::span<const double> x, const std::span<double> f, const std::span<double> slope) mutable {
          const std::span<const double> places[] = {x};
          const std::span<double> slopes[]       = {slope};
          gradient.evaluate(places, f, slopes);
        },
        *breaks);
    }

    /// Linear interpolation of samples, or a cubic spline of their logarithms.
    class Interpolation
    {
    public:
      Interpolation(std::vector<double> x, std::vector<double> y, const bool cubic, const bool hold)
        : x_(std::move(x))
        , y_(std::move(y))
        , hold_(hold)
      {
        if (cubic)
        {
          spline_.emplace(x_);
          for (const double value : y_)
            logarithms_.push_back(std::log(value));
          curvatures_ = spline_->curvatures(logarithms_);
        }
      }

      /// Value and derivative.
      std::pair<double, double>
      at(const double x) const
      {
        const double round_off = 1e-12 * (x_.back() - x_.front());
        if (!(x >= x_.front() && x <= x_.back()))
        {
          const bool is_left = x < x_.front();
          if (!hold_ && !(std::abs(x - (is_left ? x_.front() : x_.back())) <= round_off))
            return {NAN, NAN};
          return {is_left ? y_.front() : y_.back(), 0.};
        }
        if (spline_)
        {
          const auto place   = spline_->place(x);
          const double value = std::exp(place.value(logarithms_, curvatures_));
          return {value, value * place.derivative(logarithms_, curvatures_)};
        }
        const auto right   = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end() - 1, x) - x_.begin());
        const double slope = (y_[right] - y_[right - 1]) / (x_[right] - x_[right - 1]);
        return {y_[right - 1] + slope * (x - x_[right - 1]), slope};
      }

    private:
      std::vector<double> x_, y_;
      bool hold_;
      std::optional<CubicSpline> spline_;
      std::vector<double> logarithms_, curvatures_; ///< if there is a spline
    };

    /// Makes a profile of at least as many samples as the interpolation needs; @p what names them in messages.
    std::shared_ptr<const Profile>
    table_profile(std::vector<double> x, std::vector<double> y, const char *what, const ProfileInput &input)
    {
      const bool cubic        = input.interpolation == "cubic";
      const std::size_t least = cubic ? 4 : 2;
      if (x.size() < least)
        refuse(input.formula_entry,
               "\"{}\" has {} {}, but at least {} are expected for {} interpolation",
               input.formula,
               x.size(),
               what,
               least,
               input.interpolation);
      std::vector<double> breaks = x;
      if (cubic && x.size() > max_knots_of_splines)
        breaks = {x.front(), x.back()};
      return std::make_shared<Profile>(
        [table = Interpolation(std::move(x), std::move(y), cubic, input.outside == "hold")](
          const std::span<const double> places, const std::span<double> f, const std::span<double> slope) {
          for (std::size_t i = 0; i < places.size(); ++i)
          {
            const auto [value, derivative] = table.at(places[i]);
            f[i]                           = value;
            if (!slope.empty())
              slope[i] = derivative;
          }
        },
        std::move(breaks));
    }

    std::shared_ptr<const Profile>
    read_table(const ProfileInput &input)
    {
      const std::string &variable = input.variables.front();
      CsvNumbers numbers =
        read_csv_numbers(input.formula,
                         {variable, "value"},
                         fmt::format("a formula of {0}, or the name of a CSV file with the header {0},value", variable),
                         input.formula_entry);
      std::vector<double> &x = numbers.columns[0], &y = numbers.columns[1];
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        if (!(y[i] > 0.))
          refuse(input.formula_entry,
                 "row {} of \"{}\" has the value {:g}, but a positive number is expected",
                 numbers.rows[i],
                 input.formula,
                 y[i]);
        if (i > 0 && !(x[i] > x[i - 1]))
          refuse(input.formula_entry,
                 "row {} of \"{}\" has {} = {:g} after {:g}, but increasing numbers are expected",
                 numbers.rows[i],
                 input.formula,
                 variable,
                 x[i],
                 x[i - 1]);
      }
      return table_profile(std::move(x), std::move(y), "rows of numbers", input);
    }

    /// Makes a profile of values at places equally spaced from tail to head.
    std::shared_ptr<const Profile>
    list_profile(const std::vector<double> &values, const double length, const ProfileInput &input)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        if (!(values[i] > 0.))
          refuse(input.formula_entry,
                 "number {} of \"{}\" is {:g}, but a positive number is expected",
                 i + 1,
                 input.formula,
                 values[i]);
      return table_profile(equal_parts(0., length, values.size() - 1), values, "numbers", input);
    }

    std::shared_ptr<const Profile>
    read_any_profile(const ProfileInput &input, const double length, const double end_time)
    {
      if (input.formula.ends_with(".csv"))
        return read_table(input);
      if (input.variables.front() == "s" && input.formula.find(',') != std::string::npos)
        if (const auto values = to_numbers(input.formula))
          return list_profile(*values, length, input);
      return formula_profile(read_formula(input, length, end_time), input.variables.front() == "s" ? length : 0.);
    }
  } // namespace

  std::vector<double>
  profile_at(const std::shared_ptr<const Profile> &profile, const std::vector<double> &places)
  {
    std::vector<double> values(places.size(), 1.);
    if (profile)
      profile->values(places, values);
    return values;
  }

  double
  Profile::value(const double x) const
  {
    double f = 0.;
    values({&x, 1}, {&f, 1});
    return f;
  }

  std::shared_ptr<const Profile>
  read_profile(const ProfileInput &input, const double length, const double end_time)
  {
    if (to_number(input.formula) == 1.)
      return nullptr;
    const auto profile = read_any_profile(input, length, end_time);
    require_positive([&](const double x) { return profile->value(x); }, 0., length, input);
    return profile;
  }

  std::shared_ptr<const Profile>
  in_units(const std::shared_ptr<const Profile> &profile, const double unit)
  {
    if (!profile)
      return nullptr;
    std::vector<double> breaks = profile->breaks();
    for (double &x : breaks)
      x /= unit;
    return std::make_shared<Profile>(
      [profile, unit, scaled = std::vector<double>()](
        const std::span<const double> x, const std::span<double> f, const std::span<double> slope) mutable {
        scaled.assign(x.begin(), x.end());
        for (double &value : scaled)
          value *= unit;
        profile->values(scaled, f, slope);
        for (double &value : slope)
          value *= unit;
      },
      std::move(breaks));
  }

  void
  require_positive(const std::function<double(double)> &factor,
                   const double from,
                   const double to,
                   const FormulaInput &input)
  {
    constexpr unsigned int n = 1000;
    for (const double x : equal_parts(from, to, n))
      if (const double f = factor(x); !(std::isfinite(f) && f > 0.))
        refuse(input.formula_entry,
               "the {} \"{}\" is {} at {} = {:g}; a positive number is expected",
               input.quantity,
               input.formula,
               f,
               input.variables.front(),
               x);
  }
} // namespace crawler
