// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/parameters.h>

#include <limits>

namespace crawler
{
  const std::string variables_in_brackets =
    "In a list, Section/Entry[2] is the second number, [1-5] are the first five, each a variable, and [*] are all of "
    "them; among the constants of a formula, Section/Constants[a] is a.";

  void
  SweepParameters::add_parameters(Declarations &declarations)
  {
    declarations.choice("Design", design, {"grid", "zip", "random", "latin hypercube"})
      .means("How the axes are combined: grid, every value with every other one; zip, the first values of all axes "
             "together, then the second ones, and so on; random, points drawn from the axes independently; latin "
             "hypercube, random points that are spread evenly over each axis.");
    declarations.text("Axes", axes, sweep_syntax)
      .means("Entries that vary, with their values. VALUES is a list, linspace(first, last, count), logspace(first "
             "exponent, last exponent, count), or column(file.csv, name), the values in a column of a CSV file; for "
             "random designs also uniform(from, to) and loguniform(from, to). The name \"File\" instead of an entry "
             "stands for parameter files whose entries replace those of this one. File names are relative to the "
             "folder of this parameter file (with --set, to the current one).");
    declarations.whole_number("Number of points", n_points, 1, max_points)
      .means("Number of points of a random or Latin hypercube design; for the other designs it follows from the axes.");
    declarations.whole_number("Seed", seed, 0, std::numeric_limits<unsigned int>::max())
      .means("Seed of the random numbers of a random or Latin hypercube design: the same seed gives the same points.");
    declarations.text("Keep fields", keep_fields, "a list of numbers of points, or nothing")
      .means("Points whose fields are kept: for each there is a folder points/NUMBER with all files of a run.");
    declarations.flag("Cross-check", cross_check)
      .means("Whether answers are compared: each point is also run in the position form, in the stretch form and "
             "refined, and its row says whether all answers can be right or one is silently wrong.");
    declarations.number("Cross-check refinement", refinement, between(1, 1e6), "1")
      .means("Number by which the refined run divides Accuracy; it chooses mesh and time steps itself.");
    declarations.number("Time limit per point", point_time_limit, positive(), "s")
      .means("Wall time after which a point is abandoned; its row has the reason time_limit. With Cross-check the "
             "limit applies to each run of a point. Automatic: none.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means("Wall time after which no more points are computed; --resume computes the rest. Automatic: none.");
  }

  void
  TradeoffParameters::add_parameters(Declarations &declarations)
  {
    const std::string numbers = "values separated by commas, \"linspace(first, last, count)\" or \"logspace(first "
                                "exponent, last exponent, count)\"";
    declarations.text("Models", models, "a list of \"perturbation\", \"kinematic\" and \"nonlinear\"")
      .means("Levels of the model that crawler tradeoff tries. The first two need no mesh; for nonlinear all other "
             "lists of this section are combined.");
    declarations.text("Formulations", formulations, "a list of \"position\" and \"stretch\"")
      .means("Formulations that crawler tradeoff tries.");
    declarations.text("Meshes", meshes, "a list of \"uniform\" and \"adaptive\"")
      .means("Kinds of meshes that crawler tradeoff tries.");
    declarations.text("Engines", engines, "a list of \"fused\", \"petsc\" and \"batch\"")
      .means("Engines that run the integrators: the fused engine, PETSc, or the fused engine with 8 bodies side by "
             "side, whose cost is given per body.");
    declarations.text("Integrators", integrators, "a list of integrators as in the section Time")
      .means("Time integrators that crawler tradeoff tries.");
    declarations.text("Degrees", degrees, "a list of whole numbers from 1 to 8")
      .means("Polynomial degrees that crawler tradeoff tries.");
    declarations.text("Cells", cells, "a list of whole numbers")
      .means("Numbers of cells of the uniform meshes that crawler tradeoff tries.");
    declarations.text("Mesh tolerances", mesh_tolerances, numbers, "1")
      .means("Tolerances of the adaptive meshes that crawler tradeoff tries, as in section Discretization.");
    declarations.text("Tolerances", tolerances, numbers, "1")
      .means("Time tolerances that crawler tradeoff tries, relative to the displacement.");
    declarations.whole_number("Repetitions", repetitions, 1, 1000)
      .means("Number of measurements, each of at least 5 ms, whose median is the cost.");
    declarations.number("Time limit per run", run_time_limit, positive(), "s")
      .means(
        "Time after which a run is stopped (reason time_limit); tighter tolerances on its mesh are then not tried.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means("Time after which the command ends normally, as after a signal; it can be resumed.");
  }

  void
  OptimizeParameters::add_parameters(Declarations &declarations)
  {
    declarations
      .choice("Objective", objective, {"displacement", "speed", "cost of transport", "merit", "periodic merit"})
      .means("Quantity that is optimised: the displacement; the speed of the last stride (of the whole duration at the "
             "kinematic level); the work of the active stress per displacement; the merit D/sqrt(W T/(gamma L)), which "
             "does not depend on the pace of the gait; or the same with the dissipation instead of the work W, for "
             "periodic gaits, whatever their period: the elastic energy that their start takes does not count.");
    declarations.choice("Direction", direction, {"forward", "backward"})
      .means("Direction in which the body should move; forward is towards increasing s.");
    declarations.text("Variables", variables, variables_syntax)
      .means("Numbers of the scene that vary, with their ranges. The values in this file are the start. " +
             variables_in_brackets);
    declarations.number("Work", work, positive(), "energy")
      .means("Largest work of the active stress over the duration. Automatic: no limit.");
    declarations.number("Positive work", positive_work, positive(), "energy")
      .means(
        "Largest positive work of the active stress, for actuators that cannot recover energy. Automatic: no limit.");
    declarations.number("Dissipation", dissipation, positive(), "energy")
      .means(
        "Largest work against the friction, which is all the work that a periodic gait needs. Automatic: no limit.");
    declarations.number("Smallest strain", smallest_strain, between(-1., 0.), "1")
      .means("Lower limit of the strain w - 1. Automatic: no limit.");
    declarations.number("Largest strain", largest_strain, positive(), "1")
      .means("Upper limit of the strain w - 1. Automatic: no limit.");
    declarations.number("Mean-square strain", mean_square_strain, positive(), "1")
      .means(
        "Largest mean of the squared strain over body and duration; only at the kinematic level. Automatic: no limit.");
    declarations.number("Largest stress", largest_stress, positive(), "force")
      .means("Upper limit of the absolute value of the active stress. Automatic: no limit.");
    declarations.number("Largest stress rate", largest_stress_rate, positive(), "force/time")
      .means("Upper limit of the absolute rate of change of the active stress. Automatic: no limit.");
    declarations.whole_number("Starts", n_starts, 1, 100000)
      .means("Number of starts: the values in this file, and others drawn at random around them. The ranks share the "
             "starts.");
    declarations.number("Start spread", spread, between(0., 1.), "1")
      .means("Largest distance of the other starts from the values in this file, as a share of the ranges.");
    declarations.whole_number("Seed", seed, 0, std::numeric_limits<unsigned int>::max())
      .means("Seed of the random starts: the same seed gives the same starts.");
    declarations.number("Tolerance", tolerance, between(1e-12, 0.1), "1")
      .means("Relative gradient and relative violation of limits below which the optimiser stops.");
    declarations.whole_number("Most iterations", max_iterations, 1, 1000000)
      .means("Largest number of iterations of the optimiser (its outer loop, which finds the multipliers of the "
             "limits) per start.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means(
        "Wall time after which the best gait so far is the result; --resume continues the search. Automatic: none.");
  }

  void
  FitParameters::add_parameters(Declarations &declarations)
  {
    declarations.files("Data", data, "the name of a file, or of several, separated by semicolons")
      .means("Measured data: tracks of markers or samples of strain, in a file that crawler table can read "
             "(doc/measured_data.md); or columns t and centre, the path of the centre of mass, or t and speed, perhaps "
             "with a column deviation. Several files must have data of different kinds. File names are relative to the "
             "folder of this parameter file; crawler fit --data replaces them.");
    declarations.text("Variables", variables, variables_syntax)
      .means("Unknown numbers of the scene, with their ranges. The values in this file are the first start. " +
             variables_in_brackets);
    declarations.text("Markers at", markers_at, "\"first\" or a list of numbers", "length")
      .means("Places of the markers on the unstrained body, from tail to head. First: those in the first frame, with "
             "the outermost markers at the ends of the body.");
    declarations.number("Place deviation", place_deviation, between(0., 1e100), "length")
      .means("Standard deviation of the places of the markers, which are found together with the variables, within "
             "this deviation, less than a quarter of the body. Automatic: 0 for a list; places of the first frame are "
             "free.");
    declarations.choice("Origin", origin, {"unknown", "tail"})
      .means("Origin of the x of the tracks: an unknown place that is found together with the variables, or the place "
             "of the tail at the start of the run.");
    declarations.number("First time", first_time, between(0., 1e100), "time")
      .means("Time of the run at which the first datum was measured; the times in the file count from there. "
             "Automatic: the times in the file are those of the run.");
    declarations
      .text("Standard deviation",
            deviation,
            "a positive number or the word \"automatic\", for several files one for each, separated by commas",
            "1")
      .means(
        "Standard deviation of one datum, in its unit. Automatic: the one that the data give for each number, or else "
        "their scatter about the best fit; in that case it cannot be told whether the scene fits them at all.");
    declarations.whole_number("Starts", n_starts, 1, 100000)
      .means("Number of starts: the values in this file, and others drawn at random from the ranges. The best of all "
             "is the result.");
    declarations.whole_number("Seed", seed, 0, std::numeric_limits<unsigned int>::max())
      .means("Seed of the random starts: the same seed gives the same starts.");
  }

  void
  Parameters::add_parameters(Declarations &declarations)
  {
    RunParameters::add_parameters(declarations);
    declarations.section("Sweep", sweep);
    declarations.section("Tradeoff", tradeoff);
    declarations.section("Optimize", optimize);
    declarations.section("Fit", fit);
    declarations.section("Units", units);
  }
} // namespace crawler
