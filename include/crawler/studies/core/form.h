// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/core/parameters.h>

#include <string>

namespace crawler
{
  /// Entries that differ from those of @p base, as the text of a parameter file that includes it.
  std::string
  changes(const Declarations &declarations, const ParameterFile &base);

  /// Parameter file as a form in which other values can be filled in.
  struct Form
  {
    /// @p scene: another file, whose entries override those of @p file except command-line overrides. Throws
    /// InputError.
    explicit Form(const ParameterFile &file, const ParameterFile *scene = nullptr);
    Form(const Form &) = delete;

    /// Returns the parameters with another number; the form is unchanged afterwards. Throws InputError.
    Parameters
    parameters_with(const std::string &path, double value);

    /// Returns all entries as used, as a .prm file.
    std::string
    effective() const;

    Parameters parameters;
    Declarations declarations; ///< entries bound to the members of parameters
  };
} // namespace crawler
