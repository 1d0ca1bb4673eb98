// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/versions.h>

#include <fmt/format.h>
#include <mpi.h>
#include <petscversion.h>

namespace crawler
{
  std::map<std::string, std::string>
  versions()
  {
    return {{"crawler", CRAWLER_VERSION},
            {"revision", CRAWLER_REVISION},
            {"deal.II", CRAWLER_DEAL_II},
            {"PETSc", fmt::format("{}.{}.{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR)},
            {"MPI", fmt::format("{}.{}", MPI_VERSION, MPI_SUBVERSION)}};
  }

  std::string
  versions_in_words()
  {
    std::string text;
    for (const auto &[name, version] : versions())
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, version);
    return text;
  }
} // namespace crawler
