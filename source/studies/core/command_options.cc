// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/log.h>

#include <petscsys.h>

#include <cctype>
#include <sstream>

namespace crawler
{
  void
  announce_petsc_options(const CommandOptions &options, Log &log)
  {
    if (!options.petsc_options.empty())
      log.line("PETSc options (override the settings): " + options.petsc_options);
  }

  void
  warn_of_unused_petsc_options(MPI_Comm communicator, const CommandOptions &options, Log &log)
  {
    std::istringstream words(options.petsc_options);
    for (std::string word; words >> word;)
    {
      if (word.size() < 2 || word[0] != '-' || std::isalpha(static_cast<unsigned char>(word[1])) == 0)
        continue; // value of an option
      PetscBool is_used = PETSC_FALSE;
      PetscOptionsUsed(nullptr, word.c_str() + 1, &is_used);
      if (!is_true_anywhere(is_used == PETSC_TRUE, communicator))
        log.warn("warning: nothing used the PETSc option " + word);
    }
  }
} // namespace crawler
