// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/atlas_parameters.h>

namespace crawler
{
  void
  AtlasParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Atlas");
    declarations.text("First axis", first_axis, axis_syntax)
      .means("The entry, and its values, that varies along the first axis of the map that crawler atlas makes. Any "
             "entry that is a number will do.");
    declarations.text("Second axis", second_axis, axis_syntax).means("The same for the second axis.");
    declarations.number("Refinement", refinement, between(1, 1e6), "1")
      .means("The refined run, with which the others are compared, asks for Accuracy divided by this and chooses mesh "
             "and time steps itself.");
    declarations.number("Time limit per run", time_limit, positive(), "s")
      .means("A run at a point of the map that takes longer is stopped (reason time_limit).");
    declarations.leave();
  }
} // namespace crawler
