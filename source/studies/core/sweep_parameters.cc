// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/sweep_parameters.h>

#include <limits>

namespace crawler
{
  const std::string sweep_syntax = "\"Section/Entry : VALUES\", several of them separated by semicolons";

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
    declarations.whole_number("Number of points", n_points, 1, most_points)
      .means("Of a random or Latin hypercube design; the others count themselves.");
    declarations.whole_number("Seed", seed, 0, std::numeric_limits<unsigned int>::max())
      .means("Of the random numbers of a random or Latin hypercube design: the same seed gives the same points.");
    declarations.text("Keep fields", keep_fields, "a list of numbers of points, or nothing")
      .means("Points whose fields are kept: for each there is a folder points/NUMBER with all files of a run.");
    declarations.number("Time limit per point", point_time_limit, positive(), "s")
      .means(
        "Wall time after which a point is given up; it becomes a row with the reason time_limit. Automatic: none.");
    declarations.number("Time limit", time_limit, positive(), "s")
      .means("Wall time after which no more points are computed; the rest is for --resume. Automatic: none.");
    declarations.leave();
  }
} // namespace crawler
