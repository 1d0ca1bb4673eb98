// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/drivers/sweep_design.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>
#include <random>
#include <sstream>

namespace crawler
{
  const std::string sweep_syntax = "\"Section/Entry : VALUES\", several of them separated by semicolons";

  namespace
  {
    const std::string entry_name = "Sweep/Axes";
    constexpr double most_points = 1e8;

    std::vector<std::string>
    split(const std::string &text, const char separator)
    {
      std::vector<std::string> items;
      std::istringstream in(text);
      for (std::string item; std::getline(in, item, separator);)
        items.push_back(trimmed(item));
      return items;
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
      const auto names = split(line, ',');
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
        const auto cells = split(line, ',');
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

    /// Where a random design draws from.
    struct Source
    {
      std::vector<std::string> list; ///< or, if that is empty,
      bool logarithmic = false;
      double from = 0., to = 0.;

      /// @p x in [0, 1).
      std::string
      value(const double x) const
      {
        if (!list.empty())
          return list[std::min(static_cast<std::size_t>(x * static_cast<double>(list.size())), list.size() - 1)];
        return to_text(logarithmic ? from * std::pow(to / from, x) : from + (to - from) * x);
      }
    };

    Source
    read_range(const Call &call)
    {
      Source source;
      source.logarithmic = call.function == "loguniform";
      std::vector<double> ends;
      for (const std::string &argument : call.arguments)
        if (const auto number = to_number(argument))
          ends.push_back(*number);
      if (call.arguments.size() != 2 || ends.size() != 2 || !(ends[0] < ends[1]) ||
          (source.logarithmic && !(ends[0] > 0.)))
        throw InputError(
          fmt::format("\"{}\": found \"{}({})\", but {}(from, to) with two {}increasing numbers is expected",
                      entry_name,
                      call.function,
                      fmt::join(call.arguments, ", "),
                      call.function,
                      source.logarithmic ? "positive, " : ""),
          entry_name);
      source.from = ends[0];
      source.to   = ends[1];
      return source;
    }

    /// Numbers in [0, 1) that are the same on every machine.
    class Random
    {
    public:
      explicit Random(const unsigned int seed)
        : generator_(seed)
      {
      }

      double
      next()
      {
        return static_cast<double>(generator_() >> 11) * 0x1p-53;
      }

      std::vector<unsigned long>
      permutation(const unsigned long n)
      {
        std::vector<unsigned long> list(n);
        std::iota(list.begin(), list.end(), 0ul);
        for (unsigned long i = n; i > 1; --i)
          std::swap(list[i - 1], list[static_cast<unsigned long>(next() * static_cast<double>(i))]);
        return list;
      }

    private:
      std::mt19937_64 generator_;
    };
  } // namespace

  SweepDesign::SweepDesign(const SweepParameters &parameters)
    : is_grid_(parameters.design == "grid")
  {
    const bool is_random = parameters.design == "random" || parameters.design == "latin hypercube";
    std::vector<std::string> texts;
    for (const std::string &text : split(parameters.axes, ';'))
    {
      const std::size_t colon = text.find(':');
      const std::string entry = trimmed(text.substr(0, colon));
      const std::string rest  = colon == std::string::npos ? "" : trimmed(text.substr(colon + 1));
      if (entry.empty() || rest.empty())
        throw InputError(fmt::format("\"{}\": found \"{}\", but {} is expected", entry_name, text, sweep_syntax),
                         entry_name);
      const std::string path = fmt::format("{}", fmt::join(split_path(entry), "/"));
      for (const SweepAxis &axis : axes_)
        if (axis.entry == path)
          throw InputError(
            fmt::format("\"{}\": \"{}\" varies twice, but different entries are expected", entry_name, path),
            entry_name);
      axes_.push_back({path, {}, {}});
      texts.push_back(rest);
    }
    if (axes_.empty())
      throw InputError(fmt::format("\"{}\" is empty, but {} is expected", entry_name, sweep_syntax), entry_name);
    if (is_random)
    {
      draw(parameters, texts);
      return;
    }

    double n = is_grid_ ? 1. : 0.;
    for (std::size_t i = 0; i < axes_.size(); ++i)
    {
      const auto call = read_call(texts[i]);
      if (call && (call->function == "uniform" || call->function == "loguniform"))
        throw InputError(fmt::format("\"{}\": {} belongs to a random or latin hypercube design, and this is a {}",
                                     entry_name,
                                     call->function,
                                     parameters.design),
                         entry_name);
      auto &values        = axes_[i].values;
      values              = call && call->function == "column" ? read_column(*call)
                                                               : parse_values(texts[i], entry_name, /*distinct=*/is_grid_);
      axes_[i].admissible = values;
      if (is_grid_)
        n *= static_cast<double>(values.size());
      else if (i > 0 && values.size() != axes_[0].values.size())
        throw InputError(
          fmt::format("\"{}\": a zip has as many values on each axis, but \"{}\" has {} and \"{}\" has {}",
                      entry_name,
                      axes_[0].entry,
                      axes_[0].values.size(),
                      axes_[i].entry,
                      values.size()),
          entry_name);
      else
        n = static_cast<double>(values.size());
    }
    if (n > most_points)
      throw InputError(
        fmt::format("\"{}\" makes {:.3g} points, but at most {:g} are expected", entry_name, n, most_points),
        entry_name);
    n_points_ = static_cast<unsigned long>(n);
  }

  void
  SweepDesign::draw(const SweepParameters &parameters, const std::vector<std::string> &texts)
  {
    n_points_ = parameters.n_points;
    Random random(parameters.seed);
    for (std::size_t i = 0; i < axes_.size(); ++i)
    {
      const auto call = read_call(texts[i]);
      Source source;
      if (call && (call->function == "uniform" || call->function == "loguniform"))
        source = read_range(*call);
      else
        source.list = call && call->function == "column" ? read_column(*call)
                                                         : parse_values(texts[i], entry_name, /*distinct=*/false);
      // Of a Latin hypercube each of n equal parts of an axis has one point.
      std::vector<unsigned long> part;
      if (parameters.design == "latin hypercube")
        part = random.permutation(n_points_);
      const auto n = static_cast<double>(n_points_);
      for (unsigned long point = 0; point < n_points_; ++point)
      {
        const double x = random.next();
        axes_[i].values.push_back(source.value(part.empty() ? x : (static_cast<double>(part[point]) + x) / n));
      }
      axes_[i].admissible = source.list.empty() ? std::vector{to_text(source.from), to_text(source.to)} : source.list;
    }
  }

  const std::string &
  SweepDesign::value(const std::size_t axis, const unsigned long point) const
  {
    if (!is_grid_)
      return axes_[axis].values[point];
    unsigned long stride = 1;
    for (std::size_t i = axis + 1; i < axes_.size(); ++i)
      stride *= axes_[i].values.size();
    return axes_[axis].values[point / stride % axes_[axis].values.size()];
  }
} // namespace crawler
