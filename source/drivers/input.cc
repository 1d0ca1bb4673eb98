// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/drivers/input.h>
#include <crawler/parameters/declarations.h>

#include <sstream>

namespace crawler
{
  Input
  read_input(MPI_Comm communicator, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    ParameterFile     own;
    const std::string text = on_first_rank(communicator, [&]() {
      own = ParameterFile::read(file_name);
      return own.text();
    });
    ParameterFile file = ParameterFile::from_text(text, file_name == "-" ? "standard input" : file_name);
    for (const std::string &assignment : overrides)
      file.add_override(assignment);

    Parameters   parameters;
    Declarations declarations;
    parameters.add_parameters(declarations);
    file.apply(declarations);
    std::ostringstream effective;
    declarations.print_prm(effective);
    try
      {
        Scene scene = parameters.create_scene();
        return {file, parameters, effective.str(), std::move(scene)};
      }
    catch (const InputError &error)
      {
        throw file.with_place(error);
      }
  }
} // namespace crawler
