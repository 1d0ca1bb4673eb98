// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/petsc_object.h>
#include <crawler/base/petsc_releases.h>
#include <crawler/time/radau.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>
#include <crawler/time/vec_access.h>

#include <petsc/private/tsimpl.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace crawler
{
  namespace
  {
    /// Convergence factor per iteration above which new factors are computed.
    constexpr double slow = 0.1;
    /// Number of steps with the Krylov method after the simplified Newton method failed.
    constexpr unsigned int krylov_steps = 10;
    /// Relative tolerance of the Krylov method in these steps.
    constexpr double krylov_tolerance = 0.01;
    constexpr int krylov_iterations   = 30;
    /// Error of a step that cannot be estimated, relative to the tolerance.
    constexpr double hopeless_error = 1e6;

    struct Radau
    {
      const RadauTableau *tableau = &radau_tableau(3);
      ImplicitSystem *system      = nullptr;
      PetscGuard *guard           = nullptr;

      // Vectors of the size of y, and of all stages: on each rank its part of stage 1, then that of stage 2, ...
      PetscOwner<Vec> y, y_dot, f, start;
      PetscOwner<Vec> z, residual;
      PetscOwner<Mat> jacobian;
      PetscOwner<KSP> linear, krylov; ///< if `linear`, the solver's own, is preonly
      unsigned int hard_steps = 0;
      std::size_t n_owned     = 0;
      double n_all            = 0.; ///< unknowns of all ranks
      std::vector<double> work, x_dot;
      std::vector<std::complex<double>> complex_work;

      double h = 0., t = 0.;   ///< of the attempted step
      double error       = 0.; ///< its error in units of the tolerance
      unsigned int steps = 0;  ///< accepted since the last start
      // The last accepted step, for interpolation and the next first guess.
      std::vector<double> old_start, old_z;
      double old_h = 0., old_t = 0.;

      // Newton's method.
      double last_correction = 0., rate = 0., known_rate = 1.;
      bool factors_ok = true, products_ready = false;
      double factors_h = 0.;

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
        radau::stage_rate(
          n_stages(), tableau->inverse.data(), static_cast<int>(i), 1. / h, z.data(), n(), result.data());
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
    data(TS ts)
    {
      return *static_cast<Radau *>(ts->data);
    }

    /// Sets the first guess from the last step if there is one, or from rest; returns false for the latter.
    bool
    first_guess(TS ts)
    {
      Radau &radau = data(ts);
      const WriteAccess z(radau.z.get());
      std::fill(z.span.begin(), z.span.end(), 0.);
      if (ts->steprestart || radau.old_h == 0.)
        return false;
      double weights[radau::max_stages];
      for (int i = 0; i < radau.n_stages(); ++i)
      {
        radau::guess_weights(radau.n_stages(),
                             radau.tableau->c.data(),
                             radau.tableau->inverse.data(),
                             i,
                             /*start=*/1.,
                             radau.h / radau.old_h,
                             weights);
        radau::combine(radau.n_stages(), weights, radau.old_z.data(), radau.n(), &z.span[i * radau.n_owned]);
      }
      return true;
    }

    /// Makes one attempt with the solver's own linear method or with the Krylov method.
    PetscErrorCode
    attempt(TS ts, const bool krylov, bool &ok)
    {
      Radau &radau = data(ts);
      if (krylov)
        PetscCall(SNESSetKSP(ts->snes, radau.krylov.get()));
      PetscCall(SNESSolve(ts->snes, nullptr, radau.z.get()));
      if (krylov)
        PetscCall(SNESSetKSP(ts->snes, radau.linear.get()));
      PetscInt newton = 0, linear = 0;
      SNESConvergedReason reason;
      SNESGetIterationNumber(ts->snes, &newton);
      SNESGetLinearSolveIterations(ts->snes, &linear);
      SNESGetConvergedReason(ts->snes, &reason);
      ts->snes_its += newton;
      ts->ksp_its += linear;
      ok = reason >= 0;
      return 0;
    }

    /**
     * Solves for the stages: by the simplified Newton method unless the user chose otherwise, and where it fails with
     * exact products, which then stay for some steps. A guess that fails is replaced by rest, which is in the domain of
     * F.
     */
    PetscErrorCode
    solve_stages(TS ts)
    {
      Radau &radau            = data(ts);
      const bool extrapolated = first_guess(ts);
      bool ok                 = false;
      bool krylov             = radau.linear && radau.hard_steps > 0;
      if (krylov)
        --radau.hard_steps;
      PetscCall(attempt(ts, krylov, ok));
      if (!ok && extrapolated)
      {
        VecSet(radau.z.get(), 0.);
        PetscCall(attempt(ts, krylov, ok));
      }
      if (!ok && radau.linear && !krylov)
      {
        radau.hard_steps = krylov_steps;
        VecSet(radau.z.get(), 0.);
        PetscCall(attempt(ts, true, ok));
      }
      return 0;
    }

    PetscErrorCode
    stage_function(SNES, Vec Z, Vec R, TS ts)
    {
      Radau &radau = data(ts);
      const ReadAccess z(Z);
      const WriteAccess r(R);
      for (unsigned int i = 0; i < radau.tableau->n; ++i)
      {
        radau.state_of_stage(z.span, i);
        PetscErrorCode code = TSComputeIFunction(
          ts, radau.t + radau.tableau->c[i] * radau.h, radau.y.get(), radau.y_dot.get(), radau.f.get(), PETSC_FALSE);
        if (code != 0)
          return code;
        const ReadAccess f(radau.f.get());
        std::copy(f.span.begin(), f.span.end(), r.span.begin() + i * radau.n_owned);
      }
      return 0;
    }

    /// Computes the factors at the stage in the middle of the step.
    PetscErrorCode
    factorize(TS ts, const std::span<const double> z)
    {
      Radau &radau              = data(ts);
      const unsigned int middle = radau.tableau->n / 2;
      radau.state_of_stage(z, middle);
      std::vector<std::complex<double>> sigma = radau.tableau->eigenvalues;
      for (auto &value : sigma)
        value /= radau.h;
      const ReadAccess y(radau.y.get()), y_dot(radau.y_dot.get());
      radau.factors_h = radau.h;
      const double t  = radau.t + radau.tableau->c[middle] * radau.h;
      return (*radau.guard)([&]() {
        radau.factors_ok =
          radau.system->setup_jacobian(t, y.span, y_dot.span, radau.tableau->real_eigenvalue / radau.h) &&
          radau.system->setup_complex_jacobians(t, y.span, y_dot.span, sigma);
      });
    }

    /// Prepares products with the exact Jacobian of all stages, at the present state of Newton's method.
    PetscErrorCode
    setup_products(TS ts)
    {
      Radau &radau = data(ts);
      Vec Z        = nullptr;
      SNESGetSolution(ts->snes, &Z);
      const ReadAccess z(Z);
      PetscErrorCode code = 0;
      for (unsigned int i = 0; code == 0 && i < radau.tableau->n; ++i)
      {
        radau.state_of_stage(z.span, i);
        const ReadAccess y(radau.y.get()), y_dot(radau.y_dot.get());
        const double t = radau.t + radau.tableau->c[i] * radau.h;
        code           = (*radau.guard)([&]() { radau.system->setup_stage(i, t, y.span, y_dot.span); });
      }
      radau.products_ready = true;
      return code;
    }

    PetscErrorCode
    stage_jacobian(SNES snes, Vec Z, Mat A, Mat, TS ts)
    {
      Radau &radau       = data(ts);
      PetscInt iteration = 0;
      SNESGetIterationNumber(snes, &iteration);
      const ReadAccess z(Z);
      PetscErrorCode code = 0;
      if (iteration == 0 || radau.rate > slow)
        code = factorize(ts, z.span);
      radau.products_ready = false;
      if (code != 0)
        return code;
      MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY); // tells PETSc that the matrix has changed
      return MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY);
    }

    PetscErrorCode
    multiply(Mat A, Vec X, Vec Y)
    {
      void *context = nullptr;
      MatShellGetContext(A, &context);
      TS ts               = static_cast<TS>(context);
      Radau &radau        = data(ts);
      PetscErrorCode code = radau.products_ready ? 0 : setup_products(ts);
      const ReadAccess x(X);
      const WriteAccess y(Y);
      radau.x_dot.resize(radau.n_owned);
      for (unsigned int i = 0; code == 0 && i < radau.tableau->n; ++i)
      {
        radau.derivative_of_stage(x.span, i, radau.x_dot);
        code = (*radau.guard)([&]() {
          radau.system->stage_vmult(
            i, radau.stage(x.span, i), radau.x_dot, y.span.subspan(i * radau.n_owned, radau.n_owned));
        });
      }
      return code;
    }

    PetscErrorCode
    set_up_preconditioner(PC pc)
    {
      void *context = nullptr;
      PCShellGetContext(pc, &context);
      return PCSetFailedReason(pc,
                               data(static_cast<TS>(context)).factors_ok ? PC_NOERROR : PC_FACTOR_NUMERIC_ZEROPIVOT);
    }

    /// Preconditions in the basis of the eigenvectors of A^-1, where the stages do not depend on each other.
    PetscErrorCode
    precondition(PC pc, Vec B, Vec X)
    {
      void *context = nullptr;
      PCShellGetContext(pc, &context);
      Radau &radau                = data(static_cast<TS>(context));
      const RadauTableau &tableau = *radau.tableau;
      const std::size_t size      = radau.n_owned;
      const ReadAccess b(B);
      const WriteAccess x(X);
      if (!radau.factors_ok) // PETSc applies it once before it asks why the set-up failed
      {
        std::fill(x.span.begin(), x.span.end(), 0.);
        return 0;
      }
      const int s = radau.n_stages(), n = radau.n();
      radau.work.resize(size);
      radau.complex_work.resize(tableau.n_pairs() * size);
      radau::to_eigenbasis(s, parts(tableau.rows), b.span.data(), n, radau.work.data(), radau.complex_work.data());
      const PetscErrorCode code = (*radau.guard)([&]() {
        radau.system->solve_with_jacobian(radau.work, radau.work);
        for (unsigned int p = 0; p < tableau.n_pairs(); ++p)
        {
          const std::span<std::complex<double>> own(radau.complex_work.data() + p * size, size);
          radau.system->solve_with_complex_jacobian(p, own, own);
        }
      });
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n; ++d)
          x.span[i * size + d] =
            radau::from_eigenbasis(s, parts(tableau.vectors), i, d, n, radau.work.data(), radau.complex_work.data());
      return code;
    }

    /// Root mean square over all stages and ranks, in units of the tolerance.
    double
    scaled_norm(TS ts, Vec all, const double tolerance)
    {
      const Radau &radau = data(ts);
      const ReadAccess a(all);
      double sum = 0.;
      for (const double value : a.span)
        sum += value * value / (tolerance * tolerance);
      const MPI_Comm communicator = PetscObjectComm(reinterpret_cast<PetscObject>(all));
      int size                    = 1;
      MPI_Comm_size(communicator, &size);
      if (size > 1)
        MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, communicator);
      return std::sqrt(sum / (radau.n_all * radau.tableau->n));
    }

    /// Convergence test: the iteration converges linearly; with the rate so far the remaining error is rate/(1-rate)
    /// corrections.
    PetscErrorCode
    newton_converged(SNES snes,
                     const PetscInt it,
                     const PetscReal,
                     const PetscReal dx_norm,
                     const PetscReal F_norm,
                     SNESConvergedReason *reason,
                     void *context)
    {
      TS ts        = static_cast<TS>(context);
      Radau &radau = data(ts);
      *reason      = SNES_CONVERGED_ITERATING;
      if (!std::isfinite(F_norm) || !std::isfinite(dx_norm))
      {
        *reason = newton_not_finite;
        return 0;
      }
      if (it == 0)
      {
        radau.rate = 0.;
        if (F_norm == 0.)
          *reason = SNES_CONVERGED_FNORM_ABS;
        return 0;
      }
      Vec correction = nullptr, state = nullptr;
      SNESGetSolutionUpdate(snes, &correction);
      SNESGetSolution(snes, &state);
      const double d = scaled_norm(ts, correction, ts->atol);
      if (it >= 2)
      {
        radau.rate       = d / radau.last_correction;
        radau.known_rate = std::clamp(radau.rate, 1e-6, 0.9);
      }
      else
        radau.known_rate = std::pow(radau.known_rate, 0.8);
      radau.last_correction = d;
      const double left     = radau.known_rate / (1. - std::min(radau.known_rate, 0.9)) * d;
      const double enough   = radau.tableau->newton_fraction;
      if (left <= enough || d <= 1e-15 * scaled_norm(ts, state, ts->atol))
        *reason = SNES_CONVERGED_SNORM_RELATIVE;
      else if (it >= 3 && radau.rate >= 1.)
        *reason = SNES_DIVERGED_DTOL;
      return 0;
    }

    /// Estimates the error by the embedded formula, (K + sigma M)^-1 ( -F(t, y, -sigma e.z) ). If it is large and the
    /// filter has to damp disturbed stiff components, the filter is applied again; then the step must not grow.
    PetscErrorCode
    estimate_error(TS ts)
    {
      Radau &radau        = data(ts);
      const bool settling = radau.steps < radau::settling_steps;
      PetscErrorCode code = 0;
      if (!radau.factors_ok)
      {
        radau.error = hopeless_error;
        return 0;
      }
      {
        const ReadAccess z(radau.z.get());
        const WriteAccess y_dot(radau.y_dot.get());
        radau::error_rate(radau.n_stages(),
                          radau.tableau->error_weights.data(),
                          radau.tableau->real_eigenvalue,
                          1. / radau.h,
                          z.span.data(),
                          radau.n(),
                          y_dot.span.data());
      }
      VecCopy(radau.start.get(), radau.y.get());
      for (int round = 0; round < (settling ? 2 : 1); ++round)
      {
        code = TSComputeIFunction(ts, radau.t, radau.y.get(), radau.y_dot.get(), radau.f.get(), PETSC_FALSE);
        if (code != 0)
          return code;
        {
          const WriteAccess f(radau.f.get());
          for (double &value : f.span)
            value = -value;
          code = (*radau.guard)([&]() { radau.system->solve_with_jacobian(f.span, f.span); });
        }
        if (code != 0)
          return code;
        VecWAXPY(radau.y.get(), 1., radau.start.get(), radau.f.get());
        PetscReal absolute = 0., relative = 0.;
        TSErrorWeightedNorm(
          ts, radau.start.get(), radau.y.get(), ts->adapt->wnormtype, &radau.error, &absolute, &relative);
        if (!std::isfinite(radau.error)) // the filter made the stretch negative
        {
          radau.error = hopeless_error;
          break;
        }
        if (radau.error >= 1.)
          continue;
        if (round > 0)
          radau.error = std::max(radau.error, radau::error_without_growth(radau.n_stages()));
        break;
      }
      return 0;
    }

    PetscErrorCode
    step(TS ts)
    {
      Radau &radau     = data(ts);
      PetscInt rejects = 0;
      VecCopy(ts->vec_sol, radau.start.get());
      if (ts->steprestart)
        radau.steps = 0;
      while (ts->reason == TS_CONVERGED_ITERATING)
      {
        radau.h             = ts->time_step;
        radau.t             = ts->ptime;
        PetscErrorCode code = solve_stages(ts);
        if (code != 0)
          return code;
        PetscBool accept = PETSC_TRUE;
        code             = TSAdaptCheckStage(ts->adapt, ts, radau.t + radau.h, ts->vec_sol, &accept);
        if (code != 0)
          return code;
        if (accept)
        {
          if (radau.factors_h != radau.h) // no system had to be solved
          {
            const ReadAccess z(radau.z.get());
            code = factorize(ts, z.span);
          }
          code = code == 0 ? estimate_error(ts) : code;
          if (code != 0)
            return code;
          {
            const ReadAccess z(radau.z.get()), start(radau.start.get());
            const WriteAccess solution(ts->vec_sol);
            const auto last = radau.stage(z.span, radau.tableau->n - 1);
            for (std::size_t k = 0; k < radau.n_owned; ++k)
              solution.span[k] = start.span[k] + last[k];
          }
          PetscReal next = ts->time_step;
          TSAdaptCandidatesClear(ts->adapt);
          TSAdaptCandidateAdd(ts->adapt,
                              nullptr,
                              static_cast<PetscInt>(2 * radau.tableau->n - 1),
                              static_cast<PetscInt>(radau.tableau->n),
                              1.,
                              1.,
                              PETSC_TRUE);
          code = TSAdaptChoose(ts->adapt, ts, ts->time_step, nullptr, &next, &accept);
          if (code != 0)
            return code;
          if (accept)
          {
            const ReadAccess z(radau.z.get()), start(radau.start.get());
            radau.old_z.assign(z.span.begin(), z.span.end());
            radau.old_start.assign(start.span.begin(), start.span.end());
            radau.old_h = radau.h;
            radau.old_t = radau.t;
            ++radau.steps;
            ts->ptime += ts->time_step;
            ts->time_step = next;
            return 0;
          }
          VecCopy(radau.start.get(), ts->vec_sol);
          ts->time_step = next;
        }
        ++ts->reject;
        if (ts->reason == TS_CONVERGED_ITERATING && ++rejects > ts->max_reject && ts->max_reject >= 0)
          ts->reason = TS_DIVERGED_STEP_REJECTED;
      }
      return 0;
    }

    PetscErrorCode
    weighted_error(TS ts, NormType, PetscInt *order, PetscReal *error)
    {
      *order = static_cast<PetscInt>(data(ts).tableau->n + 1); // the step size scales as error^(1/order)
      *error = data(ts).error;
      return 0;
    }

    PetscErrorCode
    interpolate(TS ts, const PetscReal t, Vec X)
    {
      Radau &radau = data(ts);
      const WriteAccess x(X);
      double weights[radau::max_stages];
      radau::collocation_weights(radau.n_stages(), radau.tableau->c.data(), (t - radau.old_t) / radau.old_h, weights);
      radau::combine(radau.n_stages(), weights, radau.old_z.data(), radau.n(), x.span.data());
      for (std::size_t k = 0; k < radau.n_owned; ++k)
        x.span[k] += radau.old_start[k];
      return 0;
    }

    PetscErrorCode
    roll_back(TS ts)
    {
      return VecCopy(data(ts).start.get(), ts->vec_sol);
    }

    PetscErrorCode
    set_up(TS ts)
    {
      Radau &radau        = data(ts);
      const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(ts));
      Vec vec             = nullptr;
      for (PetscOwner<Vec> *owner : {&radau.y, &radau.y_dot, &radau.f, &radau.start})
      {
        PetscCall(VecDuplicate(ts->vec_sol, &vec));
        owner->reset(vec);
      }
      PetscInt local = 0, global = 0;
      PetscCall(VecGetLocalSize(ts->vec_sol, &local));
      PetscCall(VecGetSize(ts->vec_sol, &global));
      radau.n_owned = static_cast<std::size_t>(local);
      radau.n_all   = static_cast<double>(global);
      const auto n  = static_cast<PetscInt>(radau.tableau->n);
      PetscCall(VecCreate(comm, &vec));
      radau.z.reset(vec);
      PetscCall(VecSetSizes(vec, n * local, PETSC_DECIDE));
      PetscCall(VecSetType(vec, VECSTANDARD));
      PetscCall(VecDuplicate(radau.z.get(), &vec));
      radau.residual.reset(vec);
      Mat mat = nullptr;
      PetscCall(MatCreateShell(comm, n * local, n * local, PETSC_DECIDE, PETSC_DECIDE, ts, &mat));
      radau.jacobian.reset(mat);
      PetscCall(MatShellSetOperation(mat, MATOP_MULT, reinterpret_cast<ShellOperation>(multiply)));

      SNES snes = nullptr;
      KSP ksp   = nullptr;
      PC pc     = nullptr;
      PetscCall(TSGetSNES(ts, &snes));
      PetscCall(SNESSetFunction(snes, radau.residual.get(), SNESTSFormFunction, ts));
      PetscCall(SNESSetJacobian(snes, mat, mat, SNESTSFormJacobian, ts));
      PetscCall(SNESSetConvergenceTest(snes, newton_converged, ts, nullptr));
      PetscCall(SNESGetKSP(snes, &ksp));
      PetscCall(KSPGetPC(ksp, &pc));
      PetscCall(PCSetType(pc, PCSHELL));
      PetscCall(PCShellSetContext(pc, ts));
      PetscCall(PCShellSetName(pc, "block-tridiagonal eliminations of the stages"));
      PetscCall(PCShellSetSetUp(pc, set_up_preconditioner));
      PetscCall(PCShellSetApply(pc, precondition));
      PetscBool is_preonly = PETSC_FALSE;
      PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &is_preonly));
      if (is_preonly)
      {
        PetscCall(PetscObjectReference(reinterpret_cast<PetscObject>(ksp)));
        radau.linear.reset(ksp);
        PetscCall(KSPCreate(comm, &ksp));
        radau.krylov.reset(ksp);
        PetscCall(KSPSetType(ksp, KSPGMRES));
        PetscCall(KSPSetPC(ksp, pc));
        PetscCall(KSPSetPCSide(ksp, PC_RIGHT));
        PetscCall(KSPSetTolerances(ksp, krylov_tolerance, PETSC_DEFAULT, PETSC_DEFAULT, krylov_iterations));
      }
      return 0;
    }

    /// @tparam Items PetscOptionItems since PETSc 3.23, a pointer to it before.
    template <typename Items>
    PetscErrorCode
    set_from_options(TS ts, Items)
    {
      auto n           = static_cast<PetscInt>(data(ts).tableau->n);
      PetscBool found  = PETSC_FALSE;
      const char *name = nullptr;
      TSGetOptionsPrefix(ts, &name);
      PetscOptionsGetInt(nullptr, name, "-ts_radau_stages", &n, &found);
      if (found && n != 3 && n != 5)
        SETERRQ(
          PetscObjectComm(reinterpret_cast<PetscObject>(ts)), PETSC_ERR_ARG_OUTOFRANGE, "-ts_radau_stages is 3 or 5");
      if (found)
        data(ts).tableau = &radau_tableau(static_cast<unsigned int>(n));
      return 0;
    }

    PetscErrorCode
    reset(TS ts)
    {
      Radau &radau = data(ts);
      for (PetscOwner<Vec> *owner : {&radau.y, &radau.y_dot, &radau.f, &radau.start, &radau.z, &radau.residual})
        owner->reset();
      radau.jacobian.reset();
      radau.linear.reset();
      radau.krylov.reset();
      return 0;
    }

    PetscErrorCode
    destroy(TS ts)
    {
      delete static_cast<Radau *>(ts->data);
      ts->data = nullptr;
      return 0;
    }

    PetscErrorCode
    view(TS ts, PetscViewer viewer)
    {
      return PetscViewerASCIIPrintf(viewer, "  Radau IIA with %u stages\n", data(ts).tableau->n);
    }

    PetscErrorCode
    create(TS ts)
    {
      ts->data                = new Radau;
      ts->ops->setup          = set_up;
      ts->ops->step           = step;
      ts->ops->interpolate    = interpolate;
      ts->ops->evaluatewlte   = weighted_error;
      ts->ops->rollback       = roll_back;
      ts->ops->snesfunction   = stage_function;
      ts->ops->snesjacobian   = stage_jacobian;
      ts->ops->setfromoptions = set_from_options;
      ts->ops->reset          = reset;
      ts->ops->destroy        = destroy;
      ts->ops->view           = view;
      ts->default_adapt_type  = TSADAPTBASIC;
      ts->usessnes            = PETSC_TRUE;
      ts->stifflyaccurate     = PETSC_TRUE;
      return 0;
    }
  } // namespace

  PetscErrorCode
  register_radau()
  {
    return TSRegister(radau_type, create);
  }

  PetscErrorCode
  radau_set_system(TS ts, ImplicitSystem *system, PetscGuard *guard)
  {
    data(ts).system = system;
    data(ts).guard  = guard;
    return 0;
  }

  PetscErrorCode
  radau_set_stages(TS ts, const unsigned int n_stages)
  {
    data(ts).tableau = &radau_tableau(n_stages);
    return 0;
  }

  PetscErrorCode
  radau_get_stages(TS ts, unsigned int *n_stages)
  {
    *n_stages = data(ts).tableau->n;
    return 0;
  }

  void
  radau_exchange(TS ts, Archive &archive)
  {
    Radau &radau = data(ts);
    archive(radau.hard_steps, radau.steps, radau.old_start, radau.old_z, radau.old_h, radau.old_t);
    archive(radau.known_rate, ts->time_step, ts->steps, ts->reject, ts->snes_its, ts->ksp_its);
    PetscInt n = 0;
    VecGetLocalSize(ts->vec_sol, &n);
    const auto size     = static_cast<std::size_t>(n);
    const bool has_step = radau.old_start.size() == size && radau.old_z.size() == radau.n_stages() * size;
    archive.require(has_step || (radau.old_start.empty() && radau.old_z.empty() && radau.old_h == 0.), "the last step");
    if (!archive.reads())
      return;
    radau.factors_h = 0.;
    ts->steprestart = PETSC_FALSE;
  }
} // namespace crawler
