// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/point_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

namespace crawler
{

  namespace
  {
    constexpr unsigned long rows_together = 1 << 16;
    const std::string status              = "status"; // column of texts that is written last

    std::string
    text_of(const Column &column, const unsigned long row)
    {
      if (const auto *texts = std::get_if<std::vector<std::string>>(&column.values))
        return (*texts)[row];
      return to_text(std::get<std::vector<double>>(column.values)[row]);
    }

    std::string
    text_of(const RowFile::Value &value)
    {
      const auto *text = std::get_if<std::string>(&value);
      return text != nullptr ? *text : to_text(std::get<double>(value));
    }

    /// First row whose known value differs from that of the table, in words; nothing if there is none.
    std::string
    changed_value(const RowReader &table, const std::vector<RowFile::Column> &columns, const RowFile::Known &known)
    {
      for (std::size_t i = 1; i < known.n_columns; ++i)
        for (unsigned long first = 0; first < table.n_rows(); first += rows_together)
        {
          const unsigned long n = std::min(rows_together, table.n_rows() - first);
          const Column column   = table.read(table.index_of(columns[i].name), first, n);
          for (unsigned long row = 0; row < n; ++row)
          {
            const std::string was = text_of(column, row), is = text_of(known.value(i, first + row));
            // Texts longer than their column were cut.
            if (was != is && !(columns[i].width > 0 && is.size() > columns[i].width && is.starts_with(was)))
              return fmt::format("{} of point {} was \"{}\" and is \"{}\"", columns[i].name, first + row, was, is);
          }
        }
      return "";
    }

    /// Rows of @p table that exist and are whole; damaged ones are logged as a warning.
    std::vector<bool>
    rows_done(const RowReader &rows, const PointTable &table, Log &log)
    {
      unsigned long n_damaged = 0;
      constexpr double larger = 1.2;
      std::vector<bool> done;
      for (unsigned long first = 0; first < rows.n_rows(); first += rows_together)
      {
        const unsigned long n = std::min(rows_together, rows.n_rows() - first);
        const auto column     = [&](const std::string &name) { return rows.read(rows.index_of(name), first, n); };
        const Column is_done  = column(status);
        for (unsigned long i = 0; i < n; ++i)
          done.push_back(!text_of(is_done, i).empty());
        if (const auto intact = rows.intact(table.written_columns(), first, n))
          for (unsigned long i = 0; i < n; ++i)
            if (done[first + i] && !(*intact)[i])
            {
              done[first + i] = false;
              ++n_damaged;
            }
        for (const auto &[reason_name, seconds_name] : table.reasons_and_seconds)
        {
          const Column reason = column(reason_name), seconds = column(seconds_name);
          for (unsigned long i = 0; i < n; ++i)
            if (text_of(reason, i) == time_limit_reason &&
                table.time_limit > larger * std::get<std::vector<double>>(seconds.values)[i])
              done[first + i] = false;
        }
      }
      if (n_damaged > 0)
        log.warn(
          fmt::format("warning: {} of the table {} not what was written, so the file was damaged; {} computed again",
                      counted(n_damaged, "row"),
                      n_damaged == 1 ? "is" : "are",
                      n_damaged == 1 ? "it is" : "they are"));
      return done;
    }

    /// Warns that rows of other versions of the libraries may differ from those computed now.
    void
    warn_of_other_versions(StudyFolder &folder, const PointTable &table)
    {
      for (const auto &[name, version] : provenance("", ""))
        if (name.starts_with("version of "))
          if (const std::string was = read_attribute(folder.path / table.file, table.group, name); was != version)
            folder.log.warn(fmt::format("warning: the {} was {} when the {} began and is now {}: new rows may differ "
                                        "from old ones by round-off or more",
                                        name,
                                        was,
                                        folder.kind.name,
                                        version));
    }
  } // namespace

  RowFile::Value
  value_in_row(const Task &task, const ResultEntry &entry)
  {
    const SimulationResult &result = task.computed.result;
    const ResultValue value = task.error || result.time.status == Status::none ? ResultValue() : entry.value_in(result);
    if (entry.is_word)
      return std::get<std::string>(value.index() == 0 ? ResultValue(std::string()) : value);
    if (const auto *number = std::get_if<double>(&value))
      return std::isfinite(*number) ? *number : NAN;
    if (const auto *count = std::get_if<unsigned long>(&value))
      return static_cast<double>(*count);
    return NAN;
  }

  std::vector<RowFile::Column>
  PointTable::written_columns() const
  {
    std::vector<RowFile::Column> list(columns.begin() + static_cast<std::ptrdiff_t>(known.n_columns), columns.end());
    std::stable_partition(
      list.begin(), list.end(), [&](const RowFile::Column &column) { return column.name != status; });
    return list;
  }

