// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/time/implicit_system.h>
#include <crawler/time/stepper.h>
#include <crawler/time/time_parameters.h>

#include <mpi.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /**
   * Integrates an implicit system with PETSc's TS, Newton's method by SNES, and KSP. An exception that the system
   * throws leaves next().
   *
   * Error control is absolute, by the root mean square of the estimated error of a step over all unknowns, so y should
   * be a displacement from rest. Newton's method stops when its estimated remaining error is below 1% of the tolerance.
   */
  class PetscStepper : public Stepper
  {
  public:
    /// Makes a stepper; @p system must outlive it.
    PetscStepper(MPI_Comm communicator, ImplicitSystem &system, const TimeParameters &parameters);
    ~PetscStepper() override;
    PetscStepper(const PetscStepper &) = delete;

    void
    begin(ConstVector y, const Course &course) override;
    const Step *
    next() override;
    ConstVector
    state() const override;
    TimeOutcome
    outcome() override;
    void
    interpolate(double time, Vector y) override;
    /// Exchanges the state; only the radau methods can.
    bool
    exchange(Archive &archive) override;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };

  /// The integrator that the option -ts_type behind "--" names, else @p otherwise.
  std::string
  integrator_of_petsc(const std::string &otherwise);
} // namespace crawler
