// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/studies/table/samples.h>
#include <crawler/studies/table/unit_factor.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

namespace crawler
{
  namespace
  {
    std::string
    lower(std::string text)
    {
      std::transform(text.begin(), text.end(), text.begin(), [](const unsigned char c) { return std::tolower(c); });
      return text;
    }

    /// The names of columns that are understood, and what they mean.
    const std::map<std::string, std::string> &
    known_names()
    {
      static const std::map<std::string, std::string> names = {{"s", "s"},
                                                               {"arc length", "s"},
                                                               {"t", "t"},
                                                               {"time", "t"},
                                                               {"m", "m"},
                                                               {"stress", "m"},
                                                               {"force", "m"},
                                                               {"active stress", "m"},
                                                               {"active_stress", "m"},
                                                               {"strain", "strain"},
                                                               {"stretch", "stretch"},
                                                               {"marker", "marker"},
                                                               {"id", "marker"},
                                                               {"x", "x"},
                                                               {"position", "x"}};
      return names;
    }

    /// Which column has what: "t" -> 0.
    std::map<std::string, std::size_t>
    meanings(const MeasuredFile &file, const std::string &renamed)
    {
      std::map<std::string, std::size_t> result;
      for (std::size_t i = 0; i < file.columns.size(); ++i)
        if (const auto known = known_names().find(lower(file.columns[i])); known != known_names().end())
          if (!result.emplace(known->second, i).second)
            throw InputError(
              fmt::format("\"{}\" has two columns of {}, \"{}\" and \"{}\", but one is expected; \"--columns "
                          "{}=NAME\" chooses",
                          file.name,
                          known->second,
                          file.columns[result[known->second]],
                          file.columns[i],
                          known->second));
      std::istringstream in(renamed);
      for (std::string part; std::getline(in, part, ',');)
      {
        const auto equals = part.find('=');
        const auto clean  = [](std::string text) {
          text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
          text.erase(text.find_last_not_of(' ') + 1);
          return text;
        };
        const std::string meaning              = clean(part.substr(0, equals)),
                          name                 = equals == part.npos ? "" : clean(part.substr(equals + 1));
        const auto column                      = std::find(file.columns.begin(), file.columns.end(), name);
        const std::vector<std::string> choices = {"s", "t", "m", "strain", "stretch", "marker", "x"};
        if (equals == part.npos || std::find(choices.begin(), choices.end(), meaning) == choices.end())
          throw InputError(fmt::format(
            "\"--columns\" has \"{}\", but NAME=COLUMN is expected, NAME being {}", part, quoted_list(choices)));
        if (column == file.columns.end())
          throw InputError(fmt::format(
            "\"--columns\" has the column \"{}\", but \"{}\" has {}", name, file.name, fmt::join(file.columns, ", ")));
        result[meaning] = static_cast<std::size_t>(column - file.columns.begin());
      }
      return result;
    }

    /// The different numbers, sorted; those that differ by round-off are the same.
    std::vector<double>
    distinct(std::vector<double> values)
    {
      std::sort(values.begin(), values.end());
      const double same = values.empty() ? 0. : 1e-9 * (values.back() - values.front());
      values.erase(
        std::unique(values.begin(), values.end(), [same](const double a, const double b) { return b - a <= same; }),
        values.end());
      return values;
    }

    std::size_t
    nearest(const std::vector<double> &values, const double value)
    {
      const auto above = std::lower_bound(values.begin(), values.end(), value);
      if (above == values.begin())
        return 0;
      if (above == values.end() || value - above[-1] < *above - value)
        return static_cast<std::size_t>(above - values.begin()) - 1;
      return static_cast<std::size_t>(above - values.begin());
    }

    struct Columns
    {
      std::vector<double> s, t, values;
      std::vector<std::size_t> lines;
    };

    /// A row for each sample.
    Columns
    long_columns(const MeasuredFile &file, const std::size_t s, const std::size_t t, const std::size_t value)
    {
      Columns result;
      for (std::size_t r = 0; r < file.values.size(); ++r)
      {
        const auto &row = file.values[r];
        if (std::isnan(row[s]) || std::isnan(row[t]))
          throw InputError(fmt::format("row {} of \"{}\" has no {}, but only what is measured may have gaps",
                                       file.lines[r],
                                       file.name,
                                       file.columns[std::isnan(row[s]) ? s : t]));
        result.s.push_back(row[s]);
        result.t.push_back(row[t]);
        result.values.push_back(row[value]);
        result.lines.push_back(file.lines[r]);
      }
      return result;
    }

