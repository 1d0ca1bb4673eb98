// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Parts that need libraries which the core for one process does not have: PETSc (adaptive meshes, BDF, couplings of
// distant cells), deal.II's triangulation, HDF5's files, shared objects. Each is refused in a sentence when a scene
// asks for it; all else is the program's own code. CRAWLER_LEFT_OUT ends the sentences.
#include <crawler/base/exceptions.h>
#include <crawler/mesh/triangulation.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/library.h>
#include <crawler/time/petsc_stepper.h>

namespace crawler
{
  namespace
  {
    [[noreturn]] void
    refuse(const std::string &what, const std::string &entry = "")
    {
      throw InputError(what + ", " CRAWLER_LEFT_OUT, entry);
    }
  }

  std::unique_ptr<Stepper>
  petsc_stepper(MPI_Comm, ImplicitSystem &, const TimeParameters &)
  {
    refuse("this run needs PETSc's time integration (a step that the fused engine does not take, as before an "
           "inversion, an adaptive mesh or a coupling of distant places)");
  }

  std::string
  integrator_of_petsc(const std::string &otherwise)
  {
    return otherwise;
  }

  std::unique_ptr<Triangulation>
  create_triangulation(MPI_Comm, const std::vector<double> &)
  {
    refuse("this needs deal.II, as adaptive meshes do");
  }

  std::unique_ptr<ActiveStress>
  load_library(const LibraryParameters &, const Body &, double)
  {
    refuse("\"Active stress/Library\" is a shared object", "Active stress/Library/File");
  }
} // namespace crawler
