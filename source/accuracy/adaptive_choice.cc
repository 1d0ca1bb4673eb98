// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/mesh_choices.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr unsigned int adaptive_degree = 4, max_adaptive_pilot_steps = 20000, max_adaptive_pilot_cells = 1200;
  }

  void
  choose_adaptive_mesh(Pilots &pilots, NumericsChoice &choice)
  {
    using namespace mesh_choice;
    const DiscretizationParameters &own = pilots.parameters.discretization;
    const double L                      = pilots.scene.body.length;
    Numerics &n                         = choice.numerics;
    n.integrator                        = "";
    n.degree                            = own.degree.value_or(adaptive_degree);
    n.n_cells                           = own.n_cells.value_or(
      static_cast<unsigned int>(std::clamp(std::ceil(L / pilots.scales.length), 8., 1. * max_cells)));
    n.mesh        = {1., own.smallest_cell.value_or(1e-6 * L)};
    double strain = pilots.last.strain > 0. ? pilots.last.strain : pilots.scale * pilots.scale / L;
    // Pilots that need more steps than this collapse, and the scheme that is safe then costs less.
    const unsigned int usual = pilots.time.max_steps;
    pilots.time.max_steps    = std::min(usual, max_adaptive_pilot_steps);
    double tighter           = 1.;
    for (int i = 0; i < 4; ++i)
    {
      Numerics settings        = n;
      settings.mesh.tolerance  = tighter * resolved * strain;
      settings.mesh.most_cells = max_adaptive_pilot_cells;
      pilots.count(pilots.run(settings, n.degree, n.n_cells, ResolutionWish::all));
      const bool finished = pilots.finished();
      const double before = strain;
      if (finished && pilots.last.strain > 0.)
        strain = pilots.last.strain;
      const bool strain_known = strain < 4. * before && strain > 0.25 * before;
      if (!finished)
        tighter *= 0.01; // the mesh may have caused the loss of the stretch
      const bool coarse_steps = finished && pilots.size > 0. && pilots.tolerance > 0.03 * pilots.size;
      if (coarse_steps || (!finished && i < 2))
        pilots.tolerance = finished ? std::max(0.01 * pilots.size, 1e-3 * pilots.tolerance) : 0.03 * pilots.tolerance;
      else if (strain_known)
        break;
    }
    pilots.time.max_steps = usual;
    const double accuracy = pilots.parameters.accuracy;
    n.mesh.tolerance = strain * own.mesh_tolerance.value_or(std::min(accuracy / indicator_factor, tighter * resolved));
    // Method bdf restarts with each mesh, unlike one-step methods; but where the stretch collapses it is faster.
    if (pilots.parameters.time.step_control == StepControl::adaptive && pilots.last.min_stretch.value > emptied)
      n.integrator = "radau 5";
  }
} // namespace crawler
