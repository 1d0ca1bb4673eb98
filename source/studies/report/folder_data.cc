// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/row_file.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/report/folder_data.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    bool
    is_there(const fs::path &file)
    {
      std::error_code error;
      return fs::is_regular_file(file, error);
    }

    std::optional<ParameterFile>
    effective_parameters(const fs::path &folder)
    {
      const fs::path file = folder / "parameters.prm";
      return is_there(file) ? std::optional(ParameterFile::from_text(read_whole_file(file), file.string()))
                            : std::nullopt;
    }

    /// A positive number of parameters.prm; 1 if it is not known.
    double
    scale_in(const std::optional<ParameterFile> &file, const std::string &path)
    {
      const Assignment *entry = file ? file->assignment_of(path) : nullptr;
      return entry != nullptr ? to_number(entry->value).value_or(1.) : 1.;
    }

    /// Some rows of a table, evenly, and the last one.
    Json
    packed_rows(const Table &table, const std::size_t most)
    {
      Json columns = Json::array();
      for (const Column &column : table)
      {
        const auto &all          = std::get<std::vector<double>>(column.values);
        const std::size_t stride = all.size() / most + 1;
        std::vector<double> some;
        for (std::size_t i = 0; i < all.size(); i += stride)
          some.push_back(all[i]);
        if (!all.empty() && (all.size() - 1) % stride != 0)
          some.push_back(all.back());
        columns.push_back(packed(Column{column.name, column.unit, column.description, some}));
      }
      return columns;
    }

    /// The factor c(x) of the ground where the body has been; null where it is 1 everywhere or not known here.
    Json
    ground_data(const ParameterFile &file, const KymographTable &kymograph, const double length)
    {
      constexpr std::size_t n_places = 400;
      constexpr double margin        = 0.3; // on both sides, of the length
      const auto displacement =
        std::ranges::find(kymograph.fields, "displacement", [](const auto &f) { return f.first; });
      const Assignment *profile = file.assignment_of("Ground/Profile");
      if (profile == nullptr || profile->value == "1" || displacement == kymograph.fields.end())
        return nullptr;
      const auto [low, high] = std::ranges::minmax(displacement->second);
      std::vector<double> places;
      for (std::size_t i = 0; i < n_places; ++i)
        places.push_back(
          std::lerp(low - margin * length, high + (1. + margin) * length, static_cast<double>(i) / (n_places - 1)));
      try
      {
        const Parameters parameters = Form(file).parameters;
        const Ground ground         = create_ground(parameters.ground, parameters.body, parameters.time.end_time);
        std::vector<double> values  = profile_at(ground.profile, places);
        return {{"places", packed(Column{"x", "length", "", places})},
                {"factor", packed(Column{"c", "1", "", values})}};
      }
      catch (const InputError &) // a table that is elsewhere now, or entries of another version
      {
        return nullptr;
      }
    }
    /// Every so many rows of a column.
    Column
    some_rows(const RowReader &reader, const std::size_t number, const unsigned long stride)
    {
      constexpr unsigned long rows_at_once = 20000;
      Column some;
      for (unsigned long first = 0; first < reader.n_rows(); first += rows_at_once)
      {
        Column part    = reader.read(number, first, std::min(rows_at_once, reader.n_rows() - first));
        const auto add = [&](auto &values) {
          using Values = std::decay_t<decltype(values)>;
          if (first == 0)
            some = {part.name, part.unit, part.description, Values()};
          for (std::size_t i = 0; i < values.size(); ++i)
            if ((first + i) % stride == 0)
              std::get<Values>(some.values).push_back(std::move(values[i]));
        };
        std::visit(add, part.values);
      }
      return some;
    }

    /// Which columns matter most where there is no place for all: what was varied and how it ended; the displacement
    /// and other numbers with error bounds; the rest; the bounds of these, and messages.
    unsigned int
    rank_of(const Column &column)
    {
      if (column.description.starts_with("axis of the ") || column.description == "variable")
        return 0;
      const std::string &name = column.name;
      const bool is_text      = std::holds_alternative<std::vector<std::string>>(column.values);
      if (name == "message" || name == "explanation" || name.starts_with("errors.") ||
          name.starts_with("sensitivities."))
        return 4;
      if (is_text || name == "index" || name == "displacement" || name == "displacement_error.total")
        return 1;
      return std::ranges::any_of(entries_with_errors(), [&](const ResultEntry *entry) { return entry->key == name; })
               ? 2
               : 3;
    }
  } // namespace

  Json
  summary_data(const fs::path &folder)
  {
    const fs::path file = folder / "summary.json";
    if (!is_there(file))
      return nullptr;
    Json json = Json::parse(read_whole_file(file), nullptr, /*allow_exceptions=*/false);
    if (!json.is_object() || !json.contains("status"))
      throw InputError("\"" + file.string() + "\" is damaged: a JSON object with the key \"status\" is expected");
    return json;
  }

  Json
  parameter_data(const fs::path &folder)
  {
    Json json       = {{"entries", Json::array()}, {"original", nullptr}, {"effective", nullptr}};
    const auto file = effective_parameters(folder);
    if (is_there(folder / "original.prm"))
      json["original"] = read_whole_file(folder / "original.prm");
    if (!file)
      return json;
    json["effective"] = without_comments(file->text());
    Parameters parameters;
    Declarations declarations;
    parameters.count_terms(*file);
    parameters.add_parameters(declarations);
    for (const Assignment &one : file->assignments())
    {
      const auto &known = declarations.entries();
      const auto entry  = std::ranges::find(known, one.path, &EntryInfo::path);
      if (entry == known.end()) // of another version
        json["entries"].push_back(
          {{"entry", one.path}, {"value", one.value}, {"default", ""}, {"unit", ""}, {"meaning", ""}});
      else if (entry->default_value != one.value)
        json["entries"].push_back({{"entry", one.path},
                                   {"value", one.value},
                                   {"default", entry->default_value},
                                   {"unit", entry->unit},
                                   {"meaning", entry->documentation}});
    }
    return json;
  }

  Json
  unit_data(const fs::path &folder)
  {
    UnitNames units;
    if (const auto file = effective_parameters(folder))
      for (auto *const name : {&units.length, &units.time, &units.force})
        if (const Assignment *own = file->assignment_of(name == &units.length ? "Units/Length"
                                                        : name == &units.time ? "Units/Time"
                                                                              : "Units/Force"))
          *name = own->value;
    Json json;
    for (const char *unit : {"length", "time", "force", "energy"})
      json[unit] = units.of(unit);
    return json;
  }

  Json
  run_data(const fs::path &folder, const std::string &title, const std::size_t most_rows)
  {
    constexpr std::size_t most_steps = 2000;
    const auto parameters            = effective_parameters(folder);
    const double length              = scale_in(parameters, "Body/Length");
    Json json                        = {{"title", title},
                                        {"summary", summary_data(folder)},
                                        {"length", length},
                                        {"end_time", scale_in(parameters, "Time/End time")},
                                        {"statistics", nullptr},
                                        {"kymograph", nullptr},
                                        {"ground", nullptr},
                                        {"along_body", nullptr}};
    if (is_there(folder / "statistics.csv"))
      json["statistics"] = packed_rows(read_csv_table(folder / "statistics.csv"), most_steps);
    if (is_there(folder / "sensitivity_body.csv"))
      json["along_body"] = packed_rows(read_csv_table(folder / "sensitivity_body.csv"), most_steps);
    if (is_there(folder / "kymograph.vts"))
    {
      const KymographTable kymograph = read_kymograph(folder / "kymograph.vts");
      json["kymograph"]              = packed(kymograph, most_rows);
      if (parameters)
        json["ground"] = ground_data(*parameters, kymograph, length);
    }
    return json;
  }

  Json
  table_data(const fs::path &file, const std::string &group)
  {
    constexpr unsigned long most_rows = 200000;
    constexpr std::size_t most_bytes  = 9000000; // so that the page stays below 10 MB
    const RowReader reader(MPI_COMM_SELF, file, group);
    const unsigned long n_rows = reader.n_rows();
    // A stride that has no divisor in common with the number of rows does not take the same value of an axis each time.
    unsigned long stride = (n_rows + most_rows - 1) / most_rows;
    while (stride > 1 && std::gcd(stride, n_rows) != 1)
      ++stride;
    Json json = {{"all_rows", n_rows}, {"rows", 0}, {"columns", Json::array()}, {"left_out", Json::array()}};
    std::map<unsigned int, std::vector<Json>> by_rank;
    for (std::size_t number = 0; number < reader.n_columns(); ++number)
    {
      const Column all    = some_rows(reader, number, stride);
      json["rows"]        = std::visit([](const auto &values) { return values.size(); }, all.values);
      Json column         = packed(all, rank_of(all) == 0);
      const auto &values  = column.contains("values") ? column["values"] : Json();
      const bool is_empty = values.size() == 1 && values[0].is_null();
      if (is_empty)
        continue;
      by_rank[rank_of(all)].push_back(std::move(column));
    }
    std::size_t bytes = 0;
    for (auto &[rank, columns] : by_rank)
      for (Json &column : columns)
      {
        const std::size_t size = column.dump().size();
        if (bytes + size > most_bytes)
          json["left_out"].push_back(column["name"]);
        else
        {
          bytes += size;
          json["columns"].push_back(std::move(column));
        }
      }
    return json;
  }
} // namespace crawler
