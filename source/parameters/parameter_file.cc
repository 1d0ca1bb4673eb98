// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/files.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/parameters/slips.h>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>

namespace crawler
{
  namespace
  {
    constexpr std::size_t deepest_section = 100;
    constexpr unsigned int max_included   = 1000;
    constexpr std::size_t max_bytes       = 1 << 26; // with all included files

    /// Reads all bytes, up to slightly more than admissible.
    std::string
    read_bytes(std::istream &in)
    {
      std::string text;
      for (std::vector<char> part(1 << 16); in && text.size() <= max_bytes;)
      {
        in.read(part.data(), static_cast<std::streamsize>(part.size()));
        text.append(part.data(), static_cast<std::size_t>(in.gcount()));
      }
      return text;
    }

    std::string
    read_whole(const std::string &file_name)
    {
      if (file_name == "-")
        return read_bytes(std::cin);
      std::error_code ignored;
      if (std::filesystem::is_directory(file_name, ignored))
        throw FileError(fmt::format("\"{}\" is a folder; the name of a parameter file is expected", file_name));
      if (const std::string reason = unreadable(file_name); !reason.empty())
        throw FileError(fmt::format("\"{}\" {}; the name of a parameter file is expected", file_name, reason));
      std::ifstream in(file_name, std::ios::binary);
      if (const std::string sign = home_sign(file_name); !in && !sign.empty())
        throw FileError(sign);
      if (!in)
        throw FileError(
          fmt::format("cannot read \"{}\": {}",
                      file_name,
                      std::filesystem::exists(file_name, ignored) ? "permission denied" : "there is no such file"));
      return read_bytes(in);
    }

    /// Splits a line into its first word and the rest.
    std::pair<std::string, std::string>
    first_word(const std::string &line)
    {
      const auto end = line.find_first_of(" \t");
      if (end == std::string::npos)
        return {line, ""};
      return {line.substr(0, end), trimmed(line.substr(end))};
    }

    /// A line without its comment, joined with its continuation lines.
    struct Statement
    {
      std::string text;
      unsigned int line; ///< its first line
    };

    std::vector<Statement>
    statements_of(const std::string &text)
    {
      std::vector<Statement> statements;
      std::istringstream in{std::string(without_byte_order_mark(text))};
      std::string raw, line;
      for (unsigned int number = 1, first = 1; std::getline(in, raw); ++number)
      {
        raw = trimmed(raw.substr(0, raw.find('#')));
        if (line.empty())
          first = number;
        const bool continues = raw.ends_with('\\');
        line += continues ? raw.substr(0, raw.size() - 1) : raw;
        if (continues && !in.eof())
          continue;
        if (const std::string whole = trimmed(line); !whole.empty())
          statements.push_back({whole, first});
        line.clear();
      }
      return statements;
    }

    /// Error of an assignment, with its place and a probable slip. A foreign sign is reported instead.
    InputError
    at_place(const Assignment &assignment, const InputError &error)
    {
      std::string sign = foreign_sign(assignment.path);
      if (sign.empty())
        sign = foreign_sign(assignment.value);
      if (!sign.empty())
        return InputError(assignment.place + ": " + sign, error.entry);
      const std::string slip = probable_slip(assignment.value), sentence = error.what();
      const bool is_told = !slip.empty() && sentence.find(slip.substr(2)) != std::string::npos;
      return InputError(assignment.place + ": " + sentence + (is_told ? "" : slip), error.entry);
    }

    /// Throws InputError for a statement that is not of the parameter files.
    [[noreturn]] void
    refuse_statement(const std::string &statement, const std::string &place)
    {
      const std::string sign = foreign_sign(statement);
      throw InputError(!sign.empty() ? fmt::format("{}: {}", place, sign)
                                     : fmt::format("{}: found \"{}\", but \"set\", \"subsection\", \"end\", "
                                                   "\"include\" or \"#\" is expected at the beginning of a line",
                                                   place,
                                                   statement.substr(0, 60)));
    }

    /// Throws InputError for files that are no text.
    void
    require_text(const std::string &text, const std::string &name)
    {
      if (const std::string found = foreign_format(text); !found.empty())
        throw InputError(
          fmt::format("{}: this is {}, but a text file of parameters in UTF-8 is expected", name, found));
    }
  } // namespace

  ParameterFile
  ParameterFile::read(const std::string &file_name)
  {
    return from_text(read_whole(file_name), file_name == "-" ? "standard input" : file_name);
  }

  ParameterFile
  ParameterFile::from_text(const std::string &text, const std::string &name)
  {
    ParameterFile file;
    file.name_ = name;
    file.text_ = text;
    file.parse(text, name, 0);
    if (file.assignments_.empty() && file.sections_.empty())
      throw InputError(
        fmt::format("{}: the file sets nothing; at least one line \"set Entry = value\" is expected (see crawler "
                    "parameters)",
                    name));
    return file;
  }

