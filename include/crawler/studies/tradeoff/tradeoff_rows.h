// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/tradeoff/tradeoff_settings.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace crawler
{
  /// A setting that was tried, and what came of it. What is not known is not a number.
  struct TradeoffRow
  {
    static constexpr double unknown = TradeoffSetting::none;

    unsigned long index = 0; ///< number of the setting
    TradeoffSetting setting;
    std::string status;              ///< finished, inverted, failed, stopped, refused, not offered
    std::string reason, message;     ///< of the others than finished
    double displacement   = unknown; ///< [length]
    double seconds        = unknown; ///< processor time of a run, of a body if in a batch: the median [s]
    double spread         = unknown; ///< largest minus smallest measurement, over the median [1]
    double repetitions    = unknown; ///< runs that were timed
    double choice_seconds = unknown; ///< processor time of the pilot runs of an adaptive mesh [s]
    double memory         = unknown; ///< largest heap in use, of all bodies of a batch together [byte]
    double steps = unknown, rejected_steps = unknown, newton_iterations = unknown, most_cells = unknown;
    std::string prm; ///< entries that repeat it with `crawler run`; empty if there are none (a column of no table)
  };

  /// A column of the table that is a member of the row or of its setting. What has no meaning there, 0 cells for
  /// example, is not a number.
  struct TradeoffColumn
  {
    std::string name, unit, description;
    std::variant<std::string TradeoffSetting::*,
                 double TradeoffSetting::*,
                 unsigned int TradeoffSetting::*,
                 std::string TradeoffRow::*,
                 double TradeoffRow::*>
      member;

    std::variant<double, std::string>
    value_in(const TradeoffRow &row) const;
  };

  /// All but the index, in the order of tradeoff.csv. What is missing here is lost when a study is resumed.
  const std::vector<TradeoffColumn> &
  tradeoff_columns();

  /// Rows as lines of text (JSON), one for each, and back. A line that is not whole is not a row.
  std::string
  pack(const std::map<unsigned long, TradeoffRow> &rows);
  std::map<unsigned long, TradeoffRow>
  unpack_rows(const std::string &lines);

  /**
   * The rows as they come, in files of their own (FOLDER/rows/RANK.jsonl), so that a job that is killed loses none but
   * those under way: a line is written at once.
   */
  class TradeoffRowWriter
  {
  public:
    TradeoffRowWriter(const std::filesystem::path &folder, unsigned int rank);

    void
    write(const TradeoffRow &row);

  private:
    const std::filesystem::path path_;
    std::ofstream out_;
  };

  /// All whole rows of @p folder by index; rewrites them as one file. Only one rank calls this.
  std::map<unsigned long, TradeoffRow>
  recover_rows(const std::filesystem::path &folder);
} // namespace crawler
