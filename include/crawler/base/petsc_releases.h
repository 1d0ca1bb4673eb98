// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <petscsnes.h>

/// Names and types that differ between PETSc's releases (doc/upgrading.md).
namespace crawler
{
  /// Newton's method met a residual that is not finite.
#if PETSC_VERSION_LT(3, 25, 0)
  inline constexpr SNESConvergedReason newton_not_finite = SNES_DIVERGED_FNORM_NAN;
#else
  inline constexpr SNESConvergedReason newton_not_finite = SNES_DIVERGED_FUNCTION_NANORINF;
#endif

  /// MatShellSetOperation() takes void (*)() before PETSc 3.24, PetscErrorCodeFn * since.
#if PETSC_VERSION_LT(3, 24, 0)
  using ShellOperation = void (*)();
#else
  using ShellOperation                                   = PetscErrorCodeFn *;
#endif
} // namespace crawler
