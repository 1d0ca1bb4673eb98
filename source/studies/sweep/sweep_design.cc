// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/nearest_name.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/sweep/sweep_design.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>

namespace crawler
{
  namespace
  {
    const std::string entry_name = "Sweep/Axes";

    /// Refuses the axes; not called refuse(), as another function is that sources compiled together with this one call.
    template <typename... Arguments>
    [[noreturn]] void
    reject(fmt::format_string<Arguments...> sentence, Arguments &&...arguments)
    {
      refuse_entry(entry_name, sentence, std::forward<Arguments>(arguments)...);
    }

    /// Opens a file that the axes name, described by @p what.
    std::ifstream
    open(const std::string &file, const std::string &what)
    {
      std::error_code ignored;
      if (std::filesystem::is_directory(file, ignored))
        reject("\"{}\" is a folder, but {} is expected", file, what);
      errno = 0;
      std::ifstream in(file);
      if (in)
        return in;
      const std::string reason         = errno != 0 ? std::strerror(errno) : "unknown reason";
      const std::filesystem::path path = file, folder = path.parent_path();
      std::vector<std::string> others; // names without the extension, which they share
      for (std::filesystem::directory_iterator i(folder.empty() ? "." : folder, ignored), end; !ignored && i != end;
           i.increment(ignored))
        if (i->path().extension() == path.extension() && i->is_regular_file(ignored))
          others.push_back(i->path().stem().string());
      auto near = nearest_names(path.stem().string(), others, 1);
      for (std::string &name : near)
        name = (folder / name).string() + path.extension().string();
      reject("cannot read \"{}\" ({}), but {} is expected{}",
             file,
             reason,
             what,
             near.empty() ? "" : "; the nearest name is " + quoted_list(near));
    }

    /// True if it can be shown on a terminal: not UTF-16, compressed or a picture.
    bool
    is_text(const std::string &line)
    {
      if (std::any_of(
            line.begin(), line.end(), [](const unsigned char c) { return (c < ' ' && c != '\t') || c == 0x7f; }))
        return false;
      try
      {
        nlohmann::json(line).dump(); // throws if it is not UTF-8
        return true;
      }
      catch (const nlohmann::json::type_error &)
      {
        return false;
      }
    }

    /// Cells of a line of a CSV file; a cell in quotes may have commas in it, and two quotes for one. Nothing if a
    /// quote is not closed.
    std::optional<std::vector<std::string>>
    csv_cells(const std::string &line)
    {
      std::vector<std::string> cells(1);
      bool is_quoted = false;
      for (std::size_t i = 0; i < line.size(); ++i)
        if (line[i] == '"')
        {
          if (is_quoted && i + 1 < line.size() && line[i + 1] == '"')
            cells.back() += line[i++];
          else
            is_quoted = !is_quoted;
        }
        else if (line[i] == ',' && !is_quoted)
          cells.emplace_back();
        else
          cells.back() += line[i];
      if (is_quoted)
        return std::nullopt;
      for (std::string &cell : cells)
        cell = trimmed(cell);
      return cells;
    }

    /// Index of the column named @p name in the file @p file.
    std::size_t
    column_of(const std::string &name, const std::vector<std::string> &names, const std::string &file)
    {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end())
      {
        if (names.size() == 1 && names[0].find(';') != std::string::npos)
          reject("\"{}\" has its columns between semicolons, but commas between them and decimal points are expected",
                 file);
        constexpr std::size_t most = 10;
        const bool all_are_named   = names.size() <= most;
        reject("\"{}\" has no column \"{}\", but {} is expected{}",
               file,
               name,
               all_are_named
                 ? quoted_list(names)
                 : fmt::format("one of {} columns, {}, ...",
                               names.size(),
                               fmt::format("\"{}\"", fmt::join(names.begin(), names.begin() + most, "\", \""))),
               nearest_hint(name, names));
      }
      if (std::find(found + 1, names.end(), name) != names.end())
        reject("\"{}\" has more than one column \"{}\", but different names are expected", file, name);
      return static_cast<std::size_t>(found - names.begin());
    }

