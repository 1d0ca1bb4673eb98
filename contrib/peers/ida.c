// SPDX-License-Identifier: LGPL-2.1-or-later
//
// SUNDIALS IDA: bdf of variable order, banded analytic Jacobian. METHOD is "ida". See body.h, compare.py.
#include "body.h"

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

static double blocks[MOST_UNKNOWNS * MOST];

static int residual(realtype t, N_Vector u, N_Vector rate, N_Vector F, void *body)
{
  return evaluate(body, t, NV_DATA_S(u), NV_DATA_S(rate), NV_DATA_S(F), 0., NULL);
}

static int jacobian(realtype t, realtype sigma, N_Vector u, N_Vector rate, N_Vector F, SUNMatrix J, void *body, N_Vector x,
                    N_Vector y, N_Vector z)
{
  const struct Body *b = body;
  (void)F, (void)x, (void)y, (void)z;
  if (evaluate(b, t, NV_DATA_S(u), NV_DATA_S(rate), NULL, sigma, blocks))
    return 1;
  SUNMatZero(J);
  for (int cell = 0; cell < b->cells; ++cell)
    for (int j = 0; j <= b->q; ++j)
    {
      const int column = cell * b->q + j;
      for (int i = 0; i <= b->q; ++i)
        SM_ELEMENT_B(J, cell * b->q + i, column) += blocks[(cell * (b->q + 1) + i) * (b->q + 1) + j];
    }
  return 0;
}

static int run(const struct Body *b, double *result)
{
  SUNContext context;
  SUNContext_Create(NULL, &context);
  const N_Vector u = N_VNew_Serial(b->n, context), rate = N_VClone(u), id = N_VClone(u);
  const SUNMatrix J            = SUNBandMatrix(b->n, b->q, b->q, context);
  const SUNLinearSolver solver = SUNLinSol_Band(u, J, context);
  void *ida                    = IDACreate(context);
  N_VConst(0., u), N_VConst(0., rate), N_VConst(1., id);
  IDAInit(ida, residual, 0., u, rate);
  IDASStolerances(ida, 0., b->tolerance);
  IDASetUserData(ida, (void *)b);
  IDASetLinearSolver(ida, solver, J);
  IDASetJacFn(ida, jacobian);
  IDASetMaxNumSteps(ida, 100000);
  IDASetId(ida, id);
  IDASetStopTime(ida, b->T);
  double t = 0.;
  int code = IDACalcIC(ida, IDA_YA_YDP_INIT, 1e-3 * b->T);
  if (code >= 0)
    code = IDASolve(ida, b->T, &t, u, rate, IDA_NORMAL);
  memcpy(result, NV_DATA_S(u), b->n * sizeof *result);
  IDAFree(&ida);
  SUNLinSolFree(solver), SUNMatDestroy(J);
  N_VDestroy(u), N_VDestroy(rate), N_VDestroy(id);
  SUNContext_Free(&context);
  return code < 0 ? code : 0;
}

int main(void)
{
  return serve(run);
}
