// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A one-step method loses nothing when the mesh changes: a run that is interrupted again and again, its state carried
// to another mesh and integrated on, takes the steps of one that is not. bdf, which starts anew each time, takes many
// more.
#include "../support/run_text.h"
#include "../support/test.h"

#include <crawler/equation/general_position_form.h>
#include <crawler/equation/mesh_transfer.h>
#include <crawler/time/integrators.h>

using namespace crawler;

namespace
{
  constexpr unsigned int degree = 6, n_cells = 8;
  constexpr double first_step = 1e-5; ///< of every start of bdf, and of the first of a one-step method

  /// A crawler on one mesh, and its time stepper.
  struct OnMesh
  {
    OnMesh(const Scene &scene, const TimeParameters &time, std::unique_ptr<Discretization> discretization)
      : mesh(std::move(discretization))
      , form(create_position_form(scene, *mesh))
      , stepper(petsc_stepper(MPI_COMM_WORLD, *form, time))
    {
      form->keep_stresses(integrator(time.integrator).n_stages);
    }

    std::unique_ptr<Discretization> mesh;
    std::unique_ptr<PositionForm> form;
    std::unique_ptr<Stepper> stepper;
  };

  /// What a run took, its interruptions included.
  struct Count
  {
    unsigned int steps = 0, rejected = 0, mesh_changes = 0;
    unsigned long newton_iterations = 0;
    double displacement             = 0.;
  };

  /// Changes the mesh after every @p steps_on_a_mesh steps: all cells are divided, then joined again, and so on.
  Count
  run(const std::string &name, const double tolerance, const unsigned int steps_on_a_mesh)
  {
    auto parameters            = test::parameters_with(test::wave(-1., 0.3));
    parameters.time.integrator = name;
    const Scene scene          = parameters.create_scene();
    auto part                  = std::make_unique<OnMesh>(
      scene, parameters.time, std::make_unique<Discretization>(MPI_COMM_WORLD, 1., n_cells, degree));
    std::vector<double> y(part->form->n_owned(), 0.);
    Count count;
    double time = 0., size = first_step;
    for (;;)
    {
      part->stepper->begin(y, {time, {1.}, tolerance, size, {}});
      for (const Step *step = part->stepper->next(); step != nullptr && step->number < steps_on_a_mesh;)
        step = part->stepper->next();
      y.assign(part->stepper->state().begin(), part->stepper->state().end());
      const TimeOutcome outcome = part->stepper->outcome();
      count.steps += outcome.steps;
      count.rejected += outcome.rejected_steps;
      count.newton_iterations += outcome.newton_iterations;
      if (outcome.status != Status::none)
      {
        EXPECT_EQ(outcome.status, Status::finished) << name;
        const std::vector<double> at_rest(part->mesh->n_owned(), 0.);
        count.displacement = part->form->integrals(1., y, at_rest).displacement;
        return count;
      }
      const auto change = count.mesh_changes++ % 2 == 0 ? CellChange::divide : CellChange::join;
      auto next         = std::make_unique<OnMesh>(
        scene, parameters.time, part->mesh->adapted(std::vector<CellChange>(part->mesh->n_cells(), change)));
      y    = transferred(*part->form, y, *next->form);
      part = std::move(next);
      time = outcome.time;
      size = name == "bdf" ? std::min(outcome.step_size, first_step) : outcome.step_size;
    }
  }

  constexpr unsigned int never = 1000000;
} // namespace

TEST(Remesh, CostsARadauMethodNoSteps)
{
  for (const std::string name : {"radau 5", "radau 9"})
    for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8})
    {
      const Count plain = run(name, tolerance, never);
      for (const unsigned int steps_on_a_mesh : {8u, 2u, 1u})
      {
        const Count remeshed = run(name, tolerance, steps_on_a_mesh);
        EXPECT_GE(remeshed.mesh_changes, plain.steps / steps_on_a_mesh - 1) << name;
        EXPECT_LE(remeshed.steps + remeshed.rejected, plain.steps + plain.rejected + 2) << name;
        EXPECT_NEAR(remeshed.displacement, plain.displacement, 10. * tolerance) << name;
      }
    }
}

TEST(Remesh, CostsBdfManySteps)
{
  const double tolerance = 1e-6;
  const Count plain      = run("bdf", tolerance, never);
  for (const unsigned int steps_on_a_mesh : {40u, 20u})
  {
    const Count remeshed = run("bdf", tolerance, steps_on_a_mesh);
    EXPECT_GE(remeshed.steps, plain.steps + 15 * remeshed.mesh_changes);
  }
}

/// The same within a whole run: a pulse that travels takes its fine cells with it, and the steps are those of a mesh
/// that is fine everywhere, but for the norm of their error: it is a mean over nodes, which an adaptive mesh has where
/// the errors are. A state that the mesh refuses is done again, so a change may cost that one step.
TEST(Remesh, AnAdaptiveRunTakesTheStepsOfAFineMesh)
{
  auto parameters = test::parameters_with(
    test::set("p = 2; expression; Active stress = 0.3*(1-exp(-(t/0.1)^2))*exp(-((s-0.2-0.6*t)/0.03)^2)"));
  const Scene scene = parameters.create_scene();
  for (const std::string name : {"radau 5", "radau 9"})
    for (const double tolerance : {1e-5, 1e-6, 1e-7})
    {
      parameters.time.integrator = name;
      Numerics numerics{degree, 48, tolerance, first_step};
      const auto fine     = Simulation(MPI_COMM_WORLD, scene, parameters.time, numerics).run({}, {});
      numerics.n_cells    = n_cells;
      numerics.mesh       = {.tolerance = 1e-8, .smallest_cell = 1e-3, .most_cells = 1000};
      const auto adaptive = Simulation(MPI_COMM_WORLD, scene, parameters.time, numerics).run({}, {});
      EXPECT_GE(adaptive.mesh_changes, 5u) << name;
      EXPECT_LE(adaptive.time.steps, 1.1 * fine.time.steps + 1.) << name;
      EXPECT_LE(adaptive.time.rejected_steps, adaptive.mesh_changes + 1) << name;
    }
}
