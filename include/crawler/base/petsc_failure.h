// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace crawler
{
  /// Thrown when a function of PETSc fails.
  class PetscFailure : public std::runtime_error
  {
  public:
    PetscFailure(const int code, const std::string &words, const bool is_out_of_memory)
      : std::runtime_error("PETSc error " + std::to_string(code) + ": " + words)
      , is_out_of_memory(is_out_of_memory)
    {
    }

    const bool is_out_of_memory;
  };
} // namespace crawler
