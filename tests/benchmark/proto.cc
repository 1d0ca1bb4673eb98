#include "../support/run_text.h"
#include <chrono>
#include <crawler/drivers/batch.h>
#include <cstdio>
#include <deal.II/base/mpi.h>
using namespace crawler;
int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize guard(argc, argv, 1);
  auto settings         = test::wave(-1., 0.4);
  const auto parameters = test::parameters_with(settings);
  const Scene scene     = parameters.create_scene();
  unsigned q = atoi(argv[1]), N = atoi(argv[2]), s = atoi(argv[3]);
  double tol = atof(argv[4]), h0 = atof(argv[5]);
  const char *isa     = argc > 6 ? argv[6] : "avx512";
  bool ledger         = argc > 7;
  const bool single   = std::string(isa) == "single";
  const LaneEngine &e = single ? single_engine() : *batch_engine(isa);
  Numerics num;
  num.degree       = q;
  num.n_cells      = N;
  num.tolerance    = tol;
  num.initial_step = h0;
  num.integrator   = s == 3 ? "radau 5" : "radau 9";
  std::vector<BatchRun> runs(single ? 1000 : 8000, {&scene, &parameters.time, &num});
  double best = 1e9;
  std::vector<std::optional<SimulationResult>> r;
  for (int i = 0; i < 5; ++i)
  {
    auto t = std::chrono::steady_clock::now();
    r      = run_batch(runs, {.ledger = ledger}, {}, e);
    best   = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count());
  }
  Simulation sim(MPI_COMM_SELF, scene, parameters.time, num);
  auto show = [&](const char *n, const SimulationResult &x)
  {
    printf("%s: %.0f runs/s; disp %.15f err %.2e steps %u rej %u newton %lu min %.12f %.9f %.9f max %.12f ",
           n,
           runs.size() / best,
           x.displacement,
           x.displacement / 9.0072529800e-2 - 1,
           x.time.steps,
           x.time.rejected_steps,
           x.time.newton_iterations,
           x.min_stretch.value,
           x.min_stretch.s,
           x.min_stretch.t,
           x.max_stretch.value);
    if (x.ledger)
      printf("W %.15f Q %.15f E %.15f res %.1e nf %.1e pp %.12f end %.12f",
             x.ledger->stress_power,
             x.ledger->dissipation,
             x.ledger->elastic_energy,
             x.ledger->residual(),
             x.net_friction,
             x.ledger->positive_power,
             x.ledger->end_work);
    printf("\n");
  };
  show("batch", *r[0]);
  show("sim  ", sim.run({}, {.ledger = true}));
  auto tp   = parameters.time;
  tp.engine = "petsc";
  Simulation sim2(MPI_COMM_SELF, scene, tp, num);
  show("petsc", sim2.run({}, {.ledger = true}));
  Simulation sim3(MPI_COMM_SELF, scene, parameters.time, num);
  for (bool l : {false, true})
    for (auto *p : {&sim3, &sim2})
    {
      double b = 1e9;
      for (int i = 0; i < 50; ++i)
      {
        auto t = std::chrono::steady_clock::now();
        p->run({}, {.ledger = l});
        b = std::min(b, std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count());
      }
      printf("%s ledger %d: %.1f us\n", p == &sim2 ? "petsc" : "fused", l, b * 1e6);
    }
}
