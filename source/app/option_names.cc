// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/option_names.h>

namespace crawler
{
  std::vector<const CLI::App *>
  all_commands(const CLI::App &app)
  {
    return app.get_subcommands([](const CLI::App *) { return true; });
  }

  std::vector<std::string>
  typed_names(const CLI::Option &option)
  {
    std::vector<std::string> names;
    for (const std::string &name : option.get_lnames())
      names.push_back("--" + name);
    for (const std::string &name : option.get_snames())
      names.push_back("-" + name);
    return names;
  }
} // namespace crawler
