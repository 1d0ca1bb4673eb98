// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace crawler
{
  /// Value of one result of a run; nothing if it is not known.
  using ResultValue = std::variant<std::monostate, double, unsigned long, bool, std::string>;

  /// Entry of one number or word that a run gives. The JSON of summary.json, the columns of a sweep and the error
  /// bounds are made from result_table(): to add a number, add a line there (doc/developer_guide.md).
  struct ResultEntry
  {
    /// Scale of the error of a number (number_errors()).
    enum class Scale
    {
      none, ///< no error bound
      exchanged_work,
      strain, ///< largest strain
      itself,
      cost ///< exchanged work of the stride per distance
    };

    std::string key;     ///< key in summary.json, dots for nesting
    std::string unit;    ///< "length", "force length", "1"; empty of words
    std::string meaning; ///< meaning, for tables
    ResultValue (*value)(const SimulationResult &);
    Scale scale     = Scale::none;
    bool is_sampled = false; ///< found by looking at Gauss points, or derived from such a number
    bool is_word    = false;
    bool of_process = false; ///< describes the process, not the scene: no column of a sweep
    int error       = -1; ///< index in SimulationResult::errors of the number whose error this is; value is null then

    ResultValue
    value_in(const SimulationResult &result) const;
    /// The same of a number; not a number if it is not known.
    double
    number_in(const SimulationResult &result) const;
    /// Scale of its error; 0 if it has none.
    double
    scale_in(const SimulationResult &result) const;
  };

  /// Entries in the order of summary.json.
  const std::vector<ResultEntry> &
  result_table();

  /// Entry of a key, which must exist.
  const ResultEntry &
  entry_of(const std::string &key);

  /// Entries with an error bound, in the order of SimulationResult::errors.
  const std::vector<const ResultEntry *> &
  entries_with_errors();

  /// Error bound of the number under this key, if it is known.
  std::optional<double>
  error_bound(const SimulationResult &result, const std::string &key);

  /// Sets the error bound of the number under this key.
  void
  set_error_bound(SimulationResult &result, const std::string &key, double bound);

  /// Error bound as " +- 1e-6", or nothing.
  std::string
  error_bound_in_words(const SimulationResult &result, const std::string &key);
} // namespace crawler
