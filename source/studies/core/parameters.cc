// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/parameters.h>

#include <limits>

namespace crawler
{
  const std::string sweep_syntax          = "\"Section/Entry : VALUES\", several of them separated by semicolons";
  const std::string variables_in_brackets = "Of a list, Section/Entry[2] is the second number, [1-5] are the first "
                                            "five, each a variable, and [*] are all; of the "
                                            "constants of a formula, Section/Constants[a] is a.";
  const std::string variables_syntax      = "\"Section/Entry : FROM to TO\", several of them separated by semicolons";

  void
  SweepParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Sweep");
    declarations.choice("Design", design, {"grid", "zip", "random", "latin hypercube"})
      .means("How the axes are combined: grid, every value with every other one; zip, the first values of all axes "
             "together, then the second ones, and so on; random, points drawn from the axes independently; latin "
             "hypercube, random points that are spread evenly over each axis.");
    declarations.text("Axes", axes, sweep_syntax)
      .means(
        "What varies. VALUES is a list, linspace(first, last, count), logspace(first exponent, last exponent, count), "
        "or column(file.csv, name), the values in a column of a CSV file; for random designs also uniform(from, to) "
        "and loguniform(from, to). The name \"File\" instead of an entry stands for parameter files whose entries "
        "replace those of this one. Names of files count from the folder of this parameter file (with --set, from the "
        "current one).");
    declarations.whole_number("Number of points", n_points, 1, max_points)
      .means("Of a random or Latin hypercube design; the others count themselves.");
    declarations.whole_number("Seed", seed, 0, std::numeric_limits<unsigned int>::max())
      .means("Of the random numbers of a random or Latin hypercube design: the same seed gives the same points.");
    declarations.text("Keep fields", keep_fields, "a list of numbers of points, or nothing")
      .means("Points whose fields are kept: for each there is a folder points/NUMBER with all files of a run.");
    declarations.flag("Cross-check", cross_check)
      .means("Compares answers: each point is run in the position form, in the stretch form and refined, too, and its "
             "row says whether all answers can be right, or one is silently wrong.");
    declarations.number("Cross-check refinement", refinement, between(1, 1e6), "1")
      .means("The refined run asks for Accuracy divided by this and chooses mesh and time steps itself.");
    declarations.number("Time limit per point", point_time_limit, positive(), "s")
      .means("Wall time after which a point is given up; it becomes a row with the reason time_limit. With Cross-check "
             "it holds for each run of a point. Automatic: none.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means("Wall time after which no more points are computed; the rest is for --resume. Automatic: none.");
    declarations.leave();
  }

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
    declarations.text("Integrators", integrators, "a list of integrators as in the section Time")
      .means("The time integrators that it tries.");
    declarations.text("Degrees", degrees, "a list of whole numbers from 1 to 8").means("The degrees that it tries.");
    declarations.text("Cells", cells, "a list of whole numbers").means("The numbers of cells of uniform meshes.");
    declarations.text("Mesh tolerances", mesh_tolerances, numbers, "1")
      .means("The tolerances of adaptive meshes, as in the section Discretization.");
    declarations.text("Tolerances", tolerances, numbers, "1")
      .means("The time tolerances relative to the displacement.");
    declarations.whole_number("Repetitions", repetitions, 1, 1000)
      .means("The cost is the median of so many measurements, each of at least 5 ms.");
    declarations.number("Time limit per run", run_time_limit, positive(), "s")
      .means(
        "A run that takes longer is stopped (reason time_limit), and tighter tolerances on its mesh are not tried.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means("After this time the command ends in order, as with a signal; it can be resumed.");
    declarations.leave();
  }

