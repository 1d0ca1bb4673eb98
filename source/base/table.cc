// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/plain_numbers.h>
#include <crawler/base/table.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string_view>

namespace crawler
{
  namespace
  {
    using Numbers = std::vector<double>;
    using Texts   = std::vector<std::string>;

    /// True for texts that a spreadsheet would take for a formula, which may call programs.
    bool
    is_like_formula(const std::string &text)
    {
      char *end = nullptr;
      std::strtod(text.c_str(), &end);
      return !text.empty() && std::string_view("=+-@").find(text[0]) != std::string_view::npos && *end != '\0';
    }

    void
    append(const std::string &raw, fmt::memory_buffer &out)
    {
      const std::string text = (is_like_formula(raw) ? "'" : "") + without_controls(raw, /*keep_lines=*/false);
      if (text.find_first_of(",\"") == std::string::npos)
      {
        out.append(text);
        return;
      }
      out.push_back('"');
      for (const char c : text)
      {
        if (c == '"')
          out.push_back('"');
        out.push_back(c);
      }
      out.push_back('"');
    }

    void
    append(const Column &column, const std::size_t row, fmt::memory_buffer &out)
    {
      if (const auto *texts = std::get_if<Texts>(&column.values))
        append((*texts)[row], out);
      else if (const double value = std::get<Numbers>(column.values)[row]; !std::isnan(value))
        fmt::format_to(std::back_inserter(out), "{}", value + 0.); // no -0
    }

    std::size_t
    size_of(const Column &column)
    {
      return std::visit([](const auto &values) { return values.size(); }, column.values);
    }
  } // namespace

  std::string
  csv_names(const Table &table)
  {
    fmt::memory_buffer text;
    for (std::size_t i = 0; i < table.size(); ++i)
    {
      if (i > 0)
        text.push_back(',');
      append(table[i].name, text);
    }
    text.push_back('\n');
    return fmt::to_string(text);
  }

  std::string
  csv_rows(const Table &table)
  {
    fmt::memory_buffer text;
    for (std::size_t row = 0; row < (table.empty() ? 0 : size_of(table[0])); ++row)
    {
      for (std::size_t i = 0; i < table.size(); ++i)
      {
        if (i > 0)
          text.push_back(',');
        append(table[i], row, text);
      }
      text.push_back('\n');
    }
    return fmt::to_string(text);
  }

  std::string
  csv(const Table &table)
  {
    return csv_names(table) + csv_rows(table);
  }
} // namespace crawler
