// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_place.h>
#include <crawler/studies/tradeoff/tradeoff_rows.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <type_traits>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// The name of a column in the lines.
    std::string
    key_of(const std::string &name)
    {
      std::string key = name;
      std::replace(key.begin(), key.end(), ' ', '_');
      return key;
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

    Json
    to_json(const TradeoffRow &row)
    {
      Json json = {{"index", row.index}, {"prm", row.prm}};
      for (const TradeoffColumn &column : tradeoff_columns())
        std::visit([&](const auto &value) { json[key_of(column.name)] = value; }, column.value_in(row));
      return json;
    }

    TradeoffRow
    row_of(const Json &json)
    {
      TradeoffRow row;
      row.index = json.at("index");
      row.prm   = json.at("prm");
      for (const TradeoffColumn &column : tradeoff_columns())
      {
        const Json &value = json.at(key_of(column.name));
        std::visit(
          [&](const auto member) {
            auto &own = member_of(row, member);
            if (!value.is_null())
              own = value.get<std::decay_t<decltype(own)>>();
          },
          column.member);
      }
      return row;
    }
  } // namespace

  const std::vector<TradeoffColumn> &
  tradeoff_columns()
  {
    using S                                          = TradeoffSetting;
    using R                                          = TradeoffRow;
    static const std::vector<TradeoffColumn> columns = {
      {"model", "", "level of the model", &S::model},
      {"formulation", "", "position or stretch", &S::formulation},
      {"mesh", "", "uniform or adaptive", &S::mesh},
      {"engine", "", "fused, petsc, or batch: 8 bodies side by side by the fused engine", &S::engine},
      {"integrator", "", "time integrator", &S::integrator},
      {"degree", "1", "polynomial degree", &S::degree},
      {"cells", "1", "cells of a uniform mesh", &S::cells},
      {"mesh tolerance", "1", "of an adaptive mesh, relative to the square of the strain", &S::mesh_tolerance},
      {"tolerance",
       "1",
       "time tolerance over the size of the displacement; of a level without a mesh: Accuracy",
       &S::tolerance},
      {"status", "", "finished, inverted, failed, stopped, refused, or not offered", &R::status},
      {"reason", "", "name of what went wrong", &R::reason},
      {"message", "", "what went wrong, or what the level says about its error, in words", &R::message},
      {"displacement", "length", "of the centre of mass at the end time", &R::displacement},
      {"seconds", "s", "processor time to build the simulation and run it, median; of a body, in a batch", &R::seconds},
      {"spread", "1", "largest minus smallest measurement over the median", &R::spread},
      {"repetitions", "1", "runs that were timed", &R::repetitions},
      {"choice seconds",
       "s",
       "processor time of the pilot runs of an adaptive mesh, which is not in seconds",
       &R::choice_seconds},
      {"memory",
       "byte",
       "largest heap in use by the simulation at the ends of steps; of a batch: by all bodies",
       &R::memory},
      {"steps", "1", "accepted time steps", &R::steps},
      {"rejected steps", "1", "time steps that were done again", &R::rejected_steps},
      {"newton iterations", "1", "of all steps", &R::newton_iterations},
      {"most cells", "1", "of an adaptive mesh, largest over time", &R::most_cells}};
    return columns;
  }

  std::variant<double, std::string>
  TradeoffColumn::value_in(const TradeoffRow &row) const
  {
    return std::visit(
      [&](const auto member) -> std::variant<double, std::string> {
        const auto &value = member_of(row, member);
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, unsigned int>)
          return value > 0 ? value : TradeoffRow::unknown;
        else
          return value;
      },
      member);
  }

  std::string
  pack(const std::map<unsigned long, TradeoffRow> &rows)
  {
    std::string lines;
    for (const auto &[index, row] : rows)
      lines += to_json(row).dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + "\n";
    return lines;
  }

  std::map<unsigned long, TradeoffRow>
  unpack_rows(const std::string &lines)
  {
    std::map<unsigned long, TradeoffRow> rows;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line) && !in.eof();) // the last line has its end, or it was cut off
      try
      {
        const TradeoffRow row = row_of(Json::parse(line));
        rows.emplace(row.index, row);
      }
      catch (const std::exception &)
      {
        // A line that the disk did not take as a whole: its setting is computed again.
      }
    return rows;
  }

  TradeoffRowWriter::TradeoffRowWriter(const std::filesystem::path &folder, const unsigned int rank)
    : path_(folder / "rows" / fmt::format("{}.jsonl", rank))
    , out_(path_, std::ios::app)
  {
  }

  void
  TradeoffRowWriter::write(const TradeoffRow &row)
  {
    out_ << pack({{row.index, row}}) << std::flush;
    if (!out_)
      throw FileError("cannot write \"" + path_.string() + "\" (is the disk full?)");
    reach(StopPlace::row);
  }

  std::map<unsigned long, TradeoffRow>
  recover_rows(const std::filesystem::path &folder)
  {
    std::map<unsigned long, TradeoffRow> rows;
    std::vector<std::filesystem::path> files;
    for (const auto &file : std::filesystem::directory_iterator(folder / "rows"))
      if (file.path().extension() == ".jsonl")
        files.push_back(file.path());
    for (const auto &file : files)
      rows.merge(unpack_rows(read_whole_file(file)));
    const auto kept = folder / "rows" / "kept.jsonl";
    write_file(kept, pack(rows));
    for (const auto &file : files)
      if (file != kept)
        std::filesystem::remove(file);
    return rows;
  }
} // namespace crawler
