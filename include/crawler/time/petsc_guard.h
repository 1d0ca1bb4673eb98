// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/petsc_releases.h>

#include <cmath>
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

  /// Begins a convergence test of Newton's method: true if no correction is to be measured, before the first one or
  /// since a norm is not finite.
  inline bool
  ends_without_correction(const PetscInt it,
                          const PetscReal dx_norm,
                          const PetscReal F_norm,
                          SNESConvergedReason &reason)
  {
    reason = !std::isfinite(F_norm) || !std::isfinite(dx_norm) ? newton_not_finite
             : it == 0 && F_norm == 0.                         ? SNES_CONVERGED_FNORM_ABS
                                                               : SNES_CONVERGED_ITERATING;
    return it == 0 || reason != SNES_CONVERGED_ITERATING;
  }

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
