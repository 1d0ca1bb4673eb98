// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/studies/tradeoff/tradeoff_rows.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    // Everything that a line has, by name: a member that is missing here would be lost.
    constexpr std::pair<const char *, double TradeoffRow::*> row_numbers[] = {
      {"displacement", &TradeoffRow::displacement},
      {"seconds", &TradeoffRow::seconds},
      {"spread", &TradeoffRow::spread},
      {"repetitions", &TradeoffRow::repetitions},
      {"choice_seconds", &TradeoffRow::choice_seconds},
      {"memory", &TradeoffRow::memory},
      {"steps", &TradeoffRow::steps},
      {"rejected_steps", &TradeoffRow::rejected_steps},
      {"newton_iterations", &TradeoffRow::newton_iterations},
      {"most_cells", &TradeoffRow::most_cells}};
    constexpr std::pair<const char *, std::string TradeoffRow::*> row_texts[] = {{"status", &TradeoffRow::status},
                                                                                 {"reason", &TradeoffRow::reason},
                                                                                 {"message", &TradeoffRow::message},
                                                                                 {"prm", &TradeoffRow::prm}};
    constexpr std::pair<const char *, std::string TradeoffSetting::*> setting_texts[] = {
      {"model", &TradeoffSetting::model},
      {"formulation", &TradeoffSetting::formulation},
      {"mesh", &TradeoffSetting::mesh},
      {"engine", &TradeoffSetting::engine},
      {"integrator", &TradeoffSetting::integrator}};

    double
    number(const Json &json)
    {
      return json.is_null() ? TradeoffRow::unknown : json.get<double>();
    }
  } // namespace

  std::string
  pack(const TradeoffRow &row)
  {
    Json json = {{"index", row.index},
                 {"degree", row.setting.degree},
                 {"cells", row.setting.cells},
                 {"mesh_tolerance", row.setting.mesh_tolerance},
                 {"tolerance", row.setting.tolerance}};
    for (const auto &[name, member] : setting_texts)
      json[name] = row.setting.*member;
    for (const auto &[name, member] : row_texts)
      json[name] = row.*member;
    for (const auto &[name, member] : row_numbers)
      json[name] = row.*member;
    return json.dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
  }

  TradeoffRow
  unpack_row(const std::string &line)
  {
    const Json json = Json::parse(line);
    TradeoffRow row;
    row.index                  = json.at("index");
    row.setting.degree         = json.at("degree");
    row.setting.cells          = json.at("cells");
    row.setting.mesh_tolerance = number(json.at("mesh_tolerance"));
    row.setting.tolerance      = number(json.at("tolerance"));
    for (const auto &[name, member] : setting_texts)
      row.setting.*member = json.at(name);
    for (const auto &[name, member] : row_texts)
      row.*member = json.at(name);
    for (const auto &[name, member] : row_numbers)
      row.*member = number(json.at(name));
    return row;
  }

  TradeoffRowWriter::TradeoffRowWriter(const std::filesystem::path &folder, const unsigned int rank)
    : path_(folder / "rows" / fmt::format("{}.jsonl", rank))
    , out_(path_, std::ios::app)
  {
  }

  void
  TradeoffRowWriter::write(const TradeoffRow &row)
  {
    out_ << pack(row) + "\n" << std::flush;
    if (!out_)
      throw FileError("cannot write \"" + path_.string() + "\" (is the disk full?)");
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
    {
      std::ifstream in(file);
      for (std::string line; std::getline(in, line);)
        try
        {
          if (!in.eof()) // the last line has its end, or it was cut off
          {
            const TradeoffRow row = unpack_row(line);
            rows.emplace(row.index, row);
          }
        }
        catch (const std::exception &)
        {
          // A line that the disk did not take as a whole: its setting is computed again.
        }
    }
    std::string all;
    for (const auto &[index, row] : rows)
      all += pack(row) + "\n";
    const auto kept = folder / "rows" / "kept.jsonl";
    write_file(kept, all);
    for (const auto &file : files)
      if (file != kept)
        std::filesystem::remove(file);
    return rows;
  }
} // namespace crawler
