// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/plain_text.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace crawler
{
  std::string
  trimmed(const std::string &text)
  {
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos)
      return "";
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
  }

  std::optional<double>
  to_number(const std::string &text)
  {
    if (text.empty() || text.find_first_not_of("0123456789.+-eE") != std::string::npos)
      return std::nullopt;
    char *end          = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() + text.size() || !std::isfinite(value))
      return std::nullopt;
    return value;
  }

  std::string
  to_text(const double value)
  {
    return fmt::format("{}", value);
  }

  std::optional<std::vector<double>>
  to_numbers(const std::string &text)
  {
    std::vector<double> values;
    std::istringstream in(text + ",");
    for (std::string item; std::getline(in, item, ',');)
      if (const auto number = to_number(trimmed(item)))
        values.push_back(*number);
      else
        return std::nullopt;
    return values;
  }
} // namespace crawler
