// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/entry_lists.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    bool
    is_text(const EntryKind kind)
    {
      return kind == EntryKind::text || kind == EntryKind::constants || kind == EntryKind::profile;
    }

    /// A value as JSON.
    Json
    typed(const std::string &text, const EntryKind kind)
    {
      if (kind == EntryKind::flag)
        return text == "true";
      if (kind == EntryKind::numbers)
        return Json::parse("[" + text + "]");
      const auto number = is_text(kind) || kind == EntryKind::choice ? std::nullopt : to_number(text);
      return number ? Json::parse(text) : Json(text);
    }

    Json
    schema_of(const EntryValues &values)
    {
      if (values.kind == EntryKind::choice)
        return {{"enum", values.words}};
      if (values.kind == EntryKind::numbers)
        return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", values.may_be_empty ? 0 : 1}};
      if (values.kind == EntryKind::flag)
        return {{"type", "boolean"}};
      if (is_text(values.kind))
        return {{"type", "string"}};
      Json schema        = {{"type", values.kind == EntryKind::number ? "number" : "integer"}};
      const Range &range = values.range;
      if (std::isfinite(range.lower))
        schema[range.lower_included ? "minimum" : "exclusiveMinimum"] = range.lower;
      if (std::isfinite(range.upper))
        schema[range.upper_included ? "maximum" : "exclusiveMaximum"] = range.upper;
      return schema;
    }

    Json
    schema_of(const EntryInfo &entry)
    {
      Json schema = schema_of(entry.values);
      if (entry.values.may_be_automatic)
        schema = {{"anyOf", {schema, {{"const", "automatic"}}}}};
      schema["default"]     = typed(entry.default_value, entry.values.kind);
      schema["description"] = entry.documentation;
      if (!entry.unit.empty())
        schema["unit"] = entry.unit;
      return schema;
    }

    /// Breaks @p text into lines of at most @p width characters; the last one is shorter than that, as
    /// dealii::ParameterHandler writes them.
    std::vector<std::string>
    lines_of(const std::string &text, const std::size_t width)
    {
      std::vector<std::string> lines;
      std::istringstream words(text);
      for (std::string word; words >> word;)
      {
        const bool is_last = (words >> std::ws).eof();
        if (lines.empty() || lines.back().size() + 1 + word.size() + (is_last ? 1 : 0) > width)
          lines.push_back(word);
        else
          lines.back() += " " + word;
      }
      return lines;
    }

    /// Prints the entries with the numbers @p own, all of one section.
    void
    print_entries(const Declarations &declarations,
                  const std::vector<unsigned int> &own,
                  const std::string &indent,
                  std::ostream &out)
    {
      constexpr std::size_t width = 78;
      const auto name_of = [&](const unsigned int i) { return split_path(declarations.entries()[i].path).back(); };
      std::size_t longest_name = 0, longest_value = 0;
      for (const unsigned int i : own)
      {
        longest_name  = std::max(longest_name, name_of(i).size());
        longest_value = std::max(longest_value, declarations.value(i).size());
      }
      for (const unsigned int i : own)
      {
        const EntryInfo &entry  = declarations.entries()[i];
        const std::string value = declarations.value(i), name = name_of(i);
        const std::string unit = entry.unit.empty() ? "" : " Unit: " + entry.unit + ".";
        if (i != own.front())
          out << "\n";
        for (const std::string &line :
             lines_of(entry.documentation + " Expected: " + entry.expected + "." + unit, width - indent.size() - 2))
          out << indent << "# " << line << "\n";
        out << indent << "set " << name << std::string(longest_name - name.size(), ' ') << " = " << value;
        if (value != entry.default_value)
          out << std::string(longest_value - value.size(), ' ') << " # default: " << entry.default_value;
        out << "\n";
      }
    }

    /// Prints a section with the sections below, @p depth deep, in the order of their declaration; the paths of its
    /// entries begin with @p section.
    void
    print_section(const Declarations &declarations,
                  const std::string &section,
                  const std::size_t depth,
                  std::ostream &out)
    {
      std::vector<unsigned int> own;
      std::vector<std::string> below;
      for (unsigned int i = 0; i < declarations.entries().size(); ++i)
      {
        const std::string &path = declarations.entries()[i].path;
        if (!path.starts_with(section))
          continue;
        const std::string rest = path.substr(section.size()), name = rest.substr(0, rest.find('/'));
        if (name == rest)
          own.push_back(i);
        else if (std::ranges::find(below, name) == below.end())
          below.push_back(name);
      }
      const std::string indent(2 * depth, ' ');
      print_entries(declarations, own, indent, out);
      if (!own.empty() && !below.empty())
        out << "\n\n";
      for (const std::string &name : below)
      {
        out << indent << "subsection " << name << "\n";
        print_section(declarations, section + name + "/", depth + 1, out);
        out << indent << "end\n" << (depth == 0 ? "\n\n" : "\n");
      }
    }

    void
    make_object(Json &schema)
    {
      schema["type"]                 = "object";
      schema["additionalProperties"] = false;
    }
  } // namespace

  void
  print_prm(const Declarations &declarations, std::ostream &out)
  {
    out << "# Listing of Parameters\n# ---------------------\n";
    print_section(declarations, "", 0, out);
  }

  void
  print_schema(const Declarations &declarations, std::ostream &out)
  {
    Json root = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Parameters of crawler"}};
    make_object(root);
    for (const EntryInfo &entry : declarations.entries())
    {
      Json *place                          = &root;
      const std::vector<std::string> words = split_path(entry.path);
      for (std::size_t i = 0; i + 1 < words.size(); ++i)
      {
        // A numbered section stands for all of its kind.
        const bool is_numbered = words[i].ends_with(" 1");
        place                  = is_numbered
                                   ? &(*place)["patternProperties"]["^" + words[i].substr(0, words[i].size() - 1) + "[1-9][0-9]*$"]
                                   : &(*place)["properties"][words[i]];
        make_object(*place);
      }
      (*place)["properties"][words.back()] = schema_of(entry);
    }
    out << root.dump(2) << '\n';
  }

  void
  print_json(const Declarations &declarations, std::ostream &out)
  {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EntryInfo &entry : declarations.entries())
      list.push_back({{"entry", entry.path},
                      {"default", entry.default_value},
                      {"expected", entry.expected},
                      {"unit", entry.unit},
                      {"documentation", entry.documentation}});
    out << list.dump(2) << '\n';
  }

  void
  print_markdown(const Declarations &declarations, std::ostream &out)
  {
    out << "# Parameters\n\nGenerated by `crawler parameters --format markdown`; do not edit. An entry "
           "`Section/Entry` is written\nin the file as `set Entry = value` within `subsection Section` ... "
           "`end`, and on the command line as\n`--set \"Section/Entry=value\"`.\n";
    std::string section = "-";
    for (const EntryInfo &entry : declarations.entries())
    {
      const auto words      = split_path(entry.path);
      const std::string own = section_of(entry.path);
      if (own != section)
      {
        section = own;
        out << "\n## " << (section.empty() ? "Top level" : section)
            << "\n\n| entry | default | expected | unit | meaning |\n|---|---|---|---|---|\n";
      }
      const auto cell = [](std::string text) {
        for (std::size_t i = text.find('|'); i != std::string::npos; i = text.find('|', i + 2))
          text.replace(i, 1, "\\|");
        return text;
      };
      out << fmt::format("| {} | `{}` | {} | {} | {} |\n",
                         words.back(),
                         entry.default_value.empty() ? " " : cell(entry.default_value),
                         cell(entry.expected),
                         entry.unit,
                         cell(entry.documentation));
    }
  }
} // namespace crawler
