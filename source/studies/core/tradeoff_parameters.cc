// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/tradeoff_parameters.h>

namespace crawler
{
  void
  TradeoffParameters::add_parameters(Declarations &declarations)
  {
    const std::string numbers = "values separated by commas, \"linspace(first, last, count)\" or \"logspace(first "
                                "exponent, last exponent, count)\"";
    declarations.enter("Tradeoff");
    declarations.text("Models", models, "a list of \"perturbation\", \"kinematic\" and \"nonlinear\"")
      .means("The levels of the model that crawler tradeoff tries. The first two need no mesh; for nonlinear all other "
             "lists of this section are combined.");
    declarations.text("Formulations", formulations, "a list of \"position\" and \"stretch\"")
      .means("The formulations that it tries.");
    declarations.text("Meshes", meshes, "a list of \"uniform\" and \"adaptive\"")
      .means("The kinds of meshes that it tries.");
    declarations.text("Engines", engines, "a list of \"fused\", \"petsc\" and \"batch\"")
      .means("What carries the integrators out: the fused engine, PETSc, or the fused engine with 8 bodies side by "
             "side, where the cost is that of one body.");
    declarations
      .text("Integrators", integrators, "a list of integrators as in the section Time that estimate their error")
      .means("The time integrators that it tries.");
    declarations.text("Degrees", degrees, "a list of whole numbers from 1 to 8").means("The degrees that it tries.");
    declarations.text("Cells", cells, "\"automatic\" or a list of whole numbers")
      .means("The numbers of cells of uniform meshes. Automatic: up to five for each degree, from the coarsest mesh "
             "that is good for 3 % on (doc/numerics.md).");
    declarations.text("Mesh tolerances", mesh_tolerances, numbers, "1")
      .means("The tolerances of adaptive meshes, as in the section Discretization.");
    declarations.text("Tolerances", tolerances, numbers, "1")
      .means("The time tolerances relative to the displacement, the loosest first. A mesh's list ends early where "
             "tighter ones cannot reduce the error.");
    declarations.whole_number("Repetitions", repetitions, 1, 1000)
      .means("The cost is the median of so many measurements, each of at least 5 ms.");
    declarations.number("Time limit per run", run_time_limit, positive(), "s")
      .means(
        "A run that takes longer is stopped (reason time_limit), and tighter tolerances on its mesh are not tried.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means("After this time the command ends in order, as with a signal; it can be resumed.");
    declarations.leave();
  }
} // namespace crawler
