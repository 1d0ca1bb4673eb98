// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/core/form.h>


namespace crawler
{
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
