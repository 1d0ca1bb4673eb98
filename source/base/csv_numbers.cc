// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

namespace crawler
{
  namespace
  {
    std::string_view
    without_blanks(std::string_view text)
    {
      constexpr const char *blanks = " \t\r\n";
      const auto first             = text.find_first_not_of(blanks);
      return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
    }

    /// Cuts the part before @p separator off @p text and returns it.
    std::string_view
    next_part(std::string_view &text, const char separator)
    {
      const auto end  = text.find(separator);
      const auto part = text.substr(0, end);
      text            = end == text.npos ? std::string_view() : text.substr(end + 1);
      return part;
    }

    /// Advice for rows of a spreadsheet with another country's number format, and for gaps.
    std::string
    hint(const std::string_view line, const std::size_t n_columns)
    {
      const bool is_of_samples = n_columns == 3;
      if (line.find(';') != line.npos)
        return fmt::format(" (columns are separated by commas, and decimals written with a point{})",
                           is_of_samples ? "; \"crawler table IN OUT\" does that" : "");
      const bool has_gap = line.ends_with(',') || line.find(",,") != line.npos || line.find("nan") != line.npos ||
                           line.find("NaN") != line.npos;
      return has_gap && is_of_samples ? " (\"crawler table IN OUT\" fills gaps)" : "";
    }

    /// Returns the finite number that is the whole text apart from blanks, or nothing.
    std::optional<double>
    number_in(std::string_view text)
    {
      text = without_blanks(text);
      if (text.size() > 1 && text[0] == '+' && text[1] != '-')
        text.remove_prefix(1);
      double value             = 0.;
      const auto [end, result] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (result == std::errc::invalid_argument || end != text.data() + text.size())
        return std::nullopt;
      if (result == std::errc::result_out_of_range) // magnitude smaller or larger than any double
        value = std::strtod(std::string(text).c_str(), nullptr);
      return std::isfinite(value) ? std::optional(value) : std::nullopt;
    }
  } // namespace

  void
  Mistakes::note(const std::size_t row, const std::function<std::string()> &sentence)
  {
    if (sentence_.empty())
    {
      first_    = row;
      sentence_ = sentence();
    }
    else if (row != first_)
      others_.insert(row);
  }

  void
  Mistakes::report(const std::string &entry) const
  {
    constexpr std::ptrdiff_t most = 4;
    if (sentence_.empty())
      return;
    if (others_.empty())
      throw InputError(sentence_, entry);
    const auto n = static_cast<std::ptrdiff_t>(others_.size());
    refuse(entry,
           "{}; {} more {} like it: {}{}",
           sentence_,
           n,
           n == 1 ? "row is" : "rows are",
           fmt::join(others_.begin(), std::next(others_.begin(), std::min(n, most)), ", "),
           n > most ? ", ..." : "");
  }

  CsvNumbers
  csv_numbers(std::string_view text,
              const std::vector<std::string> &names,
              const std::string &file,
              const std::string &entry)
  {
    const std::string header = fmt::format("{}", fmt::join(names, ","));
    if (const std::string found = foreign_format(text); !found.empty())
      refuse(entry, "\"{}\" is {}, but a CSV file in UTF-8 with the header {} is expected", file, found, header);
    text                         = without_byte_order_mark(text);
    const std::string_view first = without_blanks(next_part(text, '\n'));
    std::string words;
    for (std::string_view rest = first; !rest.empty();)
      words += (words.empty() ? "" : ",") + std::string(without_blanks(next_part(rest, ',')));
    if (words != header)
      refuse(entry,
             "the first row of \"{}\" is \"{}\", but the header {} is expected{}",
             file,
             first.substr(0, 80),
             header,
             hint(first, names.size()));
    CsvNumbers numbers;
    numbers.columns.resize(names.size());
    Mistakes mistakes;
    std::vector<std::optional<double>> row(names.size());
    for (std::size_t number = 2; !text.empty(); ++number)
    {
      const std::string_view line = without_blanks(next_part(text, '\n'));
      if (line.empty())
        continue;
      std::string_view rest = line;
      for (std::size_t i = 0; i < names.size(); ++i)
        row[i] = number_in(i + 1 < names.size() ? next_part(rest, ',') : rest);
      if (std::all_of(row.begin(), row.end(), [](const auto &value) { return value.has_value(); }))
      {
        for (std::size_t i = 0; i < names.size(); ++i)
          numbers.columns[i].push_back(*row[i]);
        numbers.rows.push_back(number);
      }
      else
        mistakes.note(number, [&]() {
          return fmt::format("row {} of \"{}\" is \"{}\", but {} numbers {} are expected{}",
                             number,
                             file,
                             line.substr(0, 80),
                             names.size() == 2 ? "two" : "three",
                             header,
                             hint(line, names.size()));
        });
    }
    mistakes.report(entry);
    return numbers;
  }

  std::string
  read_table_text(const std::string &file, const std::string &expected, const std::string &entry)
  {
    if (const std::string reason = unreadable(file); !reason.empty())
      throw InputError("\"" + file + "\" " + reason + "; " + expected + " is expected", entry);
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    if (!in || !(text << in.rdbuf()))
      throw InputError("cannot read \"" + file + "\", or it is empty; " + expected + " is expected", entry);
    return std::move(text).str();
  }

  CsvNumbers
  read_csv_numbers(const std::string &file,
                   const std::vector<std::string> &names,
                   const std::string &expected,
                   const std::string &entry)
  {
    return csv_numbers(read_table_text(file, expected, entry), names, file, entry);
  }
} // namespace crawler