    /// A column for each place (or, @p is_over_s, for each time), with its number as its name; of markers a counter.
    Columns
    wide_columns(const MeasuredFile &file, const bool is_over_s, const bool is_counted)
    {
      Columns result;
      for (std::size_t i = 1; i < file.columns.size(); ++i)
      {
        std::string name = file.columns[i];
        std::replace(name.begin(), name.end(), ',', '.');
        const auto number = is_counted ? std::optional(static_cast<double>(i)) : number_in(name);
        if (!number)
          throw InputError(
            fmt::format("column {} of \"{}\" is \"{}\", but the {} of its samples is expected as its name (or "
                        "names as x1, x2, ... if they are markers)",
                        i + 1,
                        file.name,
                        file.columns[i],
                        is_over_s ? "time" : "place s"));
        for (std::size_t r = 0; r < file.values.size(); ++r)
        {
          if (std::isnan(file.values[r][0]))
            throw InputError(fmt::format("row {} of \"{}\" has no {}, but only what is measured may have gaps",
                                         file.lines[r],
                                         file.name,
                                         file.columns[0]));
          result.s.push_back(is_over_s ? file.values[r][0] : *number);
          result.t.push_back(is_over_s ? *number : file.values[r][0]);
          result.values.push_back(file.values[r][i]);
          result.lines.push_back(file.lines[r]);
        }
      }
      return result;
    }

    Samples
    on_grid(const Columns &columns, const MeasuredQuantity quantity, const std::string &name)
    {
      Samples samples;
      samples.quantity            = quantity;
      samples.s                   = distinct(columns.s);
      samples.t                   = distinct(columns.t);
      constexpr std::size_t least = 4, most_gaps = 20;
      const std::string of = quantity == MeasuredQuantity::marker ? "markers" : "places s";
      if (samples.s.size() < least || samples.t.size() < least)
        throw InputError(fmt::format("\"{}\" has {} different {} and {} different times, but at least {} of each are "
                                     "expected",
                                     name,
                                     samples.s.size(),
                                     of,
                                     samples.t.size(),
                                     least));
      if (samples.s.size() * samples.t.size() > most_gaps * columns.s.size())
        throw InputError(
          fmt::format("\"{}\" has {} samples at {} different {} and {} different times, but most of them with "
                      "each other are expected (all places sampled at the same times)",
                      name,
                      columns.s.size(),
                      samples.s.size(),
                      of,
                      samples.t.size()));
      samples.values.assign(samples.s.size() * samples.t.size(), gap);
      std::vector<std::size_t> seen(samples.values.size(), 0);
      Mistakes mistakes;
      for (std::size_t r = 0; r < columns.s.size(); ++r)
      {
        const std::size_t i = nearest(samples.s, columns.s[r]), j = nearest(samples.t, columns.t[r]),
                          point = j * samples.s.size() + i;
        if (seen[point] == 0)
          samples.values[point] = columns.values[r];
        else if (mistakes.is_first(columns.lines[r]))
          mistakes.say(fmt::format("row {} of \"{}\" gives {} = {:g}, t = {:g} a second time, after row {}",
                                   columns.lines[r],
                                   name,
                                   quantity == MeasuredQuantity::marker ? "marker" : "s",
                                   columns.s[r],
                                   columns.t[r],
                                   seen[point]));
        seen[point] = columns.lines[r];
      }
      mistakes.refuse("");
      return samples;
    }

    /// Multiplies and shifts numbers and says so.
    void
    convert(std::vector<double> &values,
            const std::string &name,
            const double factor,
            const std::string &shift,
            std::vector<std::string> &words)
    {
      if (factor != 1.)
      {
        for (double &value : values)
          value *= factor;
        words.push_back(fmt::format("{} multiplied by {:g}", name, factor));
      }
      if (shift.empty())
        return;
      const auto number = shift == "first" ? std::optional(-values.front()) : number_in(shift);
      if (!number)
        throw InputError(fmt::format("\"--shift-{}\" is \"{}\", but a number or \"first\" is expected", name, shift));
      for (double &value : values)
        value += *number;
      words.push_back(
        fmt::format("{} shifted by {:g}; it goes from {:g} to {:g}", name, *number, values.front(), values.back()));
    }
  } // namespace

  std::string
  column_of(const MeasuredQuantity quantity)
  {
    return quantity == MeasuredQuantity::active_stress ? "m" : quantity == MeasuredQuantity::strain ? "strain" : "x";
  }

  std::vector<double>
  Samples::over_time(const std::size_t i) const
  {
    std::vector<double> result(t.size());
    for (std::size_t j = 0; j < t.size(); ++j)
      result[j] = at(j, i);
    return result;
  }