  void
  OptimizeParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Optimize");
    declarations
      .choice("Objective", objective, {"displacement", "speed", "cost of transport", "merit", "periodic merit"})
      .means("What is made as good as possible: the displacement; the speed of the last stride (of the whole duration "
             "at the kinematic level); the work of the active stress per displacement; the merit D/sqrt(W T/(gamma "
             "L)), which does not depend on how fast the gait is; or the same with the dissipation instead of the work "
             "W, for gaits that repeat, whatever their period: the elastic energy that their start takes does not "
             "count.");
    declarations.choice("Direction", direction, {"forward", "backward"})
      .means("Where the body should go: forward is towards growing s.");
    declarations.text("Variables", variables, variables_syntax)
      .means("The numbers of the scene that vary, with their ranges. The values in this file are the start. " +
             variables_in_brackets);
    declarations.number("Work", work, positive(), "energy")
      .means("Largest work of the active stress over the duration. Automatic: no limit.");
    declarations.number("Positive work", positive_work, positive(), "energy")
      .means(
        "Largest positive work of the active stress, for actuators that cannot recover energy. Automatic: no limit.");
    declarations.number("Dissipation", dissipation, positive(), "energy")
      .means("Largest work against the friction, which is all that a gait that repeats needs. Automatic: no limit.");
    declarations.number("Smallest strain", smallest_strain, between(-1., 0.), "1")
      .means("The strain w - 1 must be at least this. Automatic: no limit.");
    declarations.number("Largest strain", largest_strain, positive(), "1")
      .means("The strain w - 1 must be at most this. Automatic: no limit.");
    declarations.number("Mean-square strain", mean_square_strain, positive(), "1")
      .means("Largest mean over body and duration of the strain squared; at the kinematic level. Automatic: no limit.");
    declarations.number("Largest stress", largest_stress, positive(), "force")
      .means("The size of the active stress must be at most this. Automatic: no limit.");
    declarations.number("Largest stress rate", largest_stress_rate, positive(), "force/time")
      .means("The size of its rate must be at most this. Automatic: no limit.");
    declarations.whole_number("Starts", n_starts, 1, 100000)
      .means("Number of starts: the values in this file, and others at random about them. Ranks share the starts.");
    declarations.number("Start spread", spread, between(0., 1.), "1")
      .means("How far the other starts are from the values in this file, as a share of the ranges.");
    declarations.whole_number("Seed", seed, 0, std::numeric_limits<unsigned int>::max())
      .means("Of the random starts: the same seed gives the same starts.");
    declarations.number("Tolerance", tolerance, between(1e-12, 0.1), "1")
      .means("The optimiser stops when the gradient and the violation of limits, both relative, are below this.");
    declarations.whole_number("Most iterations", max_iterations, 1, 1000000)
      .means("Of the optimiser (its outer loop, in which the multipliers of the limits are found), for each start.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means("Wall time after which the best so far is the result; --resume goes on. Automatic: none.");
    declarations.leave();
  }

  void
  FitParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Fit");
    declarations.files("Data", data, "the name of a file, or of several, separated by semicolons")
      .means("What was measured: tracks of markers or samples of strain, in a file as "
             "crawler table reads it (doc/measured_data.md); or columns t and centre, the path of the centre of mass, "
             "or t and speed, perhaps with a column deviation. Several files have data of different kinds. A name "
             "counts from the folder of this parameter file; crawler fit --data has another one.");
    declarations.text("Variables", variables, variables_syntax)
      .means("The numbers of the scene that are not known, with their ranges. The values in this file are the first "
             "start. " +
             variables_in_brackets);
    declarations.text("Markers at", markers_at, "\"first\" or a list of numbers", "length")
      .means("Where on the body the markers are, from tail to head, as the body is without strain. First: where they "
             "are in the first frame, "
             "the outermost ones at the ends of the body.");
    declarations.number("Place deviation", place_deviation, between(0., 1e100), "length")
      .means("Standard deviation of the places of the markers: they are found with the variables, within it. "
             "Automatic: 0 for a list; places of the first frame are free.");
    declarations.choice("Origin", origin, {"unknown", "tail"})
      .means("From where the tracks count x: from a place that is not known and is found with the variables, or from "
             "where the tail is at the "
             "start of the run.");
    declarations.number("First time", first_time, between(0., 1e100), "time")
      .means("When in the run the first of the data was measured; the times in the file count from there. Automatic: "
             "the times in the file are those "
             "of the run.");
    declarations
      .text("Standard deviation",
            deviation,
            "a positive number or the word \"automatic\", for several files one for each, separated by commas",
            "1")
      .means(
        "Of one number of the data, in its unit. Automatic: that which the data have for each number, or else as they "
        "scatter about the best fit; whether the "
        "scene fits them at all can then "
        "not be told.");
    declarations.whole_number("Starts", n_starts, 1, 100000)
      .means("Number of starts: the values in this file, and others at random in the ranges. The best of all is the "
             "result.");
    declarations.whole_number("Seed", seed, 0, std::numeric_limits<unsigned int>::max())
      .means("Of the random starts: the same seed gives the same starts.");
    declarations.leave();
  }

  void
  Parameters::add_parameters(Declarations &declarations)
  {
    RunParameters::add_parameters(declarations);
    sweep.add_parameters(declarations);
    tradeoff.add_parameters(declarations);
    optimize.add_parameters(declarations);
    fit.add_parameters(declarations);
    units.add_parameters(declarations);
  }
} // namespace crawler
