// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Speeds of whole runs and of their parts (Google Benchmark). items_per_second counts runs, or calls of a kernel; times
// are processor times. contrib/benchmark.py compares them with the targets.
//
//   run/petsc/1e-4 ...   The Fig. S1 case (a = -1, chi = 0.4, T = 1) solved by PETSc to that relative error of the
//                        displacement, the process kept and all objects reused, nothing computed but the displacement
//                        and the extremes of the stretch. The settings, in the label, are the cheapest of a search over
//                        integrators, degrees, cells and tolerances (setting_search.h), and the counter "error" is the
//                        true error that they reach.
//   run/fused/1e-4 ...   The same by the fused engine, one body at a time.
//   run/batch/1e-4 ...   The same, 4096 bodies side by side by run_batch(), from scenes to results. run/batch_avx2 and
//                        run/batch_baseline are without the newer instructions, run/batch_energy_balance is with the
//                        energy balance.
//   answer/run/1e-4 ...  What Accuracy delivers: choice of the settings, run with the energy balance, bounds of the
//                        errors (set-up of all objects included). "ratio" is its time over that of run/fused, "bound"
//                        the bound of the error; also for the cases stiff, a=-3, a=2 and fig2.
//   case/fig2/1e-6/...   20 strides (T = 20), by petsc, fused and batch.
//   case/stiff/1e-6/...  The stiff body (a = -1, chi = 0.3, k = 100).
//   robot/64/1e-4 ...    Robots of so many segments that switch by jumps, in the way of answer/.
//   general/*/...        Bodies and grounds that are not plain, and the plain one, with one setting: one body (fused),
//                        256 side by side (batch).
//   sweep/1e-4, 1e-6     40 exponents a in [-3, -0.5] times 25 chi in [0.05, 0.45] by run_batch() with one setting for
//                        each half of the chi: the cheapest with which the largest true error of all its scenes is
//                        below that. Runs that the batch gives back are computed by a Simulation; the time includes
//                        them.
//   kernel/...           Residual, Jacobian, elimination and velocity on a mesh of n cells.
//   kernel/expression/... The active stress as a formula: "bulk" evaluates it at the Gauss points of n cells of degree
//                        4 (items are points), "construction" prepares it for a mesh.
//   scale/...            One Newton step (residual, Jacobian, elimination, solution) of 1e6 unknowns.
#include "benchmarks.h"

#include <crawler/base/mpi_session.h>

#include <benchmark/benchmark.h>

int
main(int argc, char **argv)
{
  int one = 1;
  const crawler::MpiSession guard(one, argv);
  crawler::test::add_run_benchmarks();
  crawler::test::add_sweep_benchmarks();
  crawler::test::add_kernel_benchmarks();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
