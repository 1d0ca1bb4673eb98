// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/petsc_releases.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_stages.h>
#include <crawler/time/vec_access.h>

#include <petsc/private/tsimpl.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Convergence factor per iteration above which new factors are computed.
    constexpr double slow = 0.1;
    /// Number of steps with the Krylov method after the simplified Newton method failed.
    constexpr unsigned int krylov_steps = 10;
    /// Relative tolerance of the Krylov method: the rate of Newton's method is measured.
    constexpr double krylov_tolerance = 0.01;
    constexpr int krylov_iterations   = 30;

    /// Sets the first guess from the last step if there is one, or from rest; returns false for the latter.
    bool
    first_guess(TS ts)
    {
      Radau &radau = radau_data(ts);
      const WriteAccess z(radau.z.get());
      std::fill(z.span.begin(), z.span.end(), 0.);
      if (ts->steprestart || radau.last.h == 0.)
        return false;
      double weights[radau::max_stages];
      for (int i = 0; i < radau.n_stages(); ++i)
      {
        radau::guess_weights(radau.n_stages(),
                             radau.tableau->c.data(),
                             radau.tableau->inverse.data(),
                             i,
                             /*start=*/1.,
                             radau.h / radau.last.h,
                             weights);
        radau::combine(radau.n_stages(), weights, radau.last.z.data(), radau.n(), &z.span[i * radau.n_owned]);
      }
      return true;
    }

    /// Makes one attempt with the solver's own linear method or with the Krylov method.
    PetscErrorCode
    attempt(TS ts, const bool krylov, bool &ok)
    {
      Radau &radau = radau_data(ts);
      if (krylov)
        PetscCall(SNESSetKSP(ts->snes, radau.newton.krylov.get()));
      PetscCall(SNESSolve(ts->snes, nullptr, radau.z.get()));
      if (krylov)
        PetscCall(SNESSetKSP(ts->snes, radau.newton.linear.get()));
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

    /// Prepares products with the exact Jacobian of all stages, at the present state of Newton's method.
    PetscErrorCode
    setup_products(TS ts)
    {
      Radau &radau = radau_data(ts);
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
      radau.newton.products_ready = true;
      return code;
    }

    PetscErrorCode
    multiply(Mat A, Vec X, Vec Y)
    {
      TS ts               = &context_of<std::remove_pointer_t<TS>>(A);
      Radau &radau        = radau_data(ts);
      PetscErrorCode code = radau.newton.products_ready ? 0 : setup_products(ts);
      const ReadAccess x(X);
      const WriteAccess y(Y), x_dot(radau.y_dot.get());
      for (unsigned int i = 0; code == 0 && i < radau.tableau->n; ++i)
      {
        radau.derivative_of_stage(x.span, i, x_dot.span);
        code = (*radau.guard)([&]() {
          radau.system->stage_vmult(
            i, radau.stage(x.span, i), x_dot.span, y.span.subspan(i * radau.n_owned, radau.n_owned));
        });
      }
      return code;
    }

    PetscErrorCode
    set_up_preconditioner(PC pc)
    {
      const bool ok = radau_data(&context_of<std::remove_pointer_t<TS>>(pc)).newton.factors_ok;
      return PCSetFailedReason(pc, ok ? PC_NOERROR : PC_FACTOR_NUMERIC_ZEROPIVOT);
    }

    /// Preconditions in the basis of the eigenvectors of A^-1, where the stages do not depend on each other.
    PetscErrorCode
    precondition(PC pc, Vec B, Vec X)
    {
      Radau &radau                = radau_data(&context_of<std::remove_pointer_t<TS>>(pc));
      const RadauTableau &tableau = *radau.tableau;
      const std::size_t size      = radau.n_owned;
      const ReadAccess b(B);
      const WriteAccess x(X), real(radau.f.get());
      if (!radau.newton.factors_ok) // PETSc applies it once before it asks why the set-up failed
      {
        std::fill(x.span.begin(), x.span.end(), 0.);
        return 0;
      }
      const int s = radau.n_stages(), n = radau.n();
      auto &pairs = radau.newton.complex_work;
      pairs.resize(tableau.n_pairs() * size);
      radau::to_eigenbasis(s, parts(tableau.rows), b.span.data(), n, real.span.data(), pairs.data());
      const PetscErrorCode code = (*radau.guard)([&]() {
        radau.system->solve_with_jacobian(real.span, real.span);
        for (unsigned int p = 0; p < tableau.n_pairs(); ++p)
        {
          const std::span<std::complex<double>> own(pairs.data() + p * size, size);
          radau.system->solve_with_complex_jacobian(p, own, own);
        }
      });
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n; ++d)
          x.span[i * size + d] =
            radau::from_eigenbasis(s, parts(tableau.vectors), i, d, n, real.span.data(), pairs.data());
      return code;
    }

    /// Root mean square over all stages and ranks, in units of the tolerance.
    double
    scaled_norm(Vec all, const double tolerance)
    {
      const ReadAccess a(all);
      double sum = 0.;
      for (const double value : a.span)
        sum += value * value / (tolerance * tolerance);
      const MPI_Comm communicator = PetscObjectComm(reinterpret_cast<PetscObject>(all));
      int size                    = 1;
      MPI_Comm_size(communicator, &size);
      if (size > 1)
        MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, communicator);
      PetscInt n = 0;
      VecGetSize(all, &n);
      return std::sqrt(sum / static_cast<double>(n));
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
      TS ts                 = static_cast<TS>(context);
      Radau::Newton &newton = radau_data(ts).newton;
      if (it == 0)
        newton.rate = 0.;
      if (ends_without_correction(it, dx_norm, F_norm, *reason))
        return 0;
      Vec correction = nullptr, state = nullptr;
      SNESGetSolutionUpdate(snes, &correction);
      SNESGetSolution(snes, &state);
      const double d = scaled_norm(correction, ts->atol);
      if (it >= 2)
      {
        newton.rate       = d / newton.last_correction;
        newton.known_rate = std::clamp(newton.rate, 1e-6, 0.9);
      }
      else
        newton.known_rate = std::pow(newton.known_rate, 0.8);
      newton.last_correction = d;
      const double left      = newton.known_rate / (1. - std::min(newton.known_rate, 0.9)) * d;
      const double enough    = radau_data(ts).tableau->newton_fraction;
      if (left <= enough || d <= 1e-15 * scaled_norm(state, ts->atol))
        *reason = SNES_CONVERGED_SNORM_RELATIVE;
      else if (it >= 3 && newton.rate >= 1.)
        *reason = SNES_DIVERGED_DTOL;
      return 0;
    }
  } // namespace

  Radau &
  radau_data(TS ts)
  {
    return *static_cast<Radau *>(ts->data);
  }

  PetscErrorCode
  radau_factorize(TS ts, const std::span<const double> z)
  {
    Radau &radau              = radau_data(ts);
    const unsigned int middle = radau.tableau->n / 2;
    radau.state_of_stage(z, middle);
    std::vector<std::complex<double>> sigma = radau.tableau->eigenvalues;
    for (auto &value : sigma)
      value /= radau.h;
    const ReadAccess y(radau.y.get()), y_dot(radau.y_dot.get());
    radau.newton.factors_h = radau.h;
    const double t         = radau.t + radau.tableau->c[middle] * radau.h;
    return (*radau.guard)([&]() {
      radau.newton.factors_ok =
        radau.system->setup_jacobian(t, y.span, y_dot.span, radau.tableau->real_eigenvalue / radau.h) &&
        radau.system->setup_complex_jacobians(t, y.span, y_dot.span, sigma);
    });
  }

  PetscErrorCode
  radau_solve_stages(TS ts)
  {
    Radau &radau            = radau_data(ts);
    const bool extrapolated = first_guess(ts);
    bool ok                 = false;
    bool krylov             = radau.newton.linear && radau.newton.hard_steps > 0;
    if (krylov)
      --radau.newton.hard_steps;
    PetscCall(attempt(ts, krylov, ok));
    if (!ok && extrapolated)
    {
      VecSet(radau.z.get(), 0.);
      PetscCall(attempt(ts, krylov, ok));
    }
    if (!ok && radau.newton.linear && !krylov)
    {
      radau.newton.hard_steps = krylov_steps;
      VecSet(radau.z.get(), 0.);
      PetscCall(attempt(ts, true, ok));
    }
    return 0;
  }

  PetscErrorCode
  radau_stage_function(SNES, Vec Z, Vec R, TS ts)
  {
    Radau &radau = radau_data(ts);
    const ReadAccess z(Z);
    const WriteAccess r(R);
    for (unsigned int i = 0; i < radau.tableau->n; ++i)
    {
      radau.state_of_stage(z.span, i);
      PetscCall(TSComputeIFunction(
        ts, radau.t + radau.tableau->c[i] * radau.h, radau.y.get(), radau.y_dot.get(), radau.f.get(), PETSC_FALSE));
      const ReadAccess f(radau.f.get());
      std::copy(f.span.begin(), f.span.end(), r.span.begin() + i * radau.n_owned);
    }
    return 0;
  }

  PetscErrorCode
  radau_stage_jacobian(SNES snes, Vec Z, Mat A, Mat, TS ts)
  {
    Radau &radau       = radau_data(ts);
    PetscInt iteration = 0;
    SNESGetIterationNumber(snes, &iteration);
    const ReadAccess z(Z);
    const bool is_renewed = iteration == 0 || radau.newton.rate > slow;
    if (is_renewed || radau.newton.linear) // exact where the simplified Newton method failed
      radau.newton.products_ready = false;
    if (is_renewed)
      PetscCall(radau_factorize(ts, z.span));
    MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY); // tells PETSc that the matrix has changed
    return MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY);
  }

  PetscErrorCode
  radau_set_up_newton(TS ts)
  {
    Radau &radau        = radau_data(ts);
    const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(ts));
    const auto n        = static_cast<PetscInt>(radau.tableau->n * radau.n_owned);
    SNES snes           = nullptr;
    KSP ksp             = nullptr;
    PC pc               = nullptr;
    PetscCall(TSGetSNES(ts, &snes));
    // The solver keeps its function's vector and its matrix.
    Vec residual = nullptr;
    PetscCall(VecDuplicate(radau.z.get(), &residual));
    PetscCall(SNESSetFunction(snes, residual, SNESTSFormFunction, ts));
    PetscCall(VecDestroy(&residual));
    Mat jacobian = nullptr;
    PetscCall(MatCreateShell(comm, n, n, PETSC_DECIDE, PETSC_DECIDE, ts, &jacobian));
    PetscCall(MatShellSetOperation(jacobian, MATOP_MULT, reinterpret_cast<ShellOperation>(multiply)));
    PetscCall(SNESSetJacobian(snes, jacobian, jacobian, SNESTSFormJacobian, ts));
    PetscCall(MatDestroy(&jacobian));
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
      radau.newton.linear.reset(ksp);
      PetscCall(KSPCreate(comm, &ksp));
      radau.newton.krylov.reset(ksp);
      PetscCall(KSPSetType(ksp, KSPGMRES));
      PetscCall(KSPSetPC(ksp, pc));
      PetscCall(KSPSetPCSide(ksp, PC_RIGHT));
    }
    PetscCall(KSPSetTolerances(
      ksp, krylov_tolerance, PETSC_DEFAULT, PETSC_DEFAULT, is_preonly ? krylov_iterations : PETSC_DEFAULT));
    if (!is_preonly)
      PetscCall(KSPSetFromOptions(ksp));
    return 0;
  }
} // namespace crawler
