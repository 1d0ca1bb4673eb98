// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/studies/table/measured_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>

namespace crawler
{
  namespace
  {
    struct Line
    {
      std::string text;
      std::size_t number;
    };

    std::string
    trimmed(const std::string_view text)
    {
      constexpr const char *blanks = " \t\r\n\v\f";
      const auto first             = text.find_first_not_of(blanks);
      return first == text.npos ? "" : std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
    }

    std::string
    without_quotes(std::string text)
    {
      if (text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
        text = trimmed(std::string_view(text).substr(1, text.size() - 2));
      return text;
    }

    bool
    is_gap(std::string text)
    {
      std::transform(text.begin(), text.end(), text.begin(), [](const unsigned char c) { return std::tolower(c); });
      constexpr std::array<std::string_view, 8> words = {{"", "nan", "na", "n/a", "-", "--", "null", "none"}};
      return std::find(words.begin(), words.end(), text) != words.end();
    }

    /// How the cells of a file are written.
    struct Style
    {
      char separator;
      bool has_decimal_commas = false;

      std::vector<std::string>
      cells(const std::string &line) const
      {
        std::vector<std::string> result;
        if (separator == ' ')
        {
          for (std::size_t i = line.find_first_not_of(" \t"); i != line.npos;)
          {
            const std::size_t end = std::min(line.find_first_of(" \t", i), line.size());
            result.push_back(without_quotes(line.substr(i, end - i)));
            i = line.find_first_not_of(" \t", end);
          }
          return result;
        }
        for (std::size_t i = 0; i <= line.size();)
        {
          const std::size_t end = std::min(line.find(separator, i), line.size());
          result.push_back(without_quotes(trimmed(std::string_view(line).substr(i, end - i))));
          i = end + 1;
        }
        return result;
      }

      /// A number; a gap is one, too.
      std::optional<double>
      number(std::string cell) const
      {
        if (is_gap(cell))
          return gap;
        if (has_decimal_commas)
        {
          if (cell.find('.') != cell.npos)
            return std::nullopt;
          std::replace(cell.begin(), cell.end(), ',', '.');
        }
        return number_in(cell);
      }

      /// A row of numbers and gaps.
      bool
      is_row(const std::vector<std::string> &cells) const
      {
        return cells.size() > 1 && !std::ranges::all_of(cells, is_gap) &&
               std::ranges::all_of(cells, [&](const std::string &cell) { return number(cell).has_value(); });
      }
    };

    bool
    has_decimal_comma(const std::string &cell)
    {
      const auto comma = cell.find(',');
      return comma != cell.npos && cell.find_first_not_of("+-0123456789,eE") == cell.npos &&
             cell.find(',', comma + 1) == cell.npos && cell.find_first_of("0123456789") != cell.npos;
    }

    /// The first of semicolon, tab and comma that stands in the last line, else blanks.
    Style
    style_of(const std::vector<Line> &lines)
    {
      const std::string &last = lines.back().text;
      Style style{' '};
      for (const char separator : {',', '\t', ';'})
        if (last.find(separator) != last.npos)
          style.separator = separator;
      // Numbers between blanks may have decimal commas: "0,5 1,25".
      if (style.separator == ',' && last.find(' ') != last.npos)
      {
        const std::vector<std::string> cells = Style{' '}.cells(last);
        if (cells.size() > 1 && std::all_of(cells.begin(), cells.end(), [](const std::string &cell) {
              return has_decimal_comma(cell) || is_gap(cell) || number_in(cell);
            }))
          style.separator = ' ';
      }
      if (style.separator != ',')
        for (const Line &line : lines)
          for (const std::string &cell : style.cells(line.text))
            style.has_decimal_commas = style.has_decimal_commas || has_decimal_comma(cell);
      return style;
    }

    /// "t [s]", "t (s)" and "t / s" are a name and a unit.
    void
    add_column(MeasuredFile &file, const std::string &cell)
    {
      for (const auto &[open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}})
        if (const auto at = cell.rfind(open); at != cell.npos && cell.back() == close)
        {
          file.columns.push_back(trimmed(std::string_view(cell).substr(0, at)));
          file.units.push_back(trimmed(std::string_view(cell).substr(at + 1, cell.size() - at - 2)));
          return;
        }
      const auto slash = cell.find('/');
      file.columns.push_back(trimmed(std::string_view(cell).substr(0, slash)));
      file.units.push_back(slash == cell.npos ? "" : trimmed(std::string_view(cell).substr(slash + 1)));
    }

    /// The sentence about the first cell of a row that is no number.
    std::string
    wrong_cell(const std::vector<std::string> &columns,
               const std::string &file,
               const Line &line,
               const std::vector<std::string> &cells,
               const Style &style)
    {
      const auto wrong = static_cast<std::size_t>(
        std::ranges::find_if(cells, [&](const std::string &cell) { return !style.number(cell); }) - cells.begin());
      if (wrong == cells.size())
        return fmt::format("row {} of \"{}\" has no number, but one at least is expected", line.number, file);
      return fmt::format(
        "row {} of \"{}\" has \"{}\" under {}, but a number{} (or nothing or NaN for a gap) is expected",
        line.number,
        file,
        cells[wrong],
        columns[wrong],
        style.has_decimal_commas ? " with a decimal comma" : "");
    }

