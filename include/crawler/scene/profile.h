// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/formula_input.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// A factor that depends on a place: along the body (s) or on the ground (x). NaN where it is unknown.
  class Profile
  {
  public:
    using Values = std::function<void(std::span<const double> x, std::span<double> f, std::span<double> slope)>;

    Profile(Values values, std::vector<double> breaks)
      : values_(std::move(values))
      , breaks_(std::move(breaks))
    {
    }

    /// Writes the factor [1] at the places @p x [length], and its derivative [1/length] unless @p slope is empty.
    void
    values(const std::span<const double> x, const std::span<double> f, const std::span<double> slope = {}) const
    {
      values_(x, f, slope);
    }

    /// Places where the factor is known to have a jump or a kink [length].
    const std::vector<double> &
    breaks() const
    {
      return breaks_;
    }

    double
    value(double x) const;

  private:
    const Values values_;
    const std::vector<double> breaks_;
  };

  /// The factor at places; 1 where there is no profile.
  std::vector<double>
  profile_at(const std::shared_ptr<const Profile> &profile, const std::vector<double> &places);

  /// A profile as written by the user: a formula of one variable, s or x, or instead of it the name of a CSV file (it
  /// ends in .csv) with the columns of this variable and "value", or, along the body, a list of its values at equally
  /// spaced places.
  struct ProfileInput : FormulaInput
  {
    std::string interpolation = "cubic"; ///< of a list or a file; or linear
    std::string outside       = "hold";  ///< of a file; or error
  };

  /**
   * Reads a profile; null if it is the number 1. Throws InputError if the formula, the list or the file has an error,
   * with its position or row number, or if it is not positive on a fine grid of 0 to @p length [length].
   */
  std::shared_ptr<const Profile>
  read_profile(const ProfileInput &input, double length, double end_time);

  /// The profile in other units; @p unit is that of its places.
  std::shared_ptr<const Profile>
  in_units(const std::shared_ptr<const Profile> &profile, double unit);

  /// Throws InputError unless the factor is positive and finite on a fine grid of @p from to @p to.
  void
  require_positive(const std::function<double(double)> &factor, double from, double to, const FormulaInput &input);
} // namespace crawler
