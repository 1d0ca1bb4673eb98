// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/core/parameters.h>

#include <string>

namespace crawler
{
  /// The entries that are not as @p base says, as the text of a parameter file that is to include it.
  std::string
  changes(const Declarations &declarations, const ParameterFile &base);

  /// A parameter file as a form in which other values can be filled in.
  struct Form
  {
    /// @p scene: another file whose entries are stronger than those of @p file, but for overrides. Throws InputError.
    explicit Form(const ParameterFile &file, const ParameterFile *scene = nullptr);
    Form(const Form &) = delete;

    /// The parameters with another number; the form is as before. Throws InputError.
    Parameters
    parameters_with(const std::string &path, double value);

    Parameters parameters;
    Declarations declarations; ///< its entries are the members of parameters
  };
} // namespace crawler
