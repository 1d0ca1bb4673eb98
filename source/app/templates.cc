// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/templates.h>
#include <crawler/app/texts.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/nearest_name.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace crawler
{
  std::vector<std::string>
  template_names()
  {
    std::vector<std::string> names;
    for (const Template &one : templates)
      names.emplace_back(one.name);
    return names;
  }

  void
  print_template(const std::string &name, const std::string &output)
  {
    const auto *const found =
      std::find_if(std::begin(templates), std::end(templates), [&](const Template &one) { return one.name == name; });
    if (found == std::end(templates))
    {
      throw InputError(fmt::format("unknown template \"{}\"; {} is expected{}",
                                   name,
                                   quoted_list(template_names()),
                                   nearest_hint(name, template_names())));
    }
    if (output.empty())
      std::cout << found->text;
    else
    {
      std::error_code ignored;
      if (std::filesystem::exists(std::filesystem::symlink_status(output, ignored)))
        throw InputError(fmt::format("\"{}\" already exists; the name of a new file is expected", output));
      write_file(output, found->text);
    }
  }
} // namespace crawler
