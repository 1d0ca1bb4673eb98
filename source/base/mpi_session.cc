// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/mpi_session.h>
#include <crawler/base/petsc_object.h>

#include <mpi.h>

namespace crawler
{
  MpiSession::MpiSession(int &argc, char **&argv)
  {
    int is_there = 0;
    MPI_Initialized(&is_there);
    if (is_there == 0)
    {
      int provided = 0;
      MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
      owns_mpi_ = true;
    }
    petsc(PetscInitialize(&argc, &argv, nullptr, nullptr));
    petsc(PetscPopSignalHandler()); // stop_signal.h has its own
  }

  MpiSession::~MpiSession()
  {
    PetscFinalize();
    if (owns_mpi_)
      MPI_Finalize();
  }
} // namespace crawler
