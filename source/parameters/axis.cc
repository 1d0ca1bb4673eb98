// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace crawler
{
  namespace
  {
    constexpr double max_values = 100000;

    /// Text without round-off noise: 0.03 and not 0.030000000000000002, 100 and not 99.99999999999999.
    std::string
    clean_text(const double value)
    {
      return to_text(std::stod(fmt::format("{:.12g}", value)));
    }

    const std::vector<std::string> own_functions = {"linspace", "logspace"};

    [[noreturn]] void
    refuse_call(const std::string &found, const std::string &function, const std::string &name)
    {
      refuse_entry(name,
                   "found \"{}\", but \"{}(first, last, count)\" with three numbers, and nothing else, is expected",
                   found,
                   function);
    }

    /// The values of linspace(...) or logspace(...); @p text is the whole text behind the colon.
    std::vector<std::string>
    evenly_spaced(const Call &call, const std::string &text, const std::string &name)
    {
      const auto &[function, arguments] = call;
      std::vector<double> numbers;
      for (const std::string &argument : arguments)
        if (const auto number = to_number(argument))
          numbers.push_back(*number);
      if (arguments.size() != 3 || numbers.size() != 3)
        refuse_call(text, function, name);
      const double count = numbers[2];
      if (count != std::round(count) || count < 1 || count > max_values)
        refuse_entry(name,
                     "the count of {} is \"{}\", but a whole number from 1 to {:g} is expected",
                     function,
                     arguments[2],
                     max_values);
      std::vector<std::string> values;
      for (double i = 0; i < count; ++i)
      {
        const double x = count == 1 ? numbers[0] : numbers[0] + (numbers[1] - numbers[0]) * i / (count - 1);
        const double y = function == "logspace" ? std::pow(10., x) : x;
        if (!std::isfinite(y) || (function == "logspace" && y == 0.))
          refuse_entry(name, "10^{:g} is beyond the range of a double", x);
        values.push_back(clean_text(y));
      }
      return values;
    }

    bool
    are_parentheses_balanced(const std::string &text)
    {
      bool is_quoted = false;
      int depth      = 0;
      for (const char c : text)
        if (c == '"')
          is_quoted = !is_quoted;
        else if (!is_quoted && (depth += (c == '(') - (c == ')')) < 0)
          return false;
      return depth == 0;
    }

    /// The text between the double quotes around @p text; a text without them unchanged.
    std::string
    without_quotes(const std::string &text)
    {
      return text.size() >= 2 && text.find('"', 1) == text.size() - 1 && text[0] == '"'
               ? text.substr(1, text.size() - 2)
               : text;
    }

    std::vector<std::string>
    listed(const std::string &text, const std::string &name, const std::vector<std::string> &functions)
    {
      if (std::count(text.begin(), text.end(), '"') % 2 != 0)
        refuse_entry(name, "found {}, but a second double quote is expected", text);
      auto values = split_parts(text, ',');
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        std::string &value = values[i];
        if (value.empty())
          refuse_entry(
            name, "value {} of the list \"{}\" is empty; values separated by single commas are expected", i + 1, text);
        const std::string bare = without_quotes(value);
        if (bare == value)
        {
          const std::string word = trimmed(value.substr(0, value.find('(')));
          if (word.size() < value.size() && std::find(functions.begin(), functions.end(), word) != functions.end())
          {
            if (std::find(own_functions.begin(), own_functions.end(), word) != own_functions.end())
              refuse_call(value, word, name);
            refuse_entry(name, "found \"{}\", but \"{}(...)\" and nothing else is expected", value, word);
          }
          if (!are_parentheses_balanced(value))
            refuse_entry(name,
                         "found \"{}\", but as many closing as opening parentheses are "
                         "expected; a value with a single one must be in double quotes",
                         value);
        }
        value = bare;
      }
      return values;
    }
  } // namespace

  std::vector<std::string>
  split_parts(const std::string &text, const char separator)
  {
    std::vector<std::string> parts(1);
    bool is_quoted = false;
    int depth      = 0;
    for (const char c : text)
    {
      if (c == '"')
        is_quoted = !is_quoted;
      else if (!is_quoted && separator != ';')
        depth += (c == '(') - (c == ')');
      if (c == separator && !is_quoted && depth <= 0)
        parts.emplace_back();
      else
        parts.back() += c;
    }
    for (std::string &part : parts)
      part = trimmed(part);
    return parts;
  }

  std::optional<Call>
  read_call(const std::string &text)
  {
    const std::size_t open = text.find('(');
    if (open == std::string::npos || text.back() != ')')
      return std::nullopt;
    Call call{trimmed(text.substr(0, open)), {}};
    const bool is_name =
      !call.function.empty() && std::all_of(call.function.begin(), call.function.end(), [](const unsigned char c) {
        return std::isalnum(c) || c == '_';
      });
    const std::string inside = text.substr(open + 1, text.size() - open - 2);
    if (!is_name || !are_parentheses_balanced(inside))
      return std::nullopt;
    for (const std::string &argument : split_parts(inside, ','))
      call.arguments.push_back(without_quotes(argument));
    return call;
  }

  std::vector<std::string>
  parse_values(const std::string &text,
               const std::string &name,
               const bool distinct,
               const std::vector<std::string> &other_functions)
  {
    std::vector<std::string> functions = own_functions, values;
    functions.insert(functions.end(), other_functions.begin(), other_functions.end());
    if (const auto call = read_call(text); !call)
      values = listed(text, name, functions);
    else if (std::find(own_functions.begin(), own_functions.end(), call->function) != own_functions.end())
      values = evenly_spaced(*call, text, name);
    else
    {
      const auto near = nearest_names(call->function, functions, 1);
      refuse_entry(name,
                   "unknown function \"{}\", but {} is expected{}; a formula that is the only "
                   "value must be in double quotes",
                   call->function,
                   quoted_list(functions),
                   near.empty() ? "" : ", the nearest is " + quoted_list(near));
    }
    if (distinct)
      require_distinct(values, name);
    return values;
  }

  void
  require_distinct(const std::vector<std::string> &values, const std::string &name, const std::string &where)
  {
    std::set<std::string> seen;
    for (const std::string &value : values)
    {
      const auto number = to_number(value);
      if (!seen.insert(number ? to_text(*number) : value).second)
        refuse_entry(name, "the value {} occurs twice{}, but different ones are expected", value, where);
    }
  }

  void
  require_valid(const std::string &entry,
                const std::vector<std::string> &values,
                const std::string &name,
                Declarations &declarations,
                const std::filesystem::path &folder)
  {
    try
    {
      for (const std::string &value : values)
        declarations.set(entry, value, folder);
    }
    catch (const InputError &error)
    {
      refuse_entry(name, "{}", error.what());
    }
  }
} // namespace crawler