    /// Values in a column of a CSV file with a line of names. Lines that are empty or start with "#" are skipped.
    std::vector<std::string>
    read_column(const Call &call, const std::filesystem::path &folder)
    {
      if (call.arguments.size() != 2 || call.arguments[0].empty() || call.arguments[1].empty())
        reject("found \"column({})\", but \"column(file.csv, name)\" is expected", fmt::join(call.arguments, ", "));
      const std::string file = (folder / call.arguments[0]).string(), name = call.arguments[1];
      std::ifstream in      = open(file, "a CSV file with a line of names");
      std::size_t n_columns = 0, column = 0;
      std::vector<std::string> values;
      std::string line;
      for (unsigned long row = 1; std::getline(in, line); ++row)
      {
        if (row == 1 && line.starts_with("\xef\xbb\xbf"))
          line.erase(0, 3);
        line = trimmed(line);
        if (const std::string found = foreign_format(line); !found.empty() || !is_text(line))
          reject("row {} of \"{}\" is {}, but a CSV file in UTF-8 is expected",
                 row,
                 file,
                 found.empty() ? "not text" : found);
        if (line.empty() || line[0] == '#')
          continue;
        const auto cells = csv_cells(line);
        if (!cells)
          reject("a double quote in row {} of \"{}\" is not closed, but rows of one line are expected", row, file);
        if (n_columns == 0)
        {
          n_columns = cells->size();
          column    = column_of(name, *cells, file);
          continue;
        }
        if (cells->size() != n_columns)
          reject("row {} of \"{}\" has {}, but {}, as many as names in the first row, {} expected",
                 row,
                 file,
                 counted(cells->size(), "value"),
                 n_columns,
                 n_columns == 1 ? "is" : "are");
        if ((*cells)[column].empty())
          reject("row {} of \"{}\" has no value in column \"{}\", but one is expected", row, file, name);
        values.push_back((*cells)[column]);
      }
      if (in.bad())
        reject("cannot read \"{}\" to its end", file);
      if (n_columns == 0)
        reject("\"{}\" is empty, but a CSV file with a line of names is expected", file);
      if (values.empty())
        reject("\"{}\" has no rows after the line of names, but at least one is expected", file);
      return values;
    }

    /// Ends of uniform(from, to) or loguniform(from, to).
    std::vector<std::string>
    read_range(const Call &call)
    {
      const bool is_logarithmic = call.function == "loguniform";
      std::vector<double> ends;
      for (const std::string &argument : call.arguments)
        if (const auto number = to_number(argument))
          ends.push_back(*number);
      if (call.arguments.size() != 2 || ends.size() != 2 || !(ends[0] < ends[1]) || (is_logarithmic && !(ends[0] > 0.)))
        reject("found \"{}({})\", but {}(from, to) with two {}increasing numbers is expected",
               call.function,
               fmt::join(call.arguments, ", "),
               call.function,
               is_logarithmic ? "positive, " : "");
      return {to_text(ends[0]), to_text(ends[1])};
    }

    /// Generator SplitMix64 (@cite SteeleLeaFlood2014), whose n-th number is computed without the previous ones.
    std::uint64_t
    mixed(std::uint64_t x)
    {
      x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
      x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
      return x ^ (x >> 31);
    }

    std::uint64_t
    random_bits(const std::uint64_t state, const std::uint64_t n)
    {
      return mixed(state + (n + 1) * 0x9e3779b97f4a7c15u);
    }

    /// Returns the n-th number in [0, 1) of a sequence that is the same on every machine.
    double
    random_number(const std::uint64_t state, const std::uint64_t n)
    {
      return static_cast<double>(random_bits(state, n) >> 11) * 0x1p-53;
    }

