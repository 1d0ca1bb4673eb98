// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/tradeoff/tradeoff_table.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace crawler
{
  namespace
  {
    /// A column that is a member of the row or of its setting.
    struct TradeoffColumn
    {
      RowFile::Column column;
      std::variant<std::string TradeoffSetting::*,
                   double TradeoffSetting::*,
                   unsigned int TradeoffSetting::*,
                   std::string TradeoffRow::*,
                   double TradeoffRow::*>
        member;
    };

    /// In the order of the table, behind the index: the setting, and what came of it.
    const std::vector<TradeoffColumn> &
    tradeoff_columns()
    {
      using S                                          = TradeoffSetting;
      using R                                          = TradeoffRow;
      static const std::vector<TradeoffColumn> columns = {
        {{"model", "", "level of the model", 16}, &S::model},
        {{"formulation", "", "position or stretch", 16}, &S::formulation},
        {{"mesh", "", "uniform or adaptive", 16}, &S::mesh},
        {{"engine", "", "fused, petsc, or batch: 8 bodies side by side by the fused engine", 16}, &S::engine},
        {{"integrator", "", "time integrator", 24}, &S::integrator},
        {{"degree", "1", "polynomial degree"}, &S::degree},
        {{"cells", "1", "cells of a uniform mesh"}, &S::cells},
        {{"mesh tolerance", "1", "of an adaptive mesh, relative to the square of the strain"}, &S::mesh_tolerance},
        {{"tolerance", "1", "time tolerance over the size of the displacement; of a level without a mesh: Accuracy"},
         &S::tolerance},
        {{"status", "", "finished, inverted, failed, stopped, refused, or not offered; empty: not tried yet", 16},
         &R::status},
        {{"reason", "", "name of what went wrong", 32}, &R::reason},
        {{"message", "", "what went wrong, or what the level says about its error, in words", 256}, &R::message},
        {{"displacement", "length", "of the centre of mass at the end time"}, &R::displacement},
        {{"error", "1", "distance of the displacement to the reference, over the size of the displacement"}, &R::error},
        {{"shown error", "1", "the same, but no smaller than the reference's bar"}, &R::shown_error},
        {{"below bar", "", "true if the error cannot be told from 0: it is below the reference's bar", 8},
         &R::below_bar},
        {{"pareto",
          "",
          "true if no other single run (for a batch: no other batch) is as cheap and as accurate, and better in one",
          8},
         &R::pareto},
        {{"seconds", "s", "processor time to build the simulation and run it, median; of a body, in a batch"},
         &R::seconds},
        {{"spread", "1", "largest minus smallest measurement over the median"}, &R::spread},
        {{"repetitions", "1", "runs that were timed"}, &R::repetitions},
        {{"choice seconds", "s", "processor time of the pilot runs of an adaptive mesh, which is not in seconds"},
         &R::choice_seconds},
        {{"memory", "byte", "largest heap in use by the simulation at the ends of steps; of a batch: by all bodies"},
         &R::memory},
        {{"steps", "1", "accepted time steps"}, &R::steps},
        {{"rejected steps", "1", "time steps that were done again"}, &R::rejected_steps},
        {{"newton iterations", "1", "of all steps"}, &R::newton_iterations},
        {{"most cells", "1", "of an adaptive mesh, largest over time"}, &R::most_cells}};
      return columns;
    }

    /// The part of a row that has such a member.
    template <typename Row, typename Value>
    auto &
    member_of(Row &row, Value TradeoffSetting::*member)
    {
      return row.setting.*member;
    }
    template <typename Row, typename Value>
    auto &
    member_of(Row &row, Value TradeoffRow::*member)
    {
      return row.*member;
    }

    RowFile::Value
    value_in(const TradeoffRow &row, const TradeoffColumn &column)
    {
      return std::visit(
        [&](const auto member) -> RowFile::Value {
          const auto &value = member_of(row, member);
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, unsigned int>)
            return value > 0 ? value : TradeoffRow::unknown;
          else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
            return shortened(value, column.column.width);
          else
            return value;
        },
        column.member);
    }

    const auto is_of_setting = [](const TradeoffColumn &column) { return column.member.index() < 3; };
  } // namespace

  void
  TradeoffRow::not_computed(const std::string &new_status,
                            const std::string &new_reason,
                            const std::string &new_message)
  {
    status  = new_status;
    reason  = new_reason;
    message = new_message;
  }

  void
  TradeoffRow::compare(const TradeoffReference &reference)
  {
    if (!is_finished())
      return;
    error       = std::abs(displacement - reference.answer.displacement) / reference.size;
    shown_error = std::max(error, reference.relative_bar());
    below_bar   = error < shown_error ? "true" : "false";
  }

  PointTable
  tradeoff_table()
  {
    const auto &columns = tradeoff_columns();
    PointTable table    = {"tradeoff.h5", "tradeoff", {{"index", "1", "number of the setting"}}, 1, "status", {}, 0.};
    for (const TradeoffColumn &column : columns)
      table.columns.push_back(column.column);
    table.n_known += static_cast<std::size_t>(std::count_if(columns.begin(), columns.end(), is_of_setting));
    return table;
  }

  void
  create_tradeoff_table(const std::filesystem::path &folder,
                        const std::vector<TradeoffSetting> &settings,
                        const std::map<std::string, std::string> &attributes)
  {
    const PointTable table = tradeoff_table();
    RowFile::create(folder / table.file,
                    table.group,
                    table.columns,
                    settings.size(),
                    attributes,
                    {table.n_known, [&](const std::size_t column, const unsigned long row) -> RowFile::Value {
                       if (column == 0)
                         return static_cast<double>(row);
                       TradeoffRow known;
                       known.setting = settings[row];
                       return value_in(known, tradeoff_columns()[column - 1]);
                     }});
  }

  RowFile::Row
  written_row(const TradeoffRow &row)
  {
    RowFile::Row values;
    for (const RowFile::Column &written : tradeoff_table().written_columns())
      for (const TradeoffColumn &column : tradeoff_columns())
        if (column.column.name == written.name)
          values.push_back(value_in(row, column));
    return values;
  }

  std::vector<TradeoffRow>
  read_rows(const std::filesystem::path &folder, const std::vector<TradeoffSetting> &settings)
  {
    const PointTable table = tradeoff_table();
    const RowReader reader(MPI_COMM_SELF, folder / table.file, table.group);
    std::vector<TradeoffRow> rows(settings.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].setting = settings[i];
    for (const TradeoffColumn &column : tradeoff_columns())
    {
      const Column read = reader.read(reader.index_of(column.column.name), 0, rows.size());
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (const auto *text = std::get_if<std::string TradeoffRow::*>(&column.member))
          rows[i].*(*text) = std::get<std::vector<std::string>>(read.values)[i];
        else if (const auto *number = std::get_if<double TradeoffRow::*>(&column.member))
          rows[i].*(*number) = std::get<std::vector<double>>(read.values)[i];
    }
    return rows;
  }
} // namespace crawler