  std::vector<double>
  Samples::over_body(const std::size_t j) const
  {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(j * s.size());
    return {begin, begin + static_cast<std::ptrdiff_t>(s.size())};
  }

  Samples
  read_samples(const MeasuredFile &file, const SampleSettings &settings, std::vector<std::string> &words)
  {
    const auto columns                        = meanings(file, settings.columns);
    const auto has                            = [&](const std::string &name) { return columns.contains(name); };
    std::string quantity                      = settings.quantity;
    const std::vector<std::string> quantities = {"m", "strain", "stretch", "markers"};
    if (!quantity.empty() && std::find(quantities.begin(), quantities.end(), quantity) == quantities.end())
      throw InputError(fmt::format("\"--quantity\" is \"{}\", but {} is expected", quantity, quoted_list(quantities)));
    Columns found;
    std::size_t unit_from_s = 0, unit_from_t = 0, unit_from_value = 0;
    const std::string value = has("m") ? "m" : has("strain") ? "strain" : has("stretch") ? "stretch" : "";
    const std::string first = file.columns.size() > 1 ? lower(file.columns[1]) : "";
    if (has("t") && has("s") && !value.empty())
    {
      unit_from_s = columns.at("s"), unit_from_t = columns.at("t"), unit_from_value = columns.at(value);
      found    = long_columns(file, unit_from_s, unit_from_t, unit_from_value);
      quantity = quantity.empty() ? value : quantity;
    }
    else if (has("t") && has("marker") && has("x"))
    {
      unit_from_t = columns.at("t"), unit_from_value = columns.at("x");
      found    = long_columns(file, columns.at("marker"), unit_from_t, unit_from_value);
      quantity = "markers";
    }
    else if ((has("t") && columns.at("t") == 0) || (has("s") && columns.at("s") == 0))
    {
      const bool is_over_s  = !has("t") || columns.at("t") != 0;
      const bool is_tracked = quantity == "markers" || (quantity.empty() && !is_over_s &&
                                                        (first.starts_with("x") || first.starts_with("marker")));
      found                 = wide_columns(file, is_over_s, is_tracked);
      quantity              = is_tracked ? "markers" : quantity.empty() ? "m" : quantity;
      unit_from_value       = 1; // all columns of a wide table have one unit
    }
    else
      throw InputError(
        fmt::format("\"{}\" has the columns {}, but s, t and m (or strain, stretch) are expected; or t, marker "
                    "and x; or t and a column for each s or marker (\"--columns\" gives them other names)",
                    file.name,
                    fmt::join(file.columns, ", ")));
    const bool is_tracked = quantity == "markers";
    Samples samples       = on_grid(found,
                              is_tracked        ? MeasuredQuantity::marker
                                    : quantity == "m" ? MeasuredQuantity::active_stress
                                                      : MeasuredQuantity::strain,
                              file.name);
    const auto factor     = [&](const std::string &wanted, const std::size_t column, const char *option) {
      return wanted.empty() ? 1. : unit_factor(file.units[column], wanted, option);
    };
    words.push_back(fmt::format(
      "{} {} x {} times, {} gaps",
      samples.s.size(),
      is_tracked ? "markers" : "places",
      samples.t.size(),
      std::count_if(samples.values.begin(), samples.values.end(), [](const double v) { return std::isnan(v); })));
    if (is_tracked && !settings.shift_s.empty())
      throw InputError("\"--shift-s\" is there, but the places of markers are given by \"--first-marker\"");
    if (is_tracked && !settings.unit_of_value.empty())
      throw InputError("\"--unit-of-m\" is there, but markers have a length only; \"--unit-of-s\" is expected");
    convert(samples.t, "t", factor(settings.unit_of_t, unit_from_t, "--unit-of-t"), settings.shift_t, words);
    if (is_tracked)
      convert(samples.values, "x", factor(settings.unit_of_s, unit_from_value, "--unit-of-s"), "", words);
    else
    {
      convert(samples.s, "s", factor(settings.unit_of_s, unit_from_s, "--unit-of-s"), settings.shift_s, words);
      convert(samples.values, quantity, factor(settings.unit_of_value, unit_from_value, "--unit-of-m"), "", words);
    }
    for (const auto *axis : {&samples.s, &samples.t})
      if (!(axis->back() > axis->front()))
        throw InputError("a unit is negative, but only that of m may be");
    if (quantity == "stretch")
    {
      for (double &w : samples.values)
        w -= 1.;
      words.push_back("the stretch minus 1 is the strain");
    }
    return samples;
  }
} // namespace crawler
