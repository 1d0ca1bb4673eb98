// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace crawler
{
  /// What a run says of one thing; nothing if it is not known.
  using ResultValue = std::variant<std::monostate, double, unsigned long, bool, std::string>;

  /// One of all the numbers and words that a run gives. The JSON of summary.json, the columns of a sweep and the error
  /// bounds are made from result_table(): to add a number, add a line there (doc/developer_guide.md).
  struct ResultEntry
  {
    /// What the error of a number is measured by (number_errors()).
    enum class Scale
    {
      none, ///< it has no error bound
      exchanged_work,
      strain, ///< the largest one
      itself,
      cost ///< exchanged work of the stride per distance
    };

    std::string key;     ///< in summary.json, dots for nesting
    std::string unit;    ///< "length", "force length", "1"; empty of words
    std::string meaning; ///< for tables
    ResultValue (*value)(const SimulationResult &);
    Scale scale     = Scale::none;
    bool is_sampled = false; ///< found by looking at Gauss points, or follows from such a number
    bool is_word    = false;
    bool of_process = false; ///< says something of the process, not of the scene: no column of a sweep
    int error       = -1;    ///< of the number that is this one of NumberErrors::values; value is null then

    ResultValue
    value_in(const SimulationResult &result) const;
    /// What its error is measured by; 0 if it has none.
    double
    scale_in(const SimulationResult &result) const;
  };

  /// In the order of summary.json.
  const std::vector<ResultEntry> &
  result_table();

  /// Those with an error bound, in the order of NumberErrors::values.
  const std::vector<const ResultEntry *> &
  entries_with_errors();

  /// That of the number under this key, if it is known.
  std::optional<double>
  error_bound(const SimulationResult &result, const std::string &key);

  /// Sets it.
  void
  set_error_bound(SimulationResult &result, const std::string &key, double bound);

  /// The same as " +- 1e-6", or nothing.
  std::string
  error_bound_in_words(const SimulationResult &result, const std::string &key);
} // namespace crawler
