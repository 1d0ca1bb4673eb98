// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/mesh_choices.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Meshes are doubled until the displacement settles, which it does in proportion to the cell size, with tolerances
    /// that fall in the same proportion; limits on cells, and on cells times steps.
    constexpr unsigned int last_moving_cells = 2048;
    constexpr double max_moving_work         = 1e7;
    /// Smallest number of steps of a period for each cell.
    constexpr double moving_steps = 4.;
    /// Factors on the last change, which is the remaining error of a first-order method: the first one counts more.
    constexpr double moving_factor = 1.5, moving_factor_of_first = 4.;
  } // namespace

  void
  choose_mesh_for_moving_jumps(Pilots &pilots, NumericsChoice &choice)
  {
    using namespace mesh_choice;
    const double accuracy = pilots.parameters.accuracy, end = pilots.scene.end_time;
    Numerics &n  = choice.numerics;
    n.jumps_move = true;
    n.degree     = pilots.parameters.discretization.degree.value_or(moving_degree);
    n.integrator = "radau 5";
    if (pilots.cycles)
      pilots.cycles->accuracy = 0.01 * accuracy; // the displacements are compared here
    const double period = std::min(pilots.scene.active_stress->period().value_or(end), end);
    double change       = std::numeric_limits<double>::infinity();
    for (n.n_cells = first_moving_cells;; n.n_cells *= 2)
    {
      // Steps that pass over many cells at once miss the motion in between, and their errors look small.
      n.step_limits        = {{0., period / (moving_steps * n.n_cells)}};
      n.tolerance          = moving_tolerance * pilots.scale / n.n_cells;
      pilots.tolerance     = n.tolerance;
      const double before  = pilots.last.displacement;
      const bool is_second = pilots.finished();
      pilots.count(pilots.run(n, n.degree, n.n_cells, ResolutionWish::size));
      const bool finished = pilots.finished();
      if (!finished && (n.n_cells > first_moving_cells || pilots.last.time.reason == "inverted_at_end"))
        return; // the run will report the reason
      // Meshes double their cells and take up to twice the steps.
      unsigned int last = n.n_cells;
      for (double work = 4. * n.n_cells * pilots.last.time.steps;
           2 * last <= last_moving_cells && work < max_moving_work;
           work *= 4.)
        last *= 2;
      if (finished && is_second)
      {
        const double change_before = change;
        change                     = std::abs(pilots.last.displacement - before);
        // Changes may be small by chance if there is only one.
        const bool is_first = !std::isfinite(change_before);
        const double error =
          is_first ? moving_factor_of_first * change : moving_factor * std::max(change, 0.5 * change_before);
        const double wanted   = accuracy * pilots.size;
        choice.measured_error = error;
        choice.space_share    = 0.9; // the tolerance is small
        choice.advice         = "the active stress jumps at places that move through the cells, where the error falls "
                                "only like the size of a cell, and works and energies are known only to within some per "
                                "cent: fronts of finite width (a smoothed square profile) cost far less";
        const bool hopeless   = !is_first && error > wanted * last / n.n_cells;
        if (error <= 0.9 * wanted || hopeless) // the end of cycles has an error, too
          return;
      }
      if (n.n_cells == last)
        return;
    }
  }
} // namespace crawler
