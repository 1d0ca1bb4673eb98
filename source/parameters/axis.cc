// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace crawler
{
  const std::string axis_syntax = "\"Section/Entry : linspace(first, last, count)\", \"... : logspace(first exponent, "
                                  "last exponent, count)\" or \"... : value, value, ...\"";

  namespace
  {
    constexpr double most_values = 100000;

    std::vector<std::string>
    split_list(const std::string &text)
    {
      std::vector<std::string> items;
      std::istringstream in(text + ",");
      for (std::string item; std::getline(in, item, ',');)
        items.push_back(trimmed(item));
      return items;
    }

    /// Without the noise of round-off: 0.03 and not 0.030000000000000002, 100 and not 99.99999999999999.
    std::string
    clean_text(const double value)
    {
      return to_text(std::stod(fmt::format("{:.12g}", value)));
    }

    /// The values of linspace(...) or logspace(...); @p call is all that stands behind the colon.
    std::vector<std::string>
    evenly_spaced(const std::string &call, const std::string &name)
    {
      const std::size_t open     = call.find('(');
      const std::string function = trimmed(call.substr(0, open));
      if (function != "linspace" && function != "logspace")
      {
        const auto near = nearest_names(function, {"linspace", "logspace"}, 1);
        throw InputError(fmt::format("\"{}\": unknown function \"{}\", but \"linspace\" or \"logspace\" is expected{}",
                                     name,
                                     function,
                                     near.empty() ? "" : "; the nearest is " + quoted_list(near)),
                         name);
      }
      const std::size_t close = call.find(')', open);
      const auto arguments = split_list(call.substr(open + 1, close == std::string::npos ? close : close - open - 1));
      std::vector<double> numbers;
      for (const std::string &argument : arguments)
        if (const auto number = to_number(argument))
          numbers.push_back(*number);
      if (close == std::string::npos || close + 1 != call.size() || arguments.size() != 3 || numbers.size() != 3)
        throw InputError(
          fmt::format("\"{}\": found \"{}\", but \"{}(first, last, count)\" with three numbers is expected",
                      name,
                      call,
                      function),
          name);
      const double count = numbers[2];
      if (count != std::round(count) || count < 1 || count > most_values)
        throw InputError(fmt::format("\"{}\": the count of {} is \"{}\", but a whole number from 1 to {:g} is expected",
                                     name,
                                     function,
                                     arguments[2],
                                     most_values),
                         name);
      std::vector<std::string> values;
      for (double i = 0; i < count; ++i)
      {
        const double x = count == 1 ? numbers[0] : numbers[0] + (numbers[1] - numbers[0]) * i / (count - 1);
        const double y = function == "logspace" ? std::pow(10., x) : x;
        if (!std::isfinite(y) || (function == "logspace" && y == 0.))
          throw InputError(
            fmt::format("\"{}\": 10 to the power of {:g} is not a number that a computer knows", name, x), name);
        values.push_back(clean_text(y));
      }
      return values;
    }

    std::vector<std::string>
    listed(const std::string &text, const std::string &name)
    {
      const auto values = split_list(text);
      for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i].empty())
          throw InputError(
            fmt::format("\"{}\": value {} of the list \"{}\" is empty; values separated by single commas are expected",
                        name,
                        i + 1,
                        text),
            name);
      return values;
    }
  } // namespace

  std::vector<std::string>
  parse_values(const std::string &text, const std::string &name, const bool distinct)
  {
    const auto values = text.find('(') == std::string::npos ? listed(text, name) : evenly_spaced(text, name);
    std::set<std::string> seen;
    for (const std::string &value : values)
    {
      const auto number = to_number(value);
      if (distinct && !seen.insert(number ? to_text(*number) : value).second)
        throw InputError(fmt::format("\"{}\": the value {} occurs twice, but different ones are expected", name, value),
                         name);
    }
    return values;
  }

  Axis
  parse_axis(const std::string &text, const std::string &name)
  {
    const std::size_t colon = text.find(':');
    const std::string entry = trimmed(text.substr(0, colon));
    const std::string rest  = colon == std::string::npos ? "" : trimmed(text.substr(colon + 1));
    if (entry.empty() || rest.empty())
      throw InputError(fmt::format("\"{}\" is \"{}\", but {} is expected", name, text, axis_syntax), name);
    return {fmt::format("{}", fmt::join(split_path(entry), "/")), parse_values(rest, name)};
  }

  void
  require_valid(const Axis &axis, const std::string &name, Declarations &declarations)
  {
    try
    {
      for (const std::string &value : axis.values)
        declarations.set(axis.entry, value);
    }
    catch (const InputError &error)
    {
      throw InputError(fmt::format("\"{}\": {}", name, error.what()), name);
    }
  }

  std::vector<double>
  numbers_of(const Axis &axis, const std::string &name)
  {
    std::vector<double> numbers;
    for (const std::string &value : axis.values)
      if (const auto number = to_number(value))
        numbers.push_back(*number);
      else
        throw InputError(fmt::format("\"{}\": found \"{}\", but a number is expected", name, value), name);
    return numbers;
  }
} // namespace crawler
