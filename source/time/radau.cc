// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/time/radau.h>
#include <crawler/time/radau_stages.h>

#include <petsc/private/tsimpl.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace crawler
{
  namespace
  {
    /// Error of a step that cannot be estimated, relative to the tolerance.
    constexpr double hopeless_error = 1e6;

    /// Estimates the error by the embedded formula, (K + sigma M)^-1 ( -F(t, y, -sigma e.z) ). If it is large and the
    /// filter has to damp disturbed stiff components, the filter is applied again; then the step must not grow.
    PetscErrorCode
    estimate_error(TS ts)
    {
      Radau &radau        = radau_data(ts);
      const bool settling = radau.steps < radau::settling_steps;
      if (!radau.newton.factors_ok)
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
        PetscCall(TSComputeIFunction(ts, radau.t, radau.y.get(), radau.y_dot.get(), radau.f.get(), PETSC_FALSE));
        {
          const WriteAccess f(radau.f.get());
          for (double &value : f.span)
            value = -value;
          PetscCall((*radau.guard)([&]() { radau.system->solve_with_jacobian(f.span, f.span); }));
        }
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

    /// Sets the solution from the stages and asks PETSc's step control whether the step is @p accept -ed, and for the
    /// size of the next one.
    PetscErrorCode
    judge(TS ts, PetscBool &accept)
    {
      Radau &radau = radau_data(ts);
      const ReadAccess z(radau.z.get()), start(radau.start.get());
      if (radau.newton.factors_h != radau.h) // no system had to be solved
        PetscCall(radau_factorize(ts, z.span));
      PetscCall(estimate_error(ts));
      {
        const WriteAccess solution(ts->vec_sol);
        const auto last = radau.stage(z.span, radau.tableau->n - 1);
        for (std::size_t k = 0; k < radau.n_owned; ++k)
          solution.span[k] = start.span[k] + last[k];
      }
      PetscReal next   = ts->time_step;
      const auto order = static_cast<PetscInt>(radau.tableau->n);
      TSAdaptCandidatesClear(ts->adapt);
      TSAdaptCandidateAdd(ts->adapt, nullptr, 2 * order - 1, order, 1., 1., PETSC_TRUE);
      PetscCall(TSAdaptChoose(ts->adapt, ts, ts->time_step, nullptr, &next, &accept));
      if (accept)
      {
        radau.last.z.assign(z.span.begin(), z.span.end());
        radau.last.start.assign(start.span.begin(), start.span.end());
        radau.last.h = radau.h;
        radau.last.t = radau.t;
        ++radau.steps;
        ts->ptime += ts->time_step;
      }
      else
        VecCopy(radau.start.get(), ts->vec_sol);
      ts->time_step = next;
      return 0;
    }

    PetscErrorCode
    step(TS ts)
    {
      Radau &radau     = radau_data(ts);
      PetscInt rejects = 0;
      VecCopy(ts->vec_sol, radau.start.get());
      if (ts->steprestart)
        radau.steps = 0;
      while (ts->reason == TS_CONVERGED_ITERATING)
      {
        radau.h = ts->time_step;
        radau.t = ts->ptime;
        PetscCall(radau_solve_stages(ts));
        PetscBool accept = PETSC_TRUE;
        PetscCall(TSAdaptCheckStage(ts->adapt, ts, radau.t + radau.h, ts->vec_sol, &accept));
        if (accept)
        {
          PetscCall(judge(ts, accept));
          if (accept)
            return 0;
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
      *order = static_cast<PetscInt>(radau_data(ts).tableau->n + 1); // the step size scales as error^(1/order)
      *error = radau_data(ts).error;
      return 0;
    }

    PetscErrorCode
    interpolate(TS ts, const PetscReal t, Vec X)
    {
      Radau &radau = radau_data(ts);
      const WriteAccess x(X);
      double weights[radau::max_stages];
      radau::collocation_weights(radau.n_stages(), radau.tableau->c.data(), (t - radau.last.t) / radau.last.h, weights);
      radau::combine(radau.n_stages(), weights, radau.last.z.data(), radau.n(), x.span.data());
      for (std::size_t k = 0; k < radau.n_owned; ++k)
        x.span[k] += radau.last.start[k];
      return 0;
    }

    PetscErrorCode
    set_up(TS ts)
    {
      Radau &radau        = radau_data(ts);
      const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(ts));
      Vec vec             = nullptr;
      for (PetscOwner<Vec> *owner : {&radau.y, &radau.y_dot, &radau.f, &radau.start})
      {
        PetscCall(VecDuplicate(ts->vec_sol, &vec));
        owner->reset(vec);
      }
      PetscInt local = 0;
      PetscCall(VecGetLocalSize(ts->vec_sol, &local));
      radau.n_owned = static_cast<std::size_t>(local);
      PetscCall(VecCreate(comm, &vec));
      radau.z.reset(vec);
      PetscCall(VecSetSizes(vec, static_cast<PetscInt>(radau.tableau->n) * local, PETSC_DECIDE));
      PetscCall(VecSetType(vec, VECSTANDARD));
      return radau_set_up_newton(ts);
    }

    /// @tparam Items PetscOptionItems since PETSc 3.23, a pointer to it before.
    template <typename Items>
    PetscErrorCode
    set_from_options(TS ts, Items)
    {
      auto n           = static_cast<PetscInt>(radau_data(ts).tableau->n);
      PetscBool found  = PETSC_FALSE;
      const char *name = nullptr;
      TSGetOptionsPrefix(ts, &name);
      PetscOptionsGetInt(nullptr, name, "-ts_radau_stages", &n, &found);
      if (found && n != 3 && n != 5)
        SETERRQ(
          PetscObjectComm(reinterpret_cast<PetscObject>(ts)), PETSC_ERR_ARG_OUTOFRANGE, "-ts_radau_stages is 3 or 5");
      if (found)
        radau_data(ts).tableau = &radau_tableau(static_cast<unsigned int>(n));
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
      return PetscViewerASCIIPrintf(viewer, "  Radau IIA with %u stages\n", radau_data(ts).tableau->n);
    }

    PetscErrorCode
    create(TS ts)
    {
      ts->data                = new Radau;
      ts->ops->setup          = set_up;
      ts->ops->step           = step;
      ts->ops->interpolate    = interpolate;
      ts->ops->evaluatewlte   = weighted_error;
      ts->ops->snesfunction   = radau_stage_function;
      ts->ops->snesjacobian   = radau_stage_jacobian;
      ts->ops->setfromoptions = set_from_options;
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

  const RadauTableau &
  radau_set_system(TS ts, ImplicitSystem *system, PetscGuard *guard)
  {
    radau_data(ts).system = system;
    radau_data(ts).guard  = guard;
    return *radau_data(ts).tableau;
  }

  void
  radau_set_stages(TS ts, const unsigned int n_stages)
  {
    radau_data(ts).tableau = &radau_tableau(n_stages);
  }

  void
  radau_exchange(TS ts, Archive &archive)
  {
    Radau &radau      = radau_data(ts);
    Radau::Last &last = radau.last;
    archive(radau.newton.hard_steps, radau.steps, last.start, last.z, last.h, last.t);
    archive(radau.newton.known_rate, ts->time_step, ts->steps, ts->reject, ts->snes_its, ts->ksp_its);
    PetscInt n = 0;
    VecGetLocalSize(ts->vec_sol, &n);
    const auto size     = static_cast<std::size_t>(n);
    const bool has_step = last.start.size() == size && last.z.size() == radau.n_stages() * size;
    archive.require(has_step || (last.start.empty() && last.z.empty() && last.h == 0.), "the last step");
    if (!archive.reads())
      return;
    radau.newton.factors_h = 0.;
    ts->steprestart        = PETSC_FALSE;
  }
} // namespace crawler
