// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/optimize/optimize_memory.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace crawler
{
  namespace
  {
    const std::string converged = "converged", stopped = "stopped";

    /// Visits the fields of a row in the order of the columns: describes, writes or reads them.
    class RowFields
    {
    public:
      RowFields() = default;
      RowFields(const Table &table, const unsigned long row)
        : table_(&table)
        , row_(row)
      {
      }

      std::vector<RowFile::Column> columns;
      RowFile::Row values; ///< values, if they are written

      void
      number(const RowFile::Column &column, double &value)
      {
        if (table_ != nullptr)
          value = std::get<std::vector<double>>(table_->at(columns.size()).values)[row_];
        columns.push_back(column);
        values.emplace_back(value);
      }
      /// Visits a whole number; a damaged one becomes the largest.
      template <typename Number>
      void
      whole(const RowFile::Column &column, Number &value)
      {
        auto real = static_cast<double>(value);
        number(column, real);
        value = real >= 0. && real < 0x1p32 ? static_cast<Number>(real) : static_cast<Number>(-1);
      }
      void
      text(const RowFile::Column &column, std::string &value)
      {
        if (table_ != nullptr)
          value = std::get<std::vector<std::string>>(table_->at(columns.size()).values)[row_];
        columns.push_back(column);
        values.emplace_back(shortened(value, column.width));
      }

    private:
      const Table *table_ = nullptr; ///< table, if the fields are read
      unsigned long row_  = 0;
    };

    /// Visits a gait of a start. The number of the case is too large if it is damaged.
    void
    exchange(
      RowFields &fields, const OptimizeNames &names, StartName &start, GaitRecord &record, const unsigned int width)
    {
      unsigned long number = start.number_of_case + 1;
      fields.whole({"case", "1", "number of the case"}, number);
      start.number_of_case           = std::min(number - 1, names.cases.size());
      const OptimizeNames::Case &its = names.cases[std::min(start.number_of_case, names.cases.size() - 1)];
      for (std::size_t i = 0; i < names.axes.size(); ++i)
        if (std::ranges::find(names.paths, names.axes[i]) == names.paths.end()) // otherwise the axis is only a start
        {
          std::string value  = its.values[i];
          std::size_t widest = 1;
          for (const OptimizeNames::Case &one : names.cases)
            widest = std::max(widest, one.values[i].size());
          fields.text({names.axes[i], "", "value of the axis in the case", static_cast<unsigned int>(widest)}, value);
        }
      fields.whole({"start", "1", "number of the start"}, start.start);
      record.x.resize(its.paths.size(), NAN); // stopped before there was a gait
      for (std::size_t i = 0; i < names.paths.size(); ++i)
      {
        double none      = NAN;
        const auto place = std::ranges::find(its.paths, names.paths[i]);
        fields.number({names.paths[i], names.units[i], "variable"},
                      place == its.paths.end() ? none : record.x[static_cast<std::size_t>(place - its.paths.begin())]);
      }
      if (std::isnan(record.x.front()))
        record.x.clear();
      fields.number({"objective", names.objective.unit, names.objective.name}, record.objective);
      for (std::size_t i = 0; i < gait_numbers.size(); ++i)
        fields.number({gait_numbers[i].column, gait_numbers[i].unit, ""}, record.numbers[i]);
      fields.number({"violation", "1", "excess over the limit that is exceeded most, relative to it"},
                    record.violation);
      fields.text({"problem", "", "why there is no gait", width}, record.problem);
    }

    /// Gait as written to the table.
    GaitRecord
    shown(GaitRecord record)
    {
      if (record.problem.empty() && !record.x.empty())
        return record;
      record.objective = record.violation = NAN;
      record.numbers.fill(NAN);
      return record;
    }

    void
    exchange(RowFields &fields, const OptimizeNames &names, StartName &start, double &number, GaitRecord &record)
    {
      constexpr unsigned int width = 256;
      fields.number({"evaluation", "1", "number of the evaluation in its start"}, number);
      exchange(fields, names, start, record, width);
    }

    /// Row of the evaluation of a start with this number.
    RowFields
    evaluation(const OptimizeNames &names, StartName start, double number, GaitRecord record)
    {
      RowFields fields;
      exchange(fields, names, start, number, record);
      return fields;
    }

    /// Visits a start, and the number of its evaluations, which are not in its row.
    void
    exchange(RowFields &fields, const OptimizeNames &names, StartResult &start, std::size_t &n_evaluations)
    {
      constexpr unsigned int width = 1024;
      std::string end              = start.has_converged ? converged : start.message;
      std::string status           = start.was_interrupted ? stopped : "finished";
      exchange(fields, names, start, start.best, width);
      fields.whole({"iterations", "1", "iterations of the optimiser"}, start.iterations);
      fields.whole({"evaluations", "1", "number of gaits that were evaluated"}, n_evaluations);
      fields.number({"seconds", "s", "wall time"}, start.seconds);
      fields.text({"optimiser", "", "how the optimiser ended", width}, end);
      fields.text({"exceeded limit", "", "limit that is exceeded most", 32}, start.best.worst_limit);
      for (const std::string &name : names.limits)
      {
        const auto known = std::ranges::find(start.limits, name, &GaitLimit::name);
        GaitLimit limit  = known == start.limits.end() ? GaitLimit{name, NAN, NAN} : *known;
        fields.number({"limit of " + name, "", "value of the limit"}, limit.value);
        fields.number({"multiplier of " + name, "", "gain of the objective for one unit more of the limit"},
                      limit.multiplier);
        if (known == start.limits.end() && !std::isnan(limit.value))
          start.limits.push_back(limit);
      }
      fields.number({"admissible", "1", "largest admissible violation of a limit, relative to it"}, start.admissible);
      fields.whole({"neighbour", "1", "number of the case from whose best gait the search continued; 0: none"},
                   start.neighbour);
      fields.text({"status", "", "finished or stopped; empty: there is no row", 16}, status);
      start.has_converged   = end == converged;
      start.message         = start.has_converged ? "" : end;
      start.was_interrupted = status == stopped;
    }

    /// Table of numbered rows with these columns.
    PointTable
    table_of(const std::string &file,
             const std::string &group,
             const std::vector<RowFile::Column> &own,
             const OptimizeCases &cases)
    {
      PointTable table = {file, group, {{"index", "1", "number of the row"}}, cases.points().effective(), 0};
      table.columns.insert(table.columns.end(), own.begin(), own.end());
      table.known = {1, [](std::size_t, const unsigned long row) { return static_cast<double>(row); }};
      table.grows = true;
      return table;
    }

    std::vector<RowFile::Column>
    start_columns(const OptimizeNames &names)
    {
      RowFields fields;
      StartResult any;
      std::size_t none = 0;
      exchange(fields, names, any, none);
      return fields.columns;
    }

    std::vector<RowFile::Column>
    evaluation_columns(const OptimizeNames &names)
    {
      return evaluation(names, {}, 0., {}).columns;
    }

    using Evaluations = std::map<std::pair<unsigned long, unsigned long>, std::vector<GaitRecord>>;

    /// Reads the evaluations that are whole, by case and start.
    Evaluations
    read_evaluations(const OptimizeNames &names, const std::filesystem::path &path)
    {
      const RowReader rows(MPI_COMM_SELF, path, OptimizeMemory::evaluations_group);
      const unsigned long n = rows.n_rows();
      const auto intact     = rows.intact(evaluation_columns(names), 0, n);
      Table table           = rows.read(0, n);
      table.erase(table.begin()); // index
      Evaluations all;
      for (unsigned long row = 0; row < n; ++row)
      {
        RowFields fields(table, row);
        StartName name;
        double number = 0.;
        GaitRecord record;
        exchange(fields, names, name, number, record);
        if (name.number_of_case == names.cases.size() || (intact && !(*intact)[row]))
          continue;
        auto &list = all[{name.number_of_case, name.start}];
        if (number == 0.) // possibly preceded by a search that was broken off
          list.clear();
        if (number == static_cast<double>(list.size()))
          list.push_back(std::move(record));
      }
      return all;
    }
  } // namespace

  OptimizeMemory::OptimizeMemory(const OptimizeCases &cases, StudyFolder &folder, const ParameterFile &parameter_file)
    : names_(cases.names())
    , folder_(folder)
    , start_rows_{table_of(file, group, start_columns(names_), cases)}
    , evaluation_rows_{table_of(evaluations_file, evaluations_group, evaluation_columns(names_), cases)}
  {
    start_rows_.table.inputs = sweep_inputs(cases.points());
    const auto done          = begin_or_resume(folder, start_rows_.table, parameter_file);
    if (std::ranges::count(done, true) > 0)
    {
      const RowReader rows(MPI_COMM_SELF, folder_.path / file, group);
      Evaluations evaluations = read_evaluations(names_, folder_.path / evaluations_file);
      Table table             = rows.read(0, rows.n_rows());
      table.erase(table.begin()); // index
      unsigned long n_damaged = 0;
      for (unsigned long row = 0; row < done.size(); ++row)
        if (done[row])
        {
          RowFields fields(table, row);
          StartResult start;
          std::size_t n = 0;
          exchange(fields, names_, start, n);
          start.records = std::move(evaluations[{start.number_of_case, start.start}]);
          if (start.number_of_case < names_.cases.size() && start.records.size() == n)
            starts_.push_back(std::move(start));
          else
            ++n_damaged;
        }
      if (n_damaged > 0)
        folder.log.warn(fmt::format(
          "warning: the evaluations of {} differ from what was written, so {} was damaged; they are computed again",
          counted(n_damaged, "start"),
          evaluations_file));
    }
    write_all(/*with_room=*/true);
  }

  const StartResult *
  OptimizeMemory::find(const StartName &start) const
  {
    const auto found = std::ranges::find_if(starts_, [&](const StartName &one) { return one == start; });
    return found == starts_.end() ? nullptr : &*found;
  }

  void
  OptimizeMemory::keep(StartResult start)
  {
    const bool is_new = std::erase_if(starts_, [&](const StartName &one) { return one == start; }) == 0;
    const bool fits   = start_rows_.n < start_rows_.table.n_rows &&
                      evaluation_rows_.n + start.records.size() <= evaluation_rows_.table.n_rows;
    starts_.push_back(std::move(start));
    if (is_new && fits)
      write(starts_.back());
    else
      write_all(/*with_room=*/true);
  }

  void
  OptimizeMemory::arrange(const std::vector<StartName> &starts)
  {
    std::vector<StartResult> arranged;
    for (const StartName &name : starts)
      if (const StartResult *const start = find(name))
        arranged.push_back(*start);
    starts_ = std::move(arranged);
    write_all(/*with_room=*/false);
    for (Rows *const rows : {&evaluation_rows_, &start_rows_})
    {
      rows->rows.reset();
      write_table_csv(MPI_COMM_SELF, folder_.path / rows->table.file, rows->table.group);
    }
  }

  void
  OptimizeMemory::open(Rows &rows, const std::string &ending) const
  {
    const PointTable &table = rows.table;
    rows.rows               = std::make_unique<RowFile>(
      MPI_COMM_SELF, folder_.path / (table.file + ending), table.group, table.written_columns());
  }

  void
  OptimizeMemory::append(Rows &rows, const std::span<const RowFile::Row> more)
  {
    rows.rows->write(rows.n, more);
    rows.n += more.size();
  }

  void
  OptimizeMemory::write_all(const bool with_room)
  {
    const std::string fresh = ".part"; // new files are written beside the former ones, so that a kill loses nothing
    unsigned long n         = 0;
    for (const StartResult &start : starts_)
      n += start.records.size();
    const auto with_more = [&](const unsigned long own, const unsigned long least) {
      return own + (with_room ? std::max(own, least) : 0);
    };
    start_rows_.table.n_rows      = with_more(starts_.size(), 16);
    evaluation_rows_.table.n_rows = with_more(n, 1024);
    for (Rows *const rows : {&evaluation_rows_, &start_rows_})
    {
      PointTable table = rows->table;
      table.file += fresh;
      create_table(folder_, table);
      rows->n = 0;
      open(*rows, fresh);
    }
    for (const StartResult &start : starts_)
      write(start);
    for (Rows *const rows : {&evaluation_rows_, &start_rows_})
    {
      rows->rows.reset();
      rename_whole(folder_.path / (rows->table.file + fresh), folder_.path / rows->table.file);
      open(*rows, "");
    }
  }

  void
  OptimizeMemory::write(const StartResult &start)
  {
    std::vector<RowFile::Row> rows;
    for (const GaitRecord &record : start.records)
      rows.push_back(evaluation(names_, start, static_cast<double>(rows.size()), shown(record)).values);
    append(evaluation_rows_, rows);
    StartResult written = start;
    written.best        = shown(start.best);
    std::size_t n       = rows.size();
    RowFields fields;
    exchange(fields, names_, written, n);
    append(start_rows_, {{fields.values}});
  }
} // namespace crawler
