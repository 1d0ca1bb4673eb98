// SPDX-License-Identifier: LGPL-2.1-or-later
//
// PETSc TS: F(t, u, u_t) = 0 as IFunction with the analytic IJacobian, sparse LU in the natural order, one Newton step
// per stage where that is sound. METHOD is "bdfN" (adaptive, order N) or "arkimexN" (adaptive). Objects are kept while the
// mesh stays. See body.h, compare.py.
#include "body.h"

#include <petscts.h>

static double blocks[MOST_UNKNOWNS * MOST];
static const struct Body *body;
static TS ts;
static Mat J;
static Vec u, residual;

static PetscErrorCode implicit_function(TS stepper, PetscReal t, Vec state, Vec rate, Vec F, void *context)
{
  const PetscScalar *x, *v;
  PetscScalar *f;
  VecGetArrayRead(state, &x), VecGetArrayRead(rate, &v), VecGetArrayWrite(F, &f);
  if (evaluate(body, t, x, v, f, 0., NULL))
  {
    SNES snes;
    TSGetSNES(stepper, &snes);
    SNESSetFunctionDomainError(snes);
  }
  VecRestoreArrayRead(state, &x), VecRestoreArrayRead(rate, &v), VecRestoreArrayWrite(F, &f);
  (void)context;
  return 0;
}

static PetscErrorCode implicit_jacobian(TS stepper, PetscReal t, Vec state, Vec rate, PetscReal sigma, Mat A, Mat B, void *context)
{
  const PetscScalar *x, *v;
  const int size = body->q + 1;
  PetscInt rows[MOST];
  VecGetArrayRead(state, &x), VecGetArrayRead(rate, &v);
  evaluate(body, t, x, v, NULL, sigma, blocks);
  VecRestoreArrayRead(state, &x), VecRestoreArrayRead(rate, &v);
  MatZeroEntries(B);
  for (int cell = 0; cell < body->cells; ++cell)
  {
    for (int i = 0; i < size; ++i)
      rows[i] = cell * body->q + i;
    MatSetValues(B, size, rows, size, rows, blocks + cell * size * size, ADD_VALUES);
  }
  MatAssemblyBegin(B, MAT_FINAL_ASSEMBLY), MatAssemblyEnd(B, MAT_FINAL_ASSEMBLY);
  (void)stepper, (void)A, (void)context;
  return 0;
}

static PetscErrorCode create(void)
{
  SNES snes;
  KSP ksp;
  PC pc;
  TSAdapt adapt;
  static int n = 0, q = 0;
  static char method[32];
  if (ts && n == body->n && q == body->q && strcmp(method, body->method) == 0)
    return 0;
  n = body->n, q = body->q, strcpy(method, body->method);
  TSDestroy(&ts), MatDestroy(&J), VecDestroy(&u), VecDestroy(&residual);
  MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 2 * q + 1, NULL, &J);
  MatCreateVecs(J, &u, &residual);
  TSCreate(PETSC_COMM_SELF, &ts);
  TSSetIFunction(ts, residual, implicit_function, NULL);
  TSSetIJacobian(ts, J, J, implicit_jacobian, NULL);
  TSSetEquationType(ts, TS_EQ_IMPLICIT);
  TSGetSNES(ts, &snes);
  if (strncmp(method, "bdf", 3) == 0)
  {
    TSSetType(ts, TSBDF);
    TSBDFSetOrder(ts, atoi(method + 3));
    SNESSetType(snes, SNESKSPONLY);
  }
  else
  {
    TSSetType(ts, TSARKIMEX);
    TSARKIMEXSetType(ts, method + strlen("arkimex"));
    SNESSetType(snes, SNESNEWTONLS);
  }
  SNESGetKSP(snes, &ksp);
  KSPSetType(ksp, KSPPREONLY);
  KSPGetPC(ksp, &pc);
  PCSetType(pc, PCLU);
  PCFactorSetMatOrderingType(pc, MATORDERINGNATURAL);
  TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP);
  TSSetMaxSNESFailures(ts, -1);
  TSGetAdapt(ts, &adapt);
  TSAdaptSetClip(adapt, 0.1, 3.);
  TSSetErrorIfStepFails(ts, PETSC_FALSE);
  TSSetMaxSteps(ts, 100000);
  return 0;
}

static int run(const struct Body *b, double *result)
{
  const PetscScalar *x;
  SNES snes;
  TSConvergedReason reason;
  body = b;
  create();
  TSGetSNES(ts, &snes);
  SNESSetTolerances(snes, 1e-2 * b->tolerance, 1e-3, 1e-50, 20, 1000);
  TSSetTolerances(ts, b->tolerance, NULL, 0., NULL);
  VecSet(u, 0.);
  TSSetTime(ts, 0.), TSSetStepNumber(ts, 0), TSSetMaxTime(ts, b->T);
  TSSetTimeStep(ts, fmax(1e-7, fmin(1e-3, sqrt(b->tolerance) * 1e-2)));
  TSRestartStep(ts);
  TSSolve(ts, u);
  TSGetConvergedReason(ts, &reason);
  VecGetArrayRead(u, &x);
  memcpy(result, x, b->n * sizeof *result);
  VecRestoreArrayRead(u, &x);
  return reason > 0 ? 0 : (int)reason - 100;
}

int main(int argc, char **argv)
{
  PetscInitialize(&argc, &argv, NULL, NULL);
  PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  const int code = serve(run);
  PetscFinalize();
  return code;
}
