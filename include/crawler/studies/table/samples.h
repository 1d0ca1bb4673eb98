// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/table/measured_file.h>

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// What is measured.
  enum class MeasuredQuantity
  {
    active_stress,
    strain,
    marker ///< the place x of each marker
  };

  /// The name of the column that a table of it has: "m", "strain", "x".
  std::string
  column_of(MeasuredQuantity quantity);

  /// Samples at all points of a grid over s (of markers: their numbers) and t; a gap is not a number.
  struct Samples
  {
    MeasuredQuantity quantity = MeasuredQuantity::active_stress;
    std::vector<double> s, t;   ///< increasing
    std::vector<double> values; ///< [t][s]

    double &
    at(const std::size_t j, const std::size_t i)
    {
      return values[j * s.size() + i];
    }
    double
    at(const std::size_t j, const std::size_t i) const
    {
      return values[j * s.size() + i];
    }
    /// All values of one place over time, or all at one time.
    std::vector<double>
    over_time(std::size_t i) const;
    std::vector<double>
    over_body(std::size_t j) const;
  };

  /// How columns of a file become samples.
  struct SampleSettings
  {
    std::string quantity;                            ///< "m", "strain", "stretch" or "markers"; empty: by the names
    std::string columns;                             ///< "t=Frame time, x=X": other names of columns
    std::string unit_of_s, unit_of_t, unit_of_value; ///< a factor, or the unit into which that of the file is turned
    std::string shift_s, shift_t;                    ///< a number, or "first": the first one becomes 0
  };

  /**
   * The samples of a long table (columns s, t and m, strain or stretch; or t, marker and x) or a wide one (t and a
   * column for each s or marker; or s and a column for each t), in the units wanted. What was done is added to @p
   * words. Throws InputError.
   */
  Samples
  read_samples(const MeasuredFile &file, const SampleSettings &settings, std::vector<std::string> &words);
} // namespace crawler