  void
  ParameterFile::parse(const std::string &text, const std::string &name, const unsigned int depth)
  {
    n_bytes_ += text.size();
    if (n_bytes_ > max_bytes)
      throw InputError(fmt::format(
        "{}: at most {} MB of parameters, including all included files, are expected", name, max_bytes >> 20));
    require_text(text, name);
    const auto folder = std::filesystem::path(name).parent_path();
    std::vector<std::pair<std::string, unsigned int>> open; // open sections, and the lines that opened them
    const auto path = [&open](const std::string &last) {
      std::string result;
      for (const auto &[section, line] : open)
        result += section + "/";
      return normal_path(result + last);
    };

    for (const auto &[statement, first] : statements_of(text))
    {
      const std::string place    = fmt::format("{}, line {}", name, first);
      const auto [keyword, rest] = first_word(statement);
      if (keyword == "subsection")
      {
        if (rest.empty())
          throw InputError(fmt::format("{}: \"subsection\" without a name", place));
        if (open.size() == deepest_section)
          throw InputError(fmt::format("{}: sections are nested more than {} deep", place, deepest_section));
        sections_.push_back({path(rest), place});
        open.emplace_back(rest, first);
      }
      else if (statement == "end")
      {
        if (open.empty())
          throw InputError(fmt::format("{}: \"end\" without a matching \"subsection\"", place));
        open.pop_back();
      }
      else if (keyword == "set")
      {
        const auto equals = rest.find('=');
        if (equals == std::string::npos || trimmed(rest.substr(0, equals)).empty())
          throw InputError(fmt::format("{}: found \"{}\", but \"set Entry = value\" is expected", place, statement));
        const Assignment assignment{
          path(trimmed(rest.substr(0, equals))), trimmed(rest.substr(equals + 1)), place, false, folder, depth};
        if (const Assignment *const other = assignment_of(assignment.path); other != nullptr && other->depth <= depth)
          throw InputError(fmt::format("{}: \"{}\" is set a second time (first in {}), but is expected only once",
                                       place,
                                       assignment.path,
                                       other->place));
        add(assignment);
      }
      else if (keyword == "include")
      {
        if (!open.empty())
          throw InputError(fmt::format("{}: \"include\" is expected outside of all subsections", place));
        include(rest, folder, place, depth);
      }
      else
        refuse_statement(statement, place);
    }
    if (!open.empty())
      throw InputError(
        fmt::format("{}, line {}: \"subsection {}\" has no \"end\"", name, open.back().second, open.back().first));
  }

  void
  ParameterFile::include(const std::string &file_name,
                         const std::filesystem::path &folder,
                         const std::string &place,
                         const unsigned int depth)
  {
    if (depth == 10)
      throw InputError(fmt::format("{}: included files are nested more than 10 deep", place));
    if (++n_included_ > max_included)
      throw InputError(fmt::format(
        "{}: this is included file number {}, but at most {} are expected", place, n_included_, max_included));
    if (file_name.empty())
      throw InputError(fmt::format("{}: \"include\" without the name of a file", place));
    if (const std::string sign = home_sign(file_name); !sign.empty())
      throw InputError(fmt::format("{}: {}", place, sign));
    const auto file = (folder / (file_name == "-" ? "./-" : file_name)).string(); // standard input cannot be included
    std::string included;
    try
    {
      included = read_whole(file);
    }
    catch (const FileError &error)
    {
      throw FileError(fmt::format("{}: {}", place, error.what()));
    }
    parse(included, file, depth + 1);
  }

  void
  ParameterFile::add_override(const std::string &assignment)
  {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || trimmed(assignment.substr(0, equals)).empty())
      throw InputError(fmt::format("--set \"{}\": \"Section/Entry=value\" is expected", assignment));
    overrides_.push_back(assignment);
    add({normal_path(assignment.substr(0, equals)),
         trimmed(assignment.substr(equals + 1)),
         fmt::format("--set \"{}\"", assignment),
         true,
         ""});
  }

  void
  ParameterFile::add(const Assignment &assignment)
  {
    latest_[assignment.path] = assignments_.size();
    assignments_.push_back(assignment);
  }

  void
  ParameterFile::apply(Declarations &declarations) const
  {
    for (const Section &section : sections_)
      try
      {
        declarations.require_section(section.path);
      }
      catch (const InputError &error)
      {
        const std::string sign = foreign_sign(section.path);
        throw InputError(section.place + ": " + (sign.empty() ? error.what() : sign), section.path);
      }
    for (const Assignment &assignment : assignments_)
      try
      {
        declarations.set(assignment.path, assignment.value, assignment.folder);
      }
      catch (const InputError &error)
      {
        throw at_place(assignment, InputError(error.what(), assignment.path));
      }
  }

  std::set<std::string>
  ParameterFile::subsections(const std::string &path) const
  {
    std::set<std::string> names;
    const auto add = [&](const std::string &inner, const bool is_entry) {
      if (!inner.starts_with(path + "/"))
        return;
      const std::string rest = inner.substr(path.size() + 1);
      const auto slash       = rest.find('/');
      if (slash != std::string::npos || !is_entry)
        names.insert(rest.substr(0, slash));
    };
    for (const Section &section : sections_)
      add(section.path, /*is_entry=*/false);
    for (const Assignment &assignment : assignments_)
      add(assignment.path, /*is_entry=*/true);
    return names;
  }

  const Assignment *
  ParameterFile::assignment_of(const std::string &path) const
  {
    const auto found = latest_.find(path);
    return found == latest_.end() ? nullptr : &assignments_[found->second];
  }

  InputError
  ParameterFile::with_place(const InputError &error) const
  {
    const auto sets = [&](const Assignment &one) {
      return one.path == error.entry || one.path.starts_with(error.entry + "["); // or one number of a list
    };
    const auto last = std::find_if(assignments_.rbegin(), assignments_.rend(), sets);
    return last != assignments_.rend() ? at_place(*last, error) : InputError(name_ + ": " + error.what(), error.entry);
  }
} // namespace crawler
