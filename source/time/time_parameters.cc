// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/time/integrators.h>
#include <crawler/time/time_parameters.h>

namespace crawler
{
  namespace
  {
    /// Words of the entry.
    std::vector<std::string>
    integrator_names()
    {
      std::vector<std::string> names = {"automatic"};
      for (const Integrator &entry : integrators())
        names.push_back(entry.name);
      return names;
    }
  } // namespace

  void
  TimeParameters::add_parameters(Declarations &declarations)
  {
    declarations.number("End time", end_time, positive(), "time")
      .means("Duration T; the body starts at rest at time 0.");
    declarations.text("Integrator", integrator, quoted_list(integrator_names()))
      .means(
        "Time integrator (PETSc TS). Automatic: radau 5, radau 9 or bdf, by accuracy and stretch (doc/numerics.md). "
        "Integrators of PETSc that are not sound for this equation are refused with the reason.");
    declarations.choice("Engine", engine)
      .means("Engine that runs the integrator. Automatic: the fused engine of the program, which is several times "
             "faster, for the radau integrators in the position form on uniform meshes, and PETSc otherwise and where "
             "that gives up.");
    declarations.whole_number("Order", order, 1, 5).means("Order of bdf; radau 5 and 9 have the order in their names.");
    declarations.choice("Step control", step_control)
      .means(
        "Whether step sizes follow the estimated error, or all are Initial step (shortened to end on output times).");
    declarations.number("Tolerance", tolerance, positive(), "length")
      .means("Admissible estimated error of the displacement in a step (root mean square over the body). Automatic: "
             "chosen from Accuracy.");
    declarations.number("Initial step", initial_step, positive(), "time")
      .means("Size of the first step. Automatic: chosen from Accuracy.");
    declarations.choice("Cycle stop", cycle_stop)
      .means("Whether a run with a periodic active stress ends when a cycle repeats; the remaining cycles are "
             "extrapolated, with a bound (doc/numerics.md). Automatic: if there are no snapshots and Step control is "
             "adaptive. A table of statistics ends with the cycles that are computed.");
    declarations.whole_number("Maximum number of steps", max_steps, 1, 999999999)
      .means("Number of steps after which the run stops.");
    declarations.number("Wall time limit", wall_time_limit, positive(), "s")
      .means("Wall time after which a run stops normally, with exit code 5; --resume continues it. Automatic: none.");
    declarations.number("Checkpoint interval", checkpoint_interval, between(0., 1e9), "s")
      .means("Wall time between two states that a run saves in restart.dat, from which --resume continues after a "
             "crash. A run that takes less saves none unless it is stopped.");
  }

  void
  TimeParameters::validate() const
  {
    if (integrator != "automatic" && !is_offered(integrator))
    {
      const auto names         = integrator_names();
      const std::string reason = reason_against(integrator);
      if (!reason.empty())
        refuse("Time/Integrator",
               "the integrator \"{}\" is refused: {}; {} is expected",
               integrator,
               reason,
               quoted_list(names));
      refuse("Time/Integrator",
             "unknown integrator \"{}\"; {} is expected{}",
             integrator,
             quoted_list(names),
             nearest_hint(integrator, names));
    }
    if (step_control == StepControl::fixed && !initial_step)
      throw InputError(
        "Step control is fixed, but the size of the steps is missing: a number is expected for Initial step",
        "Time/Step control");
    if (initial_step && *initial_step > end_time)
      refuse(
        "Time/Initial step", "Initial step is {}, but at most the End time, {}, is expected", *initial_step, end_time);
  }
} // namespace crawler
