// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/parameter_listing.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/base/versions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/entry_lists.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/run/summary.h>
#include <crawler/studies/core/parameters.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>
#include <string_view>

namespace crawler
{
  namespace
  {
    /// Prints descriptions of the numbers in summary.json, and the versions of the program, for pages that show them.
    void
    print_results(const Declarations &, std::ostream &out)
    {
      out << nlohmann::ordered_json({{"versions", versions()}, {"numbers", result_entries()}}).dump(2) << "\n";
    }

    struct Format
    {
      std::string_view name;
      void (*print)(const Declarations &, std::ostream &);
    };
    constexpr Format formats[] = {{"prm", print_prm},
                                  {"json", print_json},
                                  {"markdown", print_markdown},
                                  {"schema", print_schema},
                                  {"results", print_results}};

    /// Declares all entries, with one term of a sum, to show its entries.
    void
    declare(Parameters &parameters, Declarations &declarations)
    {
      parameters.count_terms(ParameterFile::from_text("subsection Active stress\nsubsection Sum\nsubsection Term 1\n"
                                                      "end\nend\nend\n",
                                                      "one term"));
      parameters.add_parameters(declarations);
    }
  } // namespace

  std::vector<std::string>
  parameter_formats()
  {
    std::vector<std::string> names;
    for (const Format &format : formats)
      names.emplace_back(format.name);
    return names;
  }

  void
  print_parameters(const std::string &format, const std::string &section)
  {
    const auto *const found = std::ranges::find(formats, format, &Format::name);
    if (found == std::end(formats))
      throw InputError(
        fmt::format("\"--format\" is \"{}\", but {} is expected", format, quoted_list(parameter_formats())));
    Parameters parameters;
    Declarations declarations(section.empty() ? "" : normal_path(section));
    declare(parameters, declarations);
    if (declarations.entries().empty())
      declarations.require_section(normal_path(section));
    found->print(declarations, std::cout);
  }

  std::vector<std::string>
  entry_names()
  {
    Parameters parameters;
    Declarations declarations;
    declare(parameters, declarations);
    std::vector<std::string> names;
    for (const EntryInfo &entry : declarations.entries())
      names.push_back(entry.path);
    return names;
  }
} // namespace crawler
