// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/templates.h>
#include <crawler/app/texts.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace crawler
{
  namespace
  {
    /// Writes a file that does not exist yet.
    void
    write_new_file(const std::string &path, const std::string_view text)
    {
      std::FILE *const file = std::fopen(path.c_str(), "wx");
      if (file == nullptr && errno == EEXIST)
        throw InputError(fmt::format("\"{}\" already exists; the name of a new file is expected", path));
      bool good = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
      int error = errno;
      if (file != nullptr && std::fclose(file) != 0 && good)
      {
        good  = false;
        error = errno;
      }
      if (good)
        return;
      if (file != nullptr)
        std::remove(path.c_str()); // created just now
      throw FileError(fmt::format("cannot write \"{}\": {}", path, std::strerror(error)), /*on_all_ranks=*/true);
    }
  } // namespace

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
      const auto near = nearest_names(name, template_names(), 1);
      throw InputError(fmt::format("unknown template \"{}\"; {} is expected{}",
                                   name,
                                   quoted_list(template_names()),
                                   near.empty() ? "" : "; the nearest is " + quoted_list(near)));
    }
    if (output.empty())
      std::cout << found->text;
    else
      write_new_file(output, found->text);
  }
} // namespace crawler