  std::vector<RowFile::Column>
  axis_columns(const SweepDesign &design, const Declarations &declarations)
  {
    constexpr unsigned int max_axis_width = 256;
    std::vector<RowFile::Column> columns  = {{"index", "1", "number of the point", 0}};
    for (const SweepAxis &axis : design.axes())
    {
      const std::string unit = axis.is_file() ? "" : declarations.info(axis.entry).unit;
      bool is_number         = true;
      std::size_t widest     = 1;
      for (const std::string &value : axis.values)
      {
        is_number = is_number && to_number(value).has_value();
        widest    = std::max(widest, value.size());
      }
      columns.push_back({axis.entry,
                         unit,
                         "axis of the sweep",
                         is_number ? 0 : std::min(static_cast<unsigned int>(widest), max_axis_width)});
    }
    return columns;
  }

  RowFile::Known
  known_columns(const std::vector<RowFile::Column> &columns, const SweepDesign &design)
  {
    return {1 + design.axes().size(),
            [columns, &design](const std::size_t column, const unsigned long point) -> RowFile::Value {
              if (column == 0)
                return static_cast<double>(point);
              const std::string text = design.value(column - 1, point);
              if (columns[column].width > 0)
                return text;
              return *to_number(text);
            }};
  }

  std::map<std::string, std::string>
  PointTable::attributes(const std::string &command_line) const
  {
    auto result         = provenance(effective, command_line);
    result["not known"] = "NaN in numbers, an empty text in texts, also of the status of what is not computed yet";
    result.insert(inputs.begin(), inputs.end());
    result.insert(others.begin(), others.end());
    return result;
  }

  void
  create_table(const StudyFolder &folder, const PointTable &table)
  {
    const auto attributes = table.attributes(folder.options.command_line);
    RowFile::create(folder.path / table.file, table.group, table.columns, table.n_rows, attributes, table.known);
  }

  std::vector<bool>
  begin_or_resume(StudyFolder &folder, const PointTable &table, const ParameterFile &file)
  {
    const auto path = folder.path / table.file;
    if (!folder.begin(file.text(), table.effective))
    {
      create_table(folder, table);
      return std::vector<bool>(table.n_rows, false);
    }
    std::optional<RowReader> rows;
    folder.resume([&]() {
      rows.emplace(MPI_COMM_SELF, path, table.group);
      const auto attribute = [&](const std::string &name) { return read_attribute(path, table.group, name); };
      const auto &free     = folder.kind.free_entries;
      const auto has_columns =
        std::ranges::equal(rows->read(0, 0), table.columns, {}, &Column::name, &RowFile::Column::name);
      std::vector<std::string> changes;
      if (has_columns)
      {
        SweepInputs before;
        for (const auto &[name, text] : table.inputs)
          before.emplace(name, attribute(name));
        changes = differences(before, table.inputs, free);
      }
      else if (changes = differences(attribute("parameters.prm"), table.inputs.at("parameters.prm"), free);
               changes.empty())
        changes.emplace_back("its table has the columns of another version of the program");
      if (changes.empty() && !table.grows && rows->n_rows() != table.n_rows)
        changes.push_back(fmt::format("the number of points was {} and is {}", rows->n_rows(), table.n_rows));
      if (changes.empty())
        if (const std::string changed = changed_value(*rows, table.columns, table.known); !changed.empty())
          changes.push_back(changed);
      return changes;
    });
    warn_of_other_versions(folder, table);
    return rows_done(*rows, table, folder.log);
  }

  std::vector<bool>
  points_done(MPI_Comm communicator, const std::function<std::vector<bool>()> &list)
  {
    const std::string flags = on_first_rank(communicator, [&]() {
      const std::vector<bool> own = list();
      return std::string(own.begin(), own.end());
    });
    return {flags.begin(), flags.end()};
  }

  void
  write_table_csv(MPI_Comm communicator, const std::filesystem::path &table_path, const std::string &group)
  {
    const auto csv                   = std::filesystem::path(table_path).replace_extension("csv");
    constexpr unsigned long together = 256; // rows of each rank, a quarter of a megabyte
    const RowReader table(communicator, table_path, group);
    const unsigned long n_ranks = size_of(communicator), rank = rank_of(communicator);
    std::ofstream file;
    std::filesystem::path temporary;
    on_first_rank(communicator, [&]() {
      temporary = temporary_file(csv);
      file.open(temporary);
      file << csv_names(table.read(0, 0));
    });
    for (unsigned long round = 0; round < table.n_rows(); round += n_ranks * together)
    {
      const unsigned long first = std::min(round + rank * together, table.n_rows());
      const Table part          = table.read(first, std::min(together, table.n_rows() - first));
      for (const std::string &rows : gather(csv_rows(part), communicator))
        file << rows;
    }
    on_first_rank(communicator, [&]() {
      file.close();
      if (!file)
      {
        std::error_code error;
        std::filesystem::remove(temporary, error);
        throw FileError("cannot write \"" + csv.string() + "\" (is the disk full?)");
      }
      rename_whole(temporary, csv);
    });
  }
} // namespace crawler
