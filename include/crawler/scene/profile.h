// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// A factor that depends on a place: along the body (s) or on the ground (x). Not a number where it is not known.
  class Profile
  {
  public:
    virtual ~Profile() = default;

    /// The factor [1] at the places @p x [length]; and in the second function its derivative [1/length].
    void
    values(const std::span<const double> x, const std::span<double> f) const
    {
      evaluate(x, f, {});
    }
    void
    values_and_slopes(const std::span<const double> x, const std::span<double> f, const std::span<double> slope) const
    {
      evaluate(x, f, slope);
    }

    /// Where the factor is known to have a jump or a kink [length].
    virtual std::vector<double>
    breaks() const
    {
      return {};
    }

    double
    value(double x) const;

  private:
    /// @p slope is empty where it is not wanted.
    virtual void
    evaluate(std::span<const double> x, std::span<double> f, std::span<double> slope) const = 0;
  };

  /// The factor at places; 1 where there is no profile.
  std::vector<double>
  profile_at(const std::shared_ptr<const Profile> &profile, const std::vector<double> &places);

  /// A profile as the user writes it: a formula, the name of a CSV file with two columns, or, along the body, a list of
  /// its values at equally spaced places.
  struct ProfileInput
  {
    std::string quantity;                ///< what it gives, for messages
    std::string variable;                ///< s or x; also the first word of the file's header, "value" being the second
    std::string text;                    ///< ends in .csv: a file
    std::string interpolation = "cubic"; ///< or linear, of a list or a file
    std::string outside       = "hold";  ///< or error, of a file
    std::string entry;                   ///< full name of the entry
    std::string constants = "", constants_entry = ""; ///< of a formula
  };

  /**
   * Null if the profile is the number 1. Throws InputError if the formula, the list or the file has an error, with its
   * position or the number of its row.
   */
  std::shared_ptr<const Profile>
  read_profile(const ProfileInput &input, double length, double end_time);

  /// The same profile in other units: @p unit is that of its places.
  std::shared_ptr<const Profile>
  in_units(std::shared_ptr<const Profile> profile, double unit);

  /// Throws InputError unless the profile is positive and finite on a fine grid of @p from to @p to [length].
  void
  require_positive(const Profile &profile, double from, double to, const ProfileInput &input);
} // namespace crawler
