// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <petscpc.h>

#include <exception>
#include <utility>

namespace crawler
{
  /// Runs callbacks of PETSc and keeps their exceptions for later, since these must not pass through PETSc.
  class PetscGuard
  {
  public:
    template <typename Callback>
    PetscErrorCode
    operator()(const Callback &callback)
    {
      try
      {
        callback();
        return 0;
      }
      catch (...)
      {
        exception_ = std::current_exception();
        return PETSC_ERR_USER;
      }
    }

    void
    rethrow()
    {
      if (const std::exception_ptr kept = std::exchange(exception_, nullptr))
        std::rethrow_exception(kept);
    }

  private:
    std::exception_ptr exception_;
  };

  /// The context of a shell matrix, or of a shell preconditioner.
  template <typename Context>
  Context &
  context_of(Mat matrix)
  {
    void *context = nullptr;
    MatShellGetContext(matrix, &context);
    return *static_cast<Context *>(context);
  }
  template <typename Context>
  Context &
  context_of(PC preconditioner)
  {
    void *context = nullptr;
    PCShellGetContext(preconditioner, &context);
    return *static_cast<Context *>(context);
  }
} // namespace crawler