    /// Returns the image of @p i in a random permutation of 0, ..., @p n - 1: a Feistel network, which permutes the
    /// numbers of 2 b bits, is applied until the number is below n.
    std::uint64_t
    permuted(const std::uint64_t state, std::uint64_t i, const std::uint64_t n)
    {
      constexpr unsigned int rounds = 8;
      const unsigned int bits       = (std::bit_width(n - 1) + 1) / 2;
      const std::uint64_t half      = (std::uint64_t(1) << bits) - 1;
      do
      {
        std::uint64_t left = i >> bits, right = i & half;
        for (unsigned int round = 0; round < rounds; ++round)
        {
          const std::uint64_t next = left ^ (random_bits(random_bits(state, round), right) & half);
          left                     = right;
          right                    = next;
        }
        i = left << bits | right;
      } while (i >= n);
      return i;
    }
  } // namespace

  SweepAxis
  SweepDesign::read_axis(const std::string &entry, const std::string &text, const std::string &design) const
  {
    SweepAxis axis{entry, {}};
    const auto call = read_call(text);
    if (axis.is_file() && call && call->function != "column")
      reject(
        "found \"{}\" on the axis \"File\", but names of parameter files or \"column(file.csv, name)\" are expected",
        text);
    if (call && (call->function == "uniform" || call->function == "loguniform"))
    {
      if (kind_ == Kind::grid || kind_ == Kind::zip)
        reject("{} is only for a random or latin hypercube design, but this is a {}", call->function, design);
      axis.values         = read_range(*call);
      axis.is_range       = true;
      axis.is_logarithmic = call->function == "loguniform";
    }
    else if (call && call->function == "column")
    {
      axis.values = read_column(*call, folder_);
      if (kind_ == Kind::grid)
        require_distinct(axis.values,
                         entry_name,
                         fmt::format(" in column \"{}\" of \"{}\" (a grid)", call->arguments[1], call->arguments[0]));
    }
    else
    {
      if (!call)
        for (const std::string &value : split_parts(text, ','))
          if (split_parts(value, ':').size() > 1 && value.find('?') == std::string::npos) // not "x<0 ? 1 : 2"
            reject("found the value \"{}\" of \"{}\"; is a semicolon missing before the next entry? (a value with a "
                   "colon must be in double quotes)",
                   value,
                   entry);
      axis.values =
        parse_values(text, entry_name, /*distinct=*/kind_ == Kind::grid, {"column", "uniform", "loguniform"});
    }
    if (axis.is_file())
      for (const std::string &file : std::set<std::string>(axis.values.begin(), axis.values.end()))
        open((folder_ / file).string(), "a parameter file");
    return axis;
  }

  SweepDesign::SweepDesign(const SweepParameters &parameters, std::filesystem::path folder)
    : folder_(std::move(folder))
    , kind_(parameters.design == "grid"     ? Kind::grid
            : parameters.design == "zip"    ? Kind::zip
            : parameters.design == "random" ? Kind::random
                                            : Kind::latin_hypercube)
    , seed_(parameters.seed)
  {
    auto parts = split_parts(parameters.axes, ';');
    if (parts.back().empty())
      parts.pop_back();
    for (const std::string &text : parts)
    {
      const std::size_t colon = text.find(':');
      const std::string entry = trimmed(text.substr(0, colon));
      const std::string rest  = colon == std::string::npos ? "" : trimmed(text.substr(colon + 1));
      if (entry.empty() || rest.empty())
        reject("found \"{}\", but {} is expected", text, sweep_syntax);
      const std::string path = normal_path(entry);
      if (varies(path))
        reject("\"{}\" varies twice, but different entries are expected", path);
      axes_.push_back(read_axis(path, rest, parameters.design));
    }

    double n = kind_ == Kind::grid || axes_.empty() ? 1.
               : kind_ == Kind::zip                 ? axes_[0].values.size()
                                                    : parameters.n_points;
    for (const SweepAxis &axis : axes_)
      if (kind_ == Kind::grid)
        n *= static_cast<double>(axis.values.size());
      else if (kind_ == Kind::zip && axis.values.size() != axes_[0].values.size())
        reject("a zip must have equally many values on all axes, but \"{}\" has {} and \"{}\" has {}",
               axes_[0].entry,
               axes_[0].values.size(),
               axis.entry,
               axis.values.size());
    if (n > SweepParameters::max_points)
      crawler::refuse(entry_name,
                      "\"{}\" makes {:.3g} points, but at most {:g} are expected",
                      entry_name,
                      n,
                      double(SweepParameters::max_points));
    n_points_ = static_cast<unsigned long>(n);
  }

  std::string
  SweepDesign::value(const std::size_t number, const unsigned long point) const
  {
    const SweepAxis &axis = axes_[number];
    if (kind_ == Kind::zip)
      return axis.values[point];
    if (kind_ == Kind::grid)
    {
      unsigned long stride = 1;
      for (std::size_t i = number + 1; i < axes_.size(); ++i)
        stride *= axes_[i].values.size();
      return axis.values[point / stride % axis.values.size()];
    }
    const std::uint64_t state = random_bits(random_bits(seed_, number), 0);
    double x                  = random_number(state, point);
    if (kind_ == Kind::latin_hypercube) // one point in each of n equal parts of an axis
      x = (static_cast<double>(permuted(~state, point, n_points_)) + x) / static_cast<double>(n_points_);
    if (!axis.is_range)
    {
      const std::size_t n = axis.values.size();
      return axis.values[std::min(static_cast<std::size_t>(x * static_cast<double>(n)), n - 1)];
    }
    const double from = *to_number(axis.values[0]), to = *to_number(axis.values[1]);
    return to_text(axis.is_logarithmic ? from * std::pow(to / from, x) : from + (to - from) * x);
  }

  std::vector<unsigned long>
  SweepDesign::neighbours(const unsigned long point) const
  {
    std::vector<unsigned long> list;
    const auto add_both = [&](const unsigned long step, const unsigned long size) {
      const unsigned long place = point / step % size;
      if (place > 0)
        list.push_back(point - step);
      if (place + 1 < size)
        list.push_back(point + step);
    };
    if (kind_ != Kind::grid)
      add_both(1, n_points_);
    else
    {
      unsigned long step = n_points_;
      for (const SweepAxis &axis : axes_)
      {
        step /= axis.values.size();
        add_both(step, axis.values.size());
      }
    }
    return list;
  }
} // namespace crawler
