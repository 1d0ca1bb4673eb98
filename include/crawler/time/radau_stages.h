// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/petsc_object.h>
#include <crawler/time/implicit_system.h>
#include <crawler/time/petsc_guard.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>
#include <crawler/time/vec_access.h>

#include <complex>
#include <span>
#include <vector>

namespace crawler
{
  /// Data of the PETSc type (radau.h): the system of the stages, and the last step.
  struct Radau
  {
    const RadauTableau *tableau = &radau_tableau(3);
    ImplicitSystem *system      = nullptr;
    PetscGuard *guard           = nullptr;

    PetscOwner<Vec> start; ///< state at the start of the step
    PetscOwner<Vec> z;     ///< increments of all stages: on each rank its part of stage 1, then that of stage 2, ...
    PetscOwner<Vec> y, y_dot, f; ///< state, rate and residual of one stage
    std::size_t n_owned = 0;

    double h = 0., t = 0.;   ///< of the attempted step
    double error       = 0.; ///< its error in units of the tolerance
    unsigned int steps = 0;  ///< accepted since the last start

    /// The last accepted step, for interpolation and the next first guess.
    struct Last
    {
      std::vector<double> start, z;
      double h = 0., t = 0.;
    };
    Last last;

    /// Newton's method for the stages.
    struct Newton
    {
      PetscOwner<KSP> linear, krylov; ///< if `linear`, the solver's own, is preonly
      unsigned int hard_steps = 0;    ///< steps that are still to be made with `krylov`
      double last_correction = 0., rate = 0., known_rate = 1.;
      bool factors_ok = true, products_ready = false;
      double factors_h = 0.; ///< step size for which the factors were computed
      std::vector<std::complex<double>> complex_work;
    };
    Newton newton;

    std::span<const double>
    stage(const std::span<const double> all, const unsigned int i) const
    {
      return all.subspan(i * n_owned, n_owned);
    }

    /// y and y' of a stage from the increments @p z.
    void
    state_of_stage(const std::span<const double> z, const unsigned int i)
    {
      const ReadAccess start_access(start.get());
      const WriteAccess y_access(y.get()), y_dot_access(y_dot.get());
      const double *zi = z.data() + i * n_owned;
      for (std::size_t k = 0; k < n_owned; ++k)
        y_access.span[k] = start_access.span[k] + zi[k];
      derivative_of_stage(z, i, y_dot_access.span);
    }

    void
    derivative_of_stage(const std::span<const double> z, const unsigned int i, const std::span<double> result) const
    {
      radau::stage_rate(n_stages(), tableau->inverse.data(), static_cast<int>(i), 1. / h, z.data(), n(), result.data());
    }

    // Arguments of the loops.
    int
    n_stages() const
    {
      return static_cast<int>(tableau->n);
    }
    int
    n() const
    {
      return static_cast<int>(n_owned);
    }
  };

  Radau &
  radau_data(TS ts);

  /// Computes the factors at the stage in the middle of the step.
  PetscErrorCode
  radau_factorize(TS ts, std::span<const double> z);

  /// Solves for the stages: by the simplified Newton method unless the user chose otherwise, and where it fails with
  /// exact products, which then stay for some steps. A guess that fails is replaced by rest, which is in the domain of
  /// F.
  PetscErrorCode
  radau_solve_stages(TS ts);

  // Residual and Jacobian of the stages, as TS hands them to SNES.
  PetscErrorCode
  radau_stage_function(SNES snes, Vec Z, Vec R, TS ts);
  PetscErrorCode
  radau_stage_jacobian(SNES snes, Vec Z, Mat A, Mat P, TS ts);

  /// Sets SNES and KSP of the stages, once vectors and matrix exist.
  PetscErrorCode
  radau_set_up_newton(TS ts);
} // namespace crawler
