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

namespace crawler
{
  namespace
  {
    class FormulaProfile : public Profile
    {
    public:
      /// Searches jumps and kinks in [0, @p length], nowhere if this is 0.
      FormulaProfile(const std::shared_ptr<const Formula> &formula, const double length)
        : gradient_(formula)
      {
        constexpr std::size_t most = 64; // more are no jumps of a material
        const auto breaks          = length > 0. ? formula_breaks(formula, length, 0.).in_space : std::nullopt;
        if (breaks && breaks->size() <= most)
          breaks_ = *breaks;
      }

      std::vector<double>
      breaks() const override
      {
        return breaks_;
      }

      void
      values(const std::span<const double> x, const std::span<double> f, const std::span<double> slope) const override
      {
        const std::span<const double> places[] = {x};
        const std::span<double> slopes[]       = {slope};
        gradient_.evaluate(places, f, slopes);
      }

    private:
      mutable FormulaGradient gradient_; ///< holds intermediate values
      std::vector<double> breaks_;
    };

    /// Linear interpolation of samples, or a cubic spline of their logarithms.
    class TableProfile : public Profile
    {
    public:
      TableProfile(std::vector<double> x, std::vector<double> y, const bool cubic, const bool hold)
        : x_(std::move(x))
        , y_(std::move(y))
        , hold_(hold)
      {
        if (cubic)
        {
          spline_ = std::make_unique<CubicSpline>(x_);
          for (const double value : y_)
            logarithms_.push_back(std::log(value));
          curvatures_ = spline_->curvatures(logarithms_);
        }
      }

      std::vector<double>
      breaks() const override
      {
        return spline_ && x_.size() > max_knots_of_splines ? std::vector<double>{x_.front(), x_.back()} : x_;
      }

      void
      values(const std::span<const double> x, const std::span<double> f, const std::span<double> slope) const override
      {
        for (std::size_t i = 0; i < x.size(); ++i)
        {
          const auto [value, derivative] = at(x[i]);
          f[i]                           = value;
          if (!slope.empty())
            slope[i] = derivative;
        }
      }

    private:
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

      const std::vector<double> x_, y_;
      const bool hold_;
      std::unique_ptr<CubicSpline> spline_;
      std::vector<double> logarithms_, curvatures_; ///< if there is a spline
    };

    class ScaledProfile : public Profile
    {
    public:
      ScaledProfile(std::shared_ptr<const Profile> profile, const double unit)
        : profile_(std::move(profile))
        , unit_(unit)
      {
      }

      std::vector<double>
      breaks() const override
      {
        auto result = profile_->breaks();
        for (double &x : result)
          x /= unit_;
        return result;
      }

      void
      values(const std::span<const double> x, const std::span<double> f, const std::span<double> slope) const override
      {
        scaled_.assign(x.begin(), x.end());
        for (double &value : scaled_)
          value *= unit_;
        profile_->values(scaled_, f, slope);
        for (double &value : slope)
          value *= unit_;
      }

    private:
      const std::shared_ptr<const Profile> profile_;
      const double unit_;
      mutable std::vector<double> scaled_;
    };

    /// Makes a profile of at least as many samples as the interpolation needs; @p what names them in messages.
    std::shared_ptr<const Profile>
    table_profile(std::vector<double> x, std::vector<double> y, const char *what, const ProfileInput &input)
    {
      const bool cubic        = input.interpolation == "cubic";
      const std::size_t least = cubic ? 4 : 2;
      if (x.size() < least)
        refuse(input.entry,
               "\"{}\" has {} {}, but at least {} are expected for {} interpolation",
               input.text,
               x.size(),
               what,
               least,
               input.interpolation);
      return std::make_shared<TableProfile>(std::move(x), std::move(y), cubic, input.outside == "hold");
    }

    std::shared_ptr<const Profile>
    read_table(const ProfileInput &input)
    {
      const std::string header = input.variable + ",value";
      CsvNumbers numbers       = read_csv_numbers(
        input.text,
        {input.variable, "value"},
        fmt::format("a formula of {}, or the name of a CSV file with the header {}", input.variable, header),
        input.entry);
      std::vector<double> &x = numbers.columns[0], &y = numbers.columns[1];
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        if (!(y[i] > 0.))
          refuse(input.entry,
                 "row {} of \"{}\" has the value {:g}, but a positive number is expected",
                 numbers.rows[i],
                 input.text,
                 y[i]);
        if (i > 0 && !(x[i] > x[i - 1]))
          refuse(input.entry,
                 "row {} of \"{}\" has {} = {:g} after {:g}, but increasing numbers are expected",
                 numbers.rows[i],
                 input.text,
                 input.variable,
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
          refuse(input.entry,
                 "number {} of \"{}\" is {:g}, but a positive number is expected",
                 i + 1,
                 input.text,
                 values[i]);
      return table_profile(equal_parts(0., length, values.size() - 1), values, "numbers", input);
    }

    std::shared_ptr<const Profile>
    read_any_profile(const ProfileInput &input, const double length, const double end_time)
    {
      if (input.text.ends_with(".csv"))
        return read_table(input);
      if (input.variable == "s" && input.text.find(',') != std::string::npos)
        if (const auto values = to_numbers(input.text))
          return list_profile(*values, length, input);
      return std::make_shared<FormulaProfile>(read_formula(input.formula(), length, end_time),
                                              input.variable == "s" ? length : 0.);
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
    if (to_number(input.text) == 1.)
      return nullptr;
    const auto profile = read_any_profile(input, length, end_time);
    require_positive([&](const double x) { return profile->value(x); }, 0., length, input);
    return profile;
  }

  std::shared_ptr<const Profile>
  in_units(std::shared_ptr<const Profile> profile, const double unit)
  {
    return profile ? std::make_shared<ScaledProfile>(std::move(profile), unit) : nullptr;
  }

  void
  require_positive(const std::function<double(double)> &factor,
                   const double from,
                   const double to,
                   const ProfileInput &input)
  {
    constexpr unsigned int n = 1000;
    for (const double x : equal_parts(from, to, n))
      if (const double f = factor(x); !(std::isfinite(f) && f > 0.))
        refuse(input.entry,
               "the {} \"{}\" is {} at {} = {:g}; a positive number is expected",
               input.quantity,
               input.text,
               f,
               input.variable,
               x);
  }
} // namespace crawler
