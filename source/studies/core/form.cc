// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/entry_lists.h>
#include <crawler/studies/core/form.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace crawler
{
  std::string
  changes(const Declarations &declarations, const ParameterFile &base)
  {
    std::string text;
    std::vector<std::string> open; // sections
    const auto indentation = [&]() { return std::string(2 * open.size(), ' '); };
    const auto go_to       = [&](const std::vector<std::string> &sections) {
      const auto common =
        std::mismatch(open.begin(), open.end(), sections.begin(), sections.end()).first - open.begin();
      while (open.size() > static_cast<std::size_t>(common))
      {
        open.pop_back();
        text += indentation() + "end\n";
      }
      for (std::size_t i = open.size(); i < sections.size(); ++i)
      {
        text += fmt::format("{}subsection {}\n", indentation(), sections[i]);
        open.push_back(sections[i]);
      }
    };
    for (unsigned int i = 0; i < declarations.entries().size(); ++i)
    {
      const EntryInfo &entry        = declarations.entries()[i];
      const Assignment *const known = base.assignment_of(entry.path);
      const std::string value       = declarations.value(i);
      if (value == (known != nullptr ? known->value : entry.default_value))
        continue;
      std::vector<std::string> words = split_path(entry.path);
      const std::string name         = words.back();
      words.pop_back();
      go_to(words);
      text += fmt::format("{}set {} = {}\n", indentation(), name, value);
    }
    go_to({});
    return text;
  }

  Form::Form(const ParameterFile &file, const ParameterFile *scene)
  {
    const bool scene_has_terms = scene != nullptr && !scene->subsections("Active stress/Sum").empty();
    parameters.count_terms(scene_has_terms ? *scene : file);
    parameters.add_parameters(declarations);
    file.apply(declarations);
    if (scene == nullptr)
      return;
    for (const Assignment &assignment : scene->assignments())
      try
      {
        declarations.set(assignment.path, assignment.value, assignment.folder);
      }
      catch (const InputError &error)
      {
        throw InputError(assignment.place + ": " + error.what());
      }
    for (const Assignment &assignment : file.assignments())
      if (assignment.is_override) // stronger than all files
        declarations.set(assignment.path, assignment.value, assignment.folder);
  }

  std::string
  Form::effective() const
  {
    std::ostringstream text;
    print_prm(declarations, text);
    return text.str();
  }

  Parameters
  Form::parameters_with(const std::string &path, const double value)
  {
    const std::string own = declarations.value(path);
    try
    {
      declarations.set(path, to_text(value));
      Parameters other = parameters;
      declarations.set(path, own);
      return other;
    }
    catch (const InputError &)
    {
      declarations.set(path, own);
      throw;
    }
  }
} // namespace crawler
