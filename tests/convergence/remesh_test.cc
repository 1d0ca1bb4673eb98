// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../support/run_text.h"
#include "../support/test.h"

using namespace crawler;

/// A one-step method loses nothing when the mesh changes: a pulse that travels takes its fine cells with it, and the
/// steps are those of a mesh that is fine everywhere, but for the norm of their error: it is a mean over nodes, which
/// an adaptive mesh has where the errors are. A state that the mesh refuses is done again, so a change may cost that
/// one step.
TEST(Remesh, AnAdaptiveRunTakesTheStepsOfAFineMesh)
{
  auto parameters = test::parameters_with(
    test::set("p = 2; expression; Active stress = 0.3*(1-exp(-(t/0.1)^2))*exp(-((s-0.2-0.6*t)/0.03)^2)"));
  const Scene scene = parameters.create_scene();
  for (const std::string name : {"radau 5", "radau 9"})
    for (const double tolerance : {1e-5, 1e-6, 1e-7})
    {
      parameters.time.integrator = name;
      Numerics numerics{.degree = 6, .n_cells = 48, .tolerance = tolerance, .initial_step = 1e-5};
      const auto fine     = Simulation(MPI_COMM_WORLD, scene, parameters.time, numerics).run({}, {});
      numerics.n_cells    = 8;
      numerics.mesh       = {.tolerance = 1e-8, .smallest_cell = 1e-3, .most_cells = 1000};
      const auto adaptive = Simulation(MPI_COMM_WORLD, scene, parameters.time, numerics).run({}, {});
      EXPECT_GE(adaptive.process.mesh.changes, 5u) << name;
      EXPECT_LE(adaptive.time.steps, 1.1 * fine.time.steps + 1.) << name;
      EXPECT_LE(adaptive.time.rejected_steps, adaptive.process.mesh.changes + 1) << name;
    }
}
