// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/drivers/numerics_choice.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace crawler
{
  namespace
  {
    // The constants of the rule; doc/numerics.md says how they were found.
    constexpr unsigned int automatic_degree = 6;
    constexpr unsigned int fewest_cells = 4, most_cells = 4096;
    constexpr unsigned int most_pilot_steps = 100000;
    /// A pilot's mesh is good enough to predict others if its `unresolved` is below this.
    constexpr double resolved = 1e-3;
    /// Error of the displacement in space, relative, is below this times `unresolved` of the mesh.
    constexpr double space_factor = 4.;
    /// Error of the displacement in time is below this times the number of steps times the tolerance.
    constexpr double time_factor = 0.25;
    /// The displacement counts as no smaller than this part of the body's largest deformation.
    constexpr double displacement_floor = 1e-4;

    /// What a look at the active stress alone tells: pilots cannot miss what this has seen.
    struct StressScales
    {
      double displacement; ///< of the stiff body, or of the one that is held by friction [length]
      double length;       ///< largest |m| over largest |m_s| [length]
      double time;         ///< largest |m| over largest |m_t| [time]
    };

    StressScales
    stress_scales(const Scene &scene)
    {
      constexpr unsigned int fine = 512, coarse = 16;
      const double L = scene.body.length, T = scene.end_time;
      double largest = 0., along = 0., over = 0.;
      const auto look = [&](const unsigned int n_points, const unsigned int n_times)
      {
        std::vector<double> points(n_points + 1), m(n_points + 1), before;
        for (unsigned int i = 0; i <= n_points; ++i)
          points[i] = L * i / n_points;
        const auto stress = scene.active_stress->at(points);
        for (unsigned int j = 0; j <= n_times; ++j)
        {
          before = m;
          stress->values(T * j / n_times, m);
          for (unsigned int i = 0; i <= n_points; ++i)
          {
            largest = std::max(largest, std::abs(m[i]));
            if (i > 0)
              along = std::max(along, std::abs(m[i] - m[i - 1]) / (points[i] - points[i - 1]));
            if (j > 0)
              over = std::max(over, std::abs(m[i] - before[i]) * n_times / T);
          }
        }
      };
      look(fine, coarse);
      look(coarse, fine);
      return {std::min(largest * L / scene.body.elastic_modulus, largest * T / (L * scene.body.friction_coefficient)),
              along > 0. ? largest / along : L,
              over > 0. ? largest / over : T};
    }
  } // namespace

  NumericsChoice
  choose_numerics(MPI_Comm communicator, const Parameters &parameters, const Scene &scene)
  {
    const auto start = std::chrono::steady_clock::now();
    const double T = scene.end_time, L = scene.body.length, accuracy = parameters.accuracy;
    const auto &user_cells     = parameters.discretization.n_cells;
    const auto &user_tolerance = parameters.time.tolerance;
    NumericsChoice choice;
    Numerics &numerics    = choice.numerics;
    numerics.degree       = parameters.discretization.degree.value_or(automatic_degree);
    numerics.initial_step = parameters.time.initial_step.value_or(1e-5 * T);
    // The stretch of a linear element has no mode that could show what is missing: one degree more shows it.
    const unsigned int pilot_degree = std::max(numerics.degree, 2u);

    const StressScales scales = stress_scales(scene);
    numerics.largest_step     = scales.time;
    const std::string &formulation = parameters.discretization.formulation;
    numerics.formulation           = formulation == "position"    ? FormulationChoice::position :
                                     formulation == "log stretch" ? FormulationChoice::log_stretch :
                                                                    FormulationChoice::automatic;
    if (parameters.discretization.mesh == "adaptive")
      numerics.mesh = {parameters.discretization.mesh_tolerance.value_or(1e-6) * L,
                       parameters.discretization.smallest_cell.value_or(1e-6 * L)};

    const bool fixed = parameters.time.step_control == "fixed";
    if (user_cells && (user_tolerance || fixed))
    {
      numerics.n_cells   = *user_cells;
      numerics.tolerance = user_tolerance.value_or(1e-10 * L); // of Newton's method only
      choice.explanation = "cells and time steps as set by the user";
      return choice;
    }

    TimeParameters pilot_time = parameters.time;
    pilot_time.step_control   = "adaptive";
    if (!integrator(pilot_time.integrator).adaptive)
    {
      pilot_time.integrator = "bdf";
      pilot_time.order      = 5;
    }
    pilot_time.petsc_prefix = "pilot_"; // options after "--" are for the real run
    const double scale      = scales.displacement > 0. ? scales.displacement : L;
    pilot_time.max_steps    = std::min(pilot_time.max_steps, most_pilot_steps);

    // Motions far below this are nothing, and their squares underflow.
    const double smallest = 1e-25 * L;
    double tolerance = std::max(1e-3 * scale, smallest), size = 0.;
    unsigned int n_pilots = 0;
    // A cell of this degree resolves a stress whose scale is a quarter of its size.
    const double seen    = std::clamp(std::ceil(0.25 * L / scales.length), 1. * fewest_cells, 0.25 * most_cells);
    unsigned int n_cells = user_cells.value_or(static_cast<unsigned int>(seen));
    SimulationResult pilot;
    bool good = false;
    while (!good && n_pilots < 20)
    {
      Simulation simulation(communicator, scene, pilot_time, {pilot_degree, n_cells, tolerance, 1e-5 * T, scales.time});
      pilot = simulation.run({}, {.ledger = false, .resolution = true});
      ++n_pilots;
      const bool finished = pilot.time.status == "finished";
      size = std::max(finished ? std::abs(pilot.displacement) : 0., displacement_floor * pilot.largest_u);
      const bool resolves = user_cells || pilot.unresolved <= std::max(resolved, accuracy) || n_cells >= most_cells;
      // Too coarse a mesh or step can look like an inversion; if finer ones say the same the real run will name it.
      if (!finished && !user_cells && n_cells < 64)
      {
        n_cells *= 2;
        tolerance *= 0.1;
      }
      else if (finished && !resolves)
        n_cells = std::min(most_cells, 2 * n_cells);
      else if (finished && size > 0. && tolerance > 0.03 * size)
        tolerance = std::max(0.01 * size, 1e-3 * tolerance);
      else
        good = true;
    }
    const bool predicts       = pilot.time.status == "finished";
    const double enough_cells = n_cells; // fewer failed or left too much unresolved
    if (size == 0.)
      size = scale;

    // On smooth solutions `unresolved` goes down as (cell size)^(2q-2), q the pilot's degree, and the error of the
    // displacement at least as fast. Thin layers look resolved before they are: so the rate is measured, with smaller
    // steps whose errors do not hide it, on meshes twice as fine each time until it is at least half of that.
    numerics.n_cells = n_cells;
    if (!user_cells && predicts)
    {
      const double full_rate = 2. * pilot_degree - 2., wanted_part = accuracy / space_factor;
      double unresolved = pilot.unresolved, rate = 0.;
      while (rate < 0.5 * full_rate && 2 * n_cells <= most_cells / 4)
      {
        Simulation simulation(
          communicator, scene, pilot_time, {pilot_degree, 2 * n_cells, 0.01 * tolerance, 1e-5 * T, scales.time});
        const SimulationResult finer = simulation.run({}, {.ledger = false, .resolution = true});
        ++n_pilots;
        if (finer.time.status != "finished" || finer.unresolved == 0.)
          break;
        rate       = std::clamp(std::log2(unresolved / finer.unresolved), 0.5, full_rate);
        unresolved = finer.unresolved;
        n_cells *= 2;
        if (unresolved <= 0.01 * wanted_part)
          break;
      }
      const double cells = rate > 0. ? n_cells * std::pow(unresolved / wanted_part, 1. / rate) : n_cells;
      numerics.n_cells =
        static_cast<unsigned int>(std::clamp(std::ceil(cells), enough_cells, static_cast<double>(most_cells)));
    }
    // The number of steps goes up as tolerance^(-1/(order+1)); error = time_factor * steps * tolerance = accuracy *
    // size.
    const unsigned int nominal = integrator(parameters.time.integrator).order;
    const double r             = 1. / (1. + (nominal > 0 ? nominal : parameters.time.order));
    const double wanted = accuracy * size / (time_factor * std::max(pilot.time.steps, 1u) * std::pow(tolerance, r));
    numerics.tolerance  = user_tolerance.value_or(
      std::max(std::min(std::pow(wanted, 1. / (1. - r)), tolerance), std::max(1e-15 * scale, smallest)));
    if (!user_cells && !user_tolerance && !fixed)
      choice.promised_error = accuracy * size;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    choice.explanation =
      predicts ? fmt::format(
                   "for Accuracy {:g}; from {} pilot runs with up to {} cells in {:.2g} s: displacement about {:.3g}, "
                   "unresolved part of the strain {:.1e}",
                   accuracy,
                   n_pilots,
                   n_cells,
                   seconds,
                   pilot.displacement,
                   std::sqrt(pilot.unresolved))
               : fmt::format("for Accuracy {:g}; the last of {} pilot runs, with {} cells, ended early: {}",
                             accuracy,
                             n_pilots,
                             n_cells,
                             pilot.time.message);
    return choice;
  }
} // namespace crawler
