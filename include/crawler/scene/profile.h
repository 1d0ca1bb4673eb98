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
    virtual ~Profile() = default;

    /// Writes the factor [1] at the places @p x [length], and its derivative [1/length] unless @p slope is empty.
    virtual void
    values(std::span<const double> x, std::span<double> f, std::span<double> slope = {}) const = 0;

    /// Places where the factor is known to have a jump or a kink [length].
    virtual std::vector<double>
    breaks() const
    {
      return {};
    }

    double
    value(double x) const;
  };

  /// The factor at places; 1 where there is no profile.
  std::vector<double>
  profile_at(const std::shared_ptr<const Profile> &profile, const std::vector<double> &places);

  /// A profile as written by the user: a formula, the name of a CSV file with two columns, or, along the body, a list
  /// of its values at equally spaced places.
  struct ProfileInput
  {
    std::string quantity;                ///< the quantity, for messages
    std::string variable;                ///< s or x; also the first word of the file's header, "value" being the second
    std::string text;                    ///< ends in .csv: a file
    std::string interpolation = "cubic"; ///< of a list or a file; or linear
    std::string outside       = "hold";  ///< of a file; or error
    std::string entry;                   ///< full name of the entry
    std::string constants = "", constants_entry = ""; ///< of a formula

    FormulaInput
    formula() const
    {
      return {quantity, text, constants, entry, constants_entry, {variable}};
    }
  };

  /**
   * Reads a profile; null if it is the number 1. Throws InputError if the formula, the list or the file has an error,
   * with its position or row number, or if it is not positive on a fine grid of 0 to @p length [length].
   */
  std::shared_ptr<const Profile>
  read_profile(const ProfileInput &input, double length, double end_time);

  /// The profile in other units; @p unit is that of its places.
  std::shared_ptr<const Profile>
  in_units(std::shared_ptr<const Profile> profile, double unit);

  /// Throws InputError unless the factor is positive and finite on a fine grid of @p from to @p to.
  void
  require_positive(const std::function<double(double)> &factor, double from, double to, const ProfileInput &input);
} // namespace crawler
