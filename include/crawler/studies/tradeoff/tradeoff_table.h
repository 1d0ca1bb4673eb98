// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>
#include <crawler/studies/tradeoff/tradeoff_settings.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// A setting, and what came of it. What is not known is not a number.
  struct TradeoffRow
  {
    static constexpr double unknown = TradeoffSetting::none;

    TradeoffSetting setting;
    std::string status;              ///< finished, inverted, failed, stopped, refused, not offered; empty: not tried
    std::string reason, message;     ///< of the others than finished
    double displacement   = unknown; ///< [length]
    double error          = unknown; ///< relative, as measured [1]
    double shown_error    = unknown; ///< the same, but no smaller than the reference's bar [1]
    std::string below_bar = "false"; ///< whether it is smaller
    std::string pareto;              ///< whether no other row beats it; empty until all are known
    double seconds        = unknown; ///< processor time of a run, of a body if in a batch: the median [s]
    double spread         = unknown; ///< largest minus smallest measurement, over the median [1]
    double repetitions    = unknown; ///< runs that were timed
    double choice_seconds = unknown; ///< processor time of the pilot runs of an adaptive mesh [s]
    double memory         = unknown; ///< largest heap in use, of all bodies of a batch together [byte]
    double steps = unknown, rejected_steps = unknown, newton_iterations = unknown, most_cells = unknown;

    void
    not_computed(const std::string &new_status, const std::string &new_reason, const std::string &new_message);

    /// The errors, if there is a displacement.
    void
    compare(const TradeoffReference &reference);

    bool
    is_finished() const
    {
      return status == "finished";
    }
    /// A level that says itself that its error may be larger than its Accuracy: no file can ask for it.
    bool
    breaks_promise() const
    {
      return is_finished() && !message.empty();
    }
  };

  /// tradeoff.h5: a row for each setting, which are known from the beginning; the columns are a contract
  /// (doc/user_guide.md, "Trading accuracy for speed").
  PointTable
  tradeoff_table();

  /// Makes the file of a new study.
  void
  create_tradeoff_table(const std::filesystem::path &folder,
                        const std::vector<TradeoffSetting> &settings,
                        const std::map<std::string, std::string> &attributes);

  /// The row in PointTable::written_columns().
  RowFile::Row
  written_row(const TradeoffRow &row);

  /// All rows of the folder (one process).
  std::vector<TradeoffRow>
  read_rows(const std::filesystem::path &folder, const std::vector<TradeoffSetting> &settings);
} // namespace crawler
