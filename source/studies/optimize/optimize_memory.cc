// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/optimize/optimize_cases.h>
#include <crawler/studies/optimize/optimize_memory.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace crawler
{
  namespace
  {
    constexpr double not_known           = std::numeric_limits<double>::quiet_NaN();
    constexpr unsigned int problem_width = 256, start_problem_width = 1024;
    const std::string evaluations_file = "results.h5", evaluations_group = "optimize";
    const RowFile::Column index_column = {"index", "1", "number of the row"};

    /// In the order of GaitNumber.
    const std::array<RowFile::Column, n_gait_numbers> number_columns = {{{"displacement", "length", ""},
                                                                         {"stress_power", "energy", ""},
                                                                         {"positive_power", "energy", ""},
                                                                         {"mean_square_strain", "1", ""},
                                                                         {"speed", "length/time", ""},
                                                                         {"friction_time", "time^2/(force length)", ""},
                                                                         {"dissipation", "energy", ""},
                                                                         {"efficiency", "1", ""}}};

    /// In the order of GaitProblem::limits().
    constexpr std::array<const char *, 8> limit_names = {{"Work",
                                                          "Positive work",
                                                          "Dissipation",
                                                          "Mean-square strain",
                                                          "Smallest strain",
                                                          "Largest strain",
                                                          "Largest stress",
                                                          "Largest stress rate"}};

    /// The axes that have columns of their own: an axis that is a variable is only a start.
    std::vector<std::size_t>
    shown_axes(const OptimizeNames &names)
    {
      std::vector<std::size_t> shown;
      for (std::size_t i = 0; i < names.axes.size(); ++i)
        if (std::ranges::find(names.paths, names.axes[i]) == names.paths.end())
          shown.push_back(i);
      return shown;
    }

    /// Columns of a record (GaitRecord), and its values in them.
    std::vector<RowFile::Column>
    record_columns(const OptimizeNames &names, const unsigned int width)
    {
      std::vector<RowFile::Column> columns = {{"case", "1", "number of the case"}};
      for (const std::size_t i : shown_axes(names))
      {
        std::size_t widest = 1;
        for (const OptimizeNames::Case &one : names.cases)
          widest = std::max(widest, one.values[i].size());
        columns.push_back({names.axes[i], "", "of the case", static_cast<unsigned int>(widest)});
      }
      columns.push_back({"start", "1", "number of the start"});
      for (std::size_t i = 0; i < names.paths.size(); ++i)
        columns.push_back({names.paths[i], names.units[i], "variable"});
      columns.push_back({"objective", names.unit, names.objective});
      columns.insert(columns.end(), number_columns.begin(), number_columns.end());
      columns.push_back({"violation", "1", "of the limit that is exceeded most, relative to it"});
      columns.push_back({"problem", "", "why there is no gait", width});
      return columns;
    }

    RowFile::Row
    record_row(const OptimizeNames &names, const StartName &start, const GaitRecord &record, const unsigned int width)
    {
      const OptimizeNames::Case &its = names.cases[start.number_of_case];
      const bool is_gait             = record.problem.empty() && !record.x.empty();
      RowFile::Row row               = {static_cast<double>(start.number_of_case + 1)};
      for (const std::size_t i : shown_axes(names))
        row.emplace_back(its.values[i]);
      row.emplace_back(static_cast<double>(start.start));
      for (const std::string &path : names.paths)
      {
        const auto place = static_cast<std::size_t>(std::ranges::find(its.paths, path) - its.paths.begin());
        row.emplace_back(place < record.x.size() ? record.x[place] : not_known);
      }
      row.emplace_back(is_gait ? record.objective : not_known);
      for (const double number : record.numbers)
        row.emplace_back(is_gait ? number : not_known);
      row.emplace_back(is_gait ? record.violation : not_known);
      row.emplace_back(shortened(record.problem, width));
      return row;
    }

    /// Columns of a start (StartResult), and its values in them; those of its best gait come first. Users see them up
    /// to the one that says how the optimiser ended.
    const std::string optimiser_column = "optimiser", stopped_status = "stopped";

    std::vector<RowFile::Column>
    start_columns(const OptimizeNames &names)
    {
      std::vector<RowFile::Column> columns    = record_columns(names, start_problem_width);
      const std::vector<RowFile::Column> more = {
        {"iterations", "1", "of the optimiser"},
        {"evaluations", "1", "of gaits"},
        {"seconds", "s", "wall time"},
        {optimiser_column, "", "how it ended", start_problem_width},
        {"exceeded limit", "", "that is exceeded most", 32},
        {"admissible", "1", "violation of a limit, relative to it"},
        {"origin", "1", "mark of the gait of a neighbour from which the search began; 0: of none"},
        {"first evaluation", "1", "its row in results.h5"}};
      columns.insert(columns.end(), more.begin(), more.end());
      for (const std::string name : limit_names)
      {
        columns.push_back({"limit of " + name, "", "as it was set"});
        columns.push_back({"multiplier of " + name, "", "objective for one unit more"});
      }
      columns.push_back({"status", "", "finished or stopped; empty: there is no row", 16});
      return columns;
    }

    RowFile::Row
    start_row(const OptimizeNames &names, const StartResult &start, const unsigned long first_evaluation)
    {
      RowFile::Row row = record_row(names, start, start.best, start_problem_width);
      row.emplace_back(static_cast<double>(start.iterations));
      row.emplace_back(static_cast<double>(start.records.size()));
      row.emplace_back(start.seconds);
      row.emplace_back(start.has_converged ? "converged" : shortened(start.message, start_problem_width));
      row.emplace_back(start.best.worst_limit);
      row.emplace_back(start.admissible);
      row.emplace_back(static_cast<double>(start.origin));
      row.emplace_back(static_cast<double>(first_evaluation));
      for (const char *name : limit_names)
      {
        const auto limit = std::ranges::find(start.limits, name, &GaitLimit::name);
        row.emplace_back(limit == start.limits.end() ? not_known : limit->value);
        row.emplace_back(limit == start.limits.end() ? not_known : limit->multiplier);
      }
      row.emplace_back(start.was_interrupted ? stopped_status : "finished");
      return row;
    }

    /// Reads a row of a table from left to right.
    struct RowWords
    {
      const Table &table;
      const unsigned long row;
      std::size_t next = 0;

      double
      number()
      {
        return std::get<std::vector<double>>(table.at(next++).values)[row];
      }
      unsigned long
      index()
      {
        const double value = number();
        return value >= 0. && value < 0x1p53 ? static_cast<unsigned long>(value) : ~0ul;
      }
      const std::string &
      text()
      {
        return std::get<std::vector<std::string>>(table.at(next++).values)[row];
      }
    };

    /// What record_row() wrote; the case is ~0 if there is none of this number.
    std::pair<StartName, GaitRecord>
    read_record(const OptimizeNames &names, RowWords &words)
    {
      StartName name;
      GaitRecord record{};
      name.number_of_case = words.index() - 1;
      words.next += shown_axes(names).size();
      name.start = words.index();
      std::vector<double> x;
      for (std::size_t i = 0; i < names.paths.size(); ++i)
        x.push_back(words.number());
      if (name.number_of_case < names.cases.size())
        for (const std::string &path : names.cases[name.number_of_case].paths)
          record.x.push_back(x[static_cast<std::size_t>(std::ranges::find(names.paths, path) - names.paths.begin())]);
      else
        name.number_of_case = ~0ul;
      if (std::ranges::all_of(record.x, [](const double value) { return std::isnan(value); }))
        record.x.clear(); // stopped before there was a gait
      record.objective = words.number();
      for (double &number : record.numbers)
        number = words.number();
      record.violation = words.number();
      record.problem   = words.text();
      return {name, record};
    }

    /// What start_row() wrote, but for the evaluations; and the row of the first one, and how many there are.
    struct StoredStart
    {
      StartResult start;
      unsigned long first_evaluation, n_evaluations;
    };

    StoredStart
    read_start(const OptimizeNames &names, RowWords words)
    {
      const auto [name, best] = read_record(names, words);
      StoredStart stored{};
      StartResult &start              = stored.start;
      static_cast<StartName &>(start) = name;
      start.best                      = best;
      start.iterations                = static_cast<unsigned int>(words.index());
      stored.n_evaluations            = words.index();
      start.seconds                   = words.number();
      start.message                   = words.text();
      start.has_converged             = start.message == "converged";
      if (start.has_converged)
        start.message.clear();
      start.best.worst_limit  = words.text();
      start.admissible        = words.number();
      start.origin            = words.index();
      stored.first_evaluation = words.index();
      for (const char *limit : limit_names)
      {
        const double value = words.number(), multiplier = words.number();
        if (!std::isnan(value))
          start.limits.push_back({limit, value, multiplier});
      }
      start.was_interrupted = words.text() == stopped_status;
      return stored;
    }

    /// Rows in these columns as a table, numbered if @p has_index.
    Table
    table_of(std::vector<RowFile::Column> columns, const std::vector<RowFile::Row> &rows, const bool has_index)
    {
      Table table;
      for (std::size_t i = 0; i < columns.size(); ++i)
      {
        table.push_back({columns[i].name, columns[i].unit, columns[i].description, {}});
        std::vector<double> numbers;
        std::vector<std::string> texts;
        for (const RowFile::Row &row : rows)
          if (columns[i].width == 0)
            numbers.push_back(std::get<double>(row[i]));
          else
            texts.push_back(std::get<std::string>(row[i]));
        if (columns[i].width == 0)
          table.back().values = std::move(numbers);
        else
          table.back().values = std::move(texts);
      }
      const auto is_empty = [](const Column &column) {
        return std::ranges::find(number_columns, column.name, &RowFile::Column::name) != number_columns.end() &&
               std::ranges::none_of(std::get<std::vector<double>>(column.values),
                                    [](const double one) { return std::isfinite(one) && one != 0.; });
      };
      std::erase_if(table, is_empty);
      std::vector<double> index;
      while (has_index && index.size() < rows.size())
        index.push_back(static_cast<double>(index.size()));
      if (has_index)
        table.insert(table.begin(), {index_column.name, index_column.unit, index_column.description, index});
      return table;
    }

    /// Numbers that nobody asked for are 0 in all gaits.
    void
    leave_out_unknown_numbers(std::vector<StartResult> &starts)
    {
      for (std::size_t i = 0; i < n_gait_numbers; ++i)
      {
        const auto has_it = [i](const GaitRecord &record) {
          return record.problem.empty() && std::isfinite(record.numbers[i]) && record.numbers[i] != 0.;
        };
        if (std::ranges::none_of(starts,
                                 [&](const StartResult &start) { return std::ranges::any_of(start.records, has_it); }))
          for (StartResult &start : starts)
            for (GaitRecord &record : start.records)
              record.numbers[i] = start.best.numbers[i] = not_known;
      }
    }

    std::vector<RowFile::Column>
    evaluation_columns(const OptimizeNames &names)
    {
      std::vector<RowFile::Column> columns = {{"evaluation", "1", "number of the evaluation in its start"}};
      std::ranges::move(record_columns(names, problem_width), std::back_inserter(columns));
      return columns;
    }

    std::vector<RowFile::Row>
    evaluation_rows(const OptimizeNames &names, const StartResult &start)
    {
      std::vector<RowFile::Row> rows;
      for (const GaitRecord &record : start.records)
      {
        rows.push_back(record_row(names, start, record, problem_width));
        rows.back().insert(rows.back().begin(), static_cast<double>(rows.size() - 1));
      }
      return rows;
    }

    RowFile::Value
    index_of_row(std::size_t /*column*/, const unsigned long row)
    {
      return static_cast<double>(row);
    }

    PointTable
    table_of_starts(const OptimizeNames &names)
    {
      PointTable table = {OptimizeMemory::file, "starts", {index_column}, 1, "status", {}, HUGE_VAL, /*grows=*/true};
      std::ranges::move(start_columns(names), std::back_inserter(table.columns));
      return table;
    }

    /// The evaluations of a start. Returns false if they are not whole, or not its own.
    bool
    read_evaluations(const OptimizeNames &names, const RowReader &reader, StoredStart &stored)
    {
      const unsigned long first = stored.first_evaluation, n = stored.n_evaluations;
      if (first > reader.n_rows() || n > reader.n_rows() - first)
        return false;
      const Table table = reader.read(first, n);
      if (const auto intact = reader.intact(evaluation_columns(names), first, n);
          intact && std::ranges::count(*intact, false) > 0)
        return false;
      for (unsigned long i = 0; i < n; ++i)
      {
        RowWords words{table, i, /*behind the index*/ 1};
        const unsigned long number = words.index();
        const auto [name, record]  = read_record(names, words);
        if (number != i || name.number_of_case != stored.start.number_of_case || name.start != stored.start.start)
          return false;
        stored.start.records.push_back(record);
      }
      return true;
    }
  } // namespace

  OptimizeNames::OptimizeNames(OptimizeCases &its_cases)
    : axes(its_cases.axes())
    , objective(its_cases.parameters().optimize.objective)
    , unit(objective == "displacement"    ? "length"
           : objective == "speed"         ? "length/time"
           : objective.ends_with("merit") ? "1"
                                          : "force")
  {
    for (unsigned long number = 0; number < its_cases.size(); ++number)
    {
      const auto family    = its_cases.family(number);
      const bool is_onward = family->form().parameters.optimize.direction == "forward";
      cases.push_back({its_cases.values(number), {}, its_cases.in_words(number), is_onward ? 1. : -1.});
      for (const Variable &variable : family->variables())
      {
        cases.back().paths.push_back(variable.path);
        if (std::ranges::find(paths, variable.path) != paths.end())
          continue;
        paths.push_back(variable.path);
        units.push_back(family->form().declarations.info(variable.path).unit);
      }
    }
  }

  Table
  evaluation_table(const OptimizeNames &names, const std::vector<StartResult> &starts)
  {
    std::vector<RowFile::Row> rows;
    for (const StartResult &start : starts)
      std::ranges::move(evaluation_rows(names, start), std::back_inserter(rows));
    return table_of(evaluation_columns(names), rows, /*has_index=*/true);
  }

  Table
  start_table(const OptimizeNames &names, const std::vector<StartResult> &starts)
  {
    std::vector<RowFile::Column> columns = start_columns(names);
    columns.erase(std::ranges::find(columns, optimiser_column, &RowFile::Column::name) + 1, columns.end());
    std::vector<RowFile::Row> rows;
    for (const StartResult &start : starts)
      if (!start.best.x.empty())
        rows.push_back(start_row(names, start, 0));
    return table_of(columns, rows, /*has_index=*/true);
  }

  Table
  record_table(const OptimizeNames &names, const std::vector<const StartResult *> &starts)
  {
    std::vector<RowFile::Row> rows;
    for (const StartResult *start : starts)
      rows.push_back(record_row(names, *start, start->best, start_problem_width));
    return table_of(record_columns(names, start_problem_width), rows, /*has_index=*/false);
  }

  const std::string OptimizeMemory::file = "starts.h5";

  OptimizeMemory::OptimizeMemory(OptimizeNames names, PlannedRows plan, std::string command_line)
    : names_(std::move(names))
    , plan_(std::move(plan))
    , command_line_(std::move(command_line))
    , table_(table_of_starts(names_))
  {
    plan_.n     = 0;
    plan_.known = {1, index_of_row};
  }

  void
  OptimizeMemory::begin_or_resume(StudyFolder &folder, const ParameterFile &file)
  {
    folder_         = folder.path();
    const auto done = crawler::begin_or_resume(folder, table_, file, plan_, command_line_);
    if (std::ranges::count(done, true) > 0)
    {
      const RowReader rows(MPI_COMM_SELF, folder_ / table_.file, table_.group);
      const RowReader evaluations(MPI_COMM_SELF, folder_ / evaluations_file, evaluations_group);
      const Table table       = rows.read(0, rows.n_rows());
      unsigned long n_damaged = 0;
      for (unsigned long row = 0; row < done.size(); ++row)
        if (done[row])
        {
          StoredStart stored = read_start(names_, {table, row, 1});
          if (stored.start.number_of_case < names_.cases.size() && read_evaluations(names_, evaluations, stored))
            starts_.push_back(std::move(stored.start));
          else
            ++n_damaged;
        }
      if (n_damaged > 0)
        folder.log().warn(
          fmt::format("warning: the evaluations of {} are not what was written, so {} was damaged; they "
                      "are computed anew",
                      counted(n_damaged, "start"),
                      evaluations_file));
    }
    write_all(/*spare=*/1);
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
    const auto before   = std::erase_if(starts_, [&](const StartName &one) { return one == start; });
    const auto n_needed = n_evaluations_ + start.records.size();
    starts_.push_back(std::move(start));
    if (before > 0 || n_starts_ == most_starts_ || n_needed > most_evaluations_)
      write_all(/*spare=*/1);
    else
      write(starts_.back());
  }

  void
  OptimizeMemory::arrange(const std::vector<StartName> &names)
  {
    std::vector<StartResult> arranged;
    for (const StartName &name : names)
      if (const StartResult *const start = find(name))
        arranged.push_back(*start);
    starts_ = std::move(arranged);
    leave_out_unknown_numbers(starts_);
    write_all(/*spare=*/0);
    start_rows_.reset();
    evaluations_.reset();
  }

  void
  OptimizeMemory::write_all(const unsigned long spare)
  {
    constexpr unsigned long fewest_starts = 16, fewest_evaluations = 1024;
    start_rows_.reset();
    evaluations_.reset();
    unsigned long n = 0;
    for (const StartResult &start : starts_)
      n += start.records.size();
    most_starts_                         = starts_.size() + spare * std::max(starts_.size(), fewest_starts);
    most_evaluations_                    = n + spare * std::max(n, fewest_evaluations);
    plan_.n                              = most_starts_;
    std::vector<RowFile::Column> columns = {index_column};
    std::ranges::move(evaluation_columns(names_), std::back_inserter(columns));
    auto attributes         = provenance(plan_.effective, command_line_);
    attributes["not known"] = "NaN in numbers, an empty text in texts";
    create_table(folder_, table_, plan_, command_line_);
    RowFile::create(
      folder_ / evaluations_file, evaluations_group, columns, most_evaluations_, attributes, {1, index_of_row});
    start_rows_ =
      std::make_unique<RowFile>(MPI_COMM_SELF, folder_ / table_.file, table_.group, table_.written_columns());
    evaluations_ = std::make_unique<RowFile>(
      MPI_COMM_SELF, folder_ / evaluations_file, evaluations_group, evaluation_columns(names_));
    n_starts_ = n_evaluations_ = 0;
    for (const StartResult &start : starts_)
      write(start);
  }

  void
  OptimizeMemory::write(const StartResult &start)
  {
    evaluations_->write(n_evaluations_, evaluation_rows(names_, start));
    start_rows_->write(n_starts_, {{start_row(names_, start, n_evaluations_)}});
    ++n_starts_;
    n_evaluations_ += start.records.size();
  }
} // namespace crawler
