// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// MPI and PETSc during its lifetime. PETSc sees the arguments. Throws PetscFailure if it refuses one.
  class MpiSession
  {
  public:
    MpiSession(int &argc, char **&argv);
    ~MpiSession();
    MpiSession(const MpiSession &) = delete;
    MpiSession &
    operator=(const MpiSession &) = delete;

  private:
    bool owns_mpi_ = false;
  };
} // namespace crawler