    /// Names and units from the lines above the first row of numbers; without a line of names a comment may have them.
    void
    read_head(MeasuredFile &file,
              const std::vector<Line> &head,
              const Line &last_comment,
              const Style &style,
              const std::size_t n)
    {
      std::vector<std::vector<std::string>> found;
      for (const Line &line : head)
        if (auto cells = style.cells(line.text); cells.size() == n)
        {
          // Names may be places, but units have no numbers among them: this is a row of samples.
          const auto is_number = [&](const std::string &cell) { return !is_gap(cell) && style.number(cell); };
          if (!found.empty() && std::ranges::any_of(cells, is_number))
            throw InputError(wrong_cell(found[0], file.name, line, cells, style));
          found.push_back(std::move(cells));
        }
      const std::size_t n_titles = head.size() - found.size();
      if (found.empty())
        if (auto cells = style.cells(last_comment.text); cells.size() == n)
          found.push_back(std::move(cells));
      if (found.empty())
        throw InputError(
          fmt::format("\"{}\" has no line of {} names above its numbers, but one is expected, as t;s;m or "
                      "t;0;0.25;0.5 or t;x1;x2;x3",
                      file.name,
                      n));
      for (const std::string &cell : found[0])
        add_column(file, cell);
      if (found.size() > 1)
        for (std::size_t i = 0; i < n; ++i)
          if (file.units[i].empty())
          {
            file.units[i] = found[1][i];
            if (file.units[i].size() > 1 && (file.units[i].front() == '[' || file.units[i].front() == '('))
              file.units[i] = file.units[i].substr(1, file.units[i].size() - 2);
          }
      if (n_titles > 0)
        file.words.push_back(fmt::format("{} above the names left out", counted(n_titles, "line")));
    }
  } // namespace

  MeasuredFile
  read_measured_file(const std::string &text, const std::string &name)
  {
    MeasuredFile file;
    file.name = name;
    if (const std::string foreign = foreign_format(text); !foreign.empty())
      throw InputError(fmt::format("\"{}\" is {}, but a table as text in UTF-8 is expected", name, foreign));
    std::vector<Line> lines;
    Line last_comment{"", 0};
    std::string_view rest = without_byte_order_mark(text);
    for (std::size_t number = 1; !rest.empty(); ++number)
    {
      const auto end   = std::min(rest.find('\n'), rest.size());
      std::string line = std::string(rest.substr(0, end));
      if (!line.empty() && line.back() == '\r')
        line.pop_back();
      rest                    = rest.substr(std::min(end + 1, rest.size()));
      const std::string shown = trimmed(line);
      if (shown.empty())
        continue;
      if (shown[0] != '#' && shown[0] != '%' && !shown.starts_with("//"))
        lines.push_back({line, number});
      else if (lines.empty())
        last_comment = {trimmed(std::string_view(shown).substr(shown[0] == '/' ? 2 : 1)), number};
    }
    if (lines.empty())
      throw InputError(fmt::format("\"{}\" is empty, but a table of numbers is expected", name));
    const Style style = style_of(lines);
    const auto first =
      std::find_if(lines.begin(), lines.end(), [&](const Line &line) { return style.is_row(style.cells(line.text)); });
    if (first == lines.end())
      throw InputError(fmt::format("\"{}\" has no row of numbers; its last line, {}, is \"{}\"",
                                   name,
                                   lines.back().number,
                                   trimmed(lines.back().text)));
    const std::size_t n = style.cells(first->text).size();
    read_head(file, {lines.begin(), first}, last_comment, style, n);
    Mistakes mistakes;
    for (auto line = first; line != lines.end(); ++line)
    {
      const std::vector<std::string> cells = style.cells(line->text);
      if (cells.size() == n && style.is_row(cells))
      {
        file.values.emplace_back();
        for (const std::string &cell : cells)
          file.values.back().push_back(*style.number(cell));
        file.lines.push_back(line->number);
      }
      else if (!mistakes.is_first(line->number))
        continue;
      else if (cells.size() != n)
        mistakes.say(fmt::format("row {} of \"{}\" has {} cells, but {} are expected, as in row {}",
                                 line->number,
                                 name,
                                 cells.size(),
                                 n,
                                 first->number));
      else
        mistakes.say(wrong_cell(file.columns, name, *line, cells, style));
    }
    mistakes.refuse("");
    const auto separator = style.separator == ';'    ? "semicolons"
                           : style.separator == '\t' ? "tabs"
                           : style.separator == ','  ? "commas"
                                                     : "blanks";
    file.words.insert(file.words.begin(),
                      fmt::format("{} of {} columns between {}{}",
                                  counted(file.values.size(), "row"),
                                  n,
                                  separator,
                                  style.has_decimal_commas ? ", with decimal commas" : ""));
    return file;
  }
} // namespace crawler
