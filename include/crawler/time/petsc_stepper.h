// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/time/implicit_system.h>
#include <crawler/time/stepper.h>
#include <crawler/time/time_parameters.h>

#include <mpi.h>

#include <memory>
#include <string>

namespace crawler
{
  /**
   * Makes a stepper that integrates an implicit system, which must outlive it, with PETSc's TS, Newton's method by
   * SNES, and KSP. An exception that the system throws leaves next().
   *
   * Error control is absolute, by the root mean square of the estimated error of a step over all unknowns, so y should
   * be a displacement from rest. Newton's method stops when its estimated remaining error is below 1% of the tolerance.
   */
  std::unique_ptr<Stepper>
  petsc_stepper(MPI_Comm communicator, ImplicitSystem &system, const TimeParameters &parameters);

  /// The integrator that the option -ts_type behind "--" names, else @p otherwise.
  std::string
  integrator_of_petsc(const std::string &otherwise);
} // namespace crawler
