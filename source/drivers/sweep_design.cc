// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/drivers/sweep_design.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>

namespace crawler
{
  const std::string sweep_syntax = "\"Section/Entry : VALUES\", several of them separated by semicolons";

  namespace
  {
    const std::string entry_name = "Sweep/Axes";

    std::vector<std::string>
    split(const std::string &text, const char separator)
    {
      std::vector<std::string> items;
      std::istringstream in(text);
      for (std::string item; std::getline(in, item, separator);)
        items.push_back(trimmed(item));
      return items;
    }

    /// The cells of a line of a CSV file; a cell in quotes may have commas in it, and two quotes for one.
    std::vector<std::string>
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
      for (std::string &cell : cells)
        cell = trimmed(cell);
      return cells;
    }

    /// "function(a, b)" -> its name and arguments; nothing if the text is something else.
    struct Call
    {
      std::string function;
      std::vector<std::string> arguments;
    };

    std::optional<Call>
    read_call(const std::string &text)
    {
      const std::size_t open = text.find('(');
      if (open == std::string::npos || text.back() != ')')
        return std::nullopt;
      return Call{trimmed(text.substr(0, open)), split(text.substr(open + 1, text.size() - open - 2), ',')};
    }

    /// The values in a column of a CSV file with a line of names.
    std::vector<std::string>
    read_column(const Call &call)
    {
      if (call.arguments.size() != 2)
        throw InputError(fmt::format("\"{}\": found \"column({})\", but \"column(file.csv, name)\" is expected",
                                     entry_name,
                                     fmt::join(call.arguments, ", ")),
                         entry_name);
      const std::string &file = call.arguments[0], &name = call.arguments[1];
      std::ifstream in(file);
      std::string line;
      if (!in || !std::getline(in, line))
        throw InputError(fmt::format("\"{}\": cannot read the CSV file \"{}\"", entry_name, file), entry_name);
      if (line.starts_with("\xef\xbb\xbf"))
        line.erase(0, 3);
      const auto names = csv_cells(line);
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end())
        throw InputError(fmt::format("\"{}\": \"{}\" has no column \"{}\", but one of {} is expected",
                                     entry_name,
                                     file,
                                     name,
                                     quoted_list(names)),
                         entry_name);
      const auto column = static_cast<std::size_t>(found - names.begin());
      std::vector<std::string> values;
      for (unsigned long row = 2; std::getline(in, line); ++row)
      {
        if (trimmed(line).empty())
          continue;
        const auto cells = csv_cells(line);
        if (cells.size() <= column || cells[column].empty())
          throw InputError(
            fmt::format("\"{}\": row {} of \"{}\" has no value in column \"{}\"", entry_name, row, file, name),
            entry_name);
        values.push_back(cells[column]);
      }
      if (values.empty())
        throw InputError(fmt::format("\"{}\": \"{}\" has no rows", entry_name, file), entry_name);
      return values;
    }

    /// The ends of uniform(from, to) or loguniform(from, to).
    std::vector<std::string>
    read_range(const Call &call)
    {
      const bool is_logarithmic = call.function == "loguniform";
      std::vector<double> ends;
      for (const std::string &argument : call.arguments)
        if (const auto number = to_number(argument))
          ends.push_back(*number);
      if (call.arguments.size() != 2 || ends.size() != 2 || !(ends[0] < ends[1]) || (is_logarithmic && !(ends[0] > 0.)))
        throw InputError(
          fmt::format("\"{}\": found \"{}({})\", but {}(from, to) with two {}increasing numbers is expected",
                      entry_name,
                      call.function,
                      fmt::join(call.arguments, ", "),
                      call.function,
                      is_logarithmic ? "positive, " : ""),
          entry_name);
      return {to_text(ends[0]), to_text(ends[1])};
    }

    /// The generator SplitMix64 (Steele, Lea, Flood 2014), whose n-th number is computed without the ones before it.
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

    /// The n-th number in [0, 1) of a sequence, the same on every machine.
    double
    random_number(const std::uint64_t state, const std::uint64_t n)
    {
      return static_cast<double>(random_bits(state, n) >> 11) * 0x1p-53;
    }

    /// Where @p i goes in a random permutation of 0, ..., @p n - 1: a Feistel network, which permutes the numbers of 2
    /// b bits, as often as it takes to come back below n.
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
    if (call && (call->function == "uniform" || call->function == "loguniform"))
    {
      if (kind_ == Kind::grid || kind_ == Kind::zip)
        throw InputError(fmt::format("\"{}\": {} belongs to a random or latin hypercube design, and this is a {}",
                                     entry_name,
                                     call->function,
                                     design),
                         entry_name);
      axis.values         = read_range(*call);
      axis.is_range       = true;
      axis.is_logarithmic = call->function == "loguniform";
    }
    else if (call && call->function == "column")
      axis.values = read_column(*call);
    else
      axis.values = parse_values(text, entry_name, /*distinct=*/kind_ == Kind::grid);
    return axis;
  }

  SweepDesign::SweepDesign(const SweepParameters &parameters)
    : kind_(parameters.design == "grid"     ? Kind::grid
            : parameters.design == "zip"    ? Kind::zip
            : parameters.design == "random" ? Kind::random
                                            : Kind::latin_hypercube)
    , seed_(parameters.seed)
  {
    for (const std::string &text : split(parameters.axes, ';'))
    {
      const std::size_t colon = text.find(':');
      const std::string entry = trimmed(text.substr(0, colon));
      const std::string rest  = colon == std::string::npos ? "" : trimmed(text.substr(colon + 1));
      if (entry.empty() || rest.empty())
        throw InputError(fmt::format("\"{}\": found \"{}\", but {} is expected", entry_name, text, sweep_syntax),
                         entry_name);
      const std::string path = fmt::format("{}", fmt::join(split_path(entry), "/"));
      if (varies(path))
        throw InputError(
          fmt::format("\"{}\": \"{}\" varies twice, but different entries are expected", entry_name, path), entry_name);
      axes_.push_back(read_axis(path, rest, parameters.design));
    }
    if (axes_.empty())
      throw InputError(fmt::format("\"{}\" is empty, but {} is expected", entry_name, sweep_syntax), entry_name);

    double n = kind_ == Kind::grid ? 1. : kind_ == Kind::zip ? axes_[0].values.size() : parameters.n_points;
    for (const SweepAxis &axis : axes_)
      if (kind_ == Kind::grid)
        n *= static_cast<double>(axis.values.size());
      else if (kind_ == Kind::zip && axis.values.size() != axes_[0].values.size())
        throw InputError(
          fmt::format("\"{}\": a zip has as many values on each axis, but \"{}\" has {} and \"{}\" has {}",
                      entry_name,
                      axes_[0].entry,
                      axes_[0].values.size(),
                      axis.entry,
                      axis.values.size()),
          entry_name);
    if (n > most_points)
      throw InputError(
        fmt::format("\"{}\" makes {:.3g} points, but at most {:g} are expected", entry_name, n, double(most_points)),
        entry_name);
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
    if (kind_ == Kind::latin_hypercube) // each of n equal parts of an axis has one point
      x = (static_cast<double>(permuted(~state, point, n_points_)) + x) / static_cast<double>(n_points_);
    if (!axis.is_range)
    {
      const std::size_t n = axis.values.size();
      return axis.values[std::min(static_cast<std::size_t>(x * static_cast<double>(n)), n - 1)];
    }
    const double from = *to_number(axis.values[0]), to = *to_number(axis.values[1]);
    return to_text(axis.is_logarithmic ? from * std::pow(to / from, x) : from + (to - from) * x);
  }

  bool
  SweepDesign::varies(const std::string &entry) const
  {
    return std::any_of(axes_.begin(),
                       axes_.end(),
                       [&](const SweepAxis &axis)
                       {
                         return axis.entry == entry;
                       });
  }
} // namespace crawler
