// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/drivers/numerics_choice.h>

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
    constexpr unsigned int fewest_cells = 4, most_cells = 2048;
    /// Error of the displacement in space, relative, is about this times `unresolved` of the mesh.
    constexpr double space_factor = 1.;
    /// Error of the displacement in time is at most this times the tolerance.
    constexpr double time_factor = 10.;
    /// The displacement counts as no smaller than this part of the body's largest deformation.
    constexpr double displacement_floor = 1e-4;

    /// A first idea of the size of the displacement field: of the stiff body, or of the one that is held by friction.
    double
    displacement_scale(const Scene &scene)
    {
      constexpr unsigned int n = 32;
      std::vector<double>    points(n + 1), m(n + 1);
      for (unsigned int i = 0; i <= n; ++i)
        points[i] = scene.body.length * i / n;
      const auto stress  = scene.active_stress->at(points);
      double     largest = 0.;
      for (unsigned int j = 0; j <= n; ++j)
        {
          stress->values(scene.end_time * j / n, m);
          for (const double value : m)
            largest = std::max(largest, std::abs(value));
        }
      const double L = scene.body.length;
      return std::min(largest * L / scene.body.elastic_modulus,
                      largest * scene.end_time / (L * scene.body.friction_coefficient));
    }
  } // namespace

  NumericsChoice
  choose_numerics(MPI_Comm communicator, const Parameters &parameters, const Scene &scene)
  {
    const auto           start = std::chrono::steady_clock::now();
    const double         T = scene.end_time, L = scene.body.length, accuracy = parameters.accuracy;
    const auto          &user_cells = parameters.discretization.n_cells;
    const auto          &user_tolerance = parameters.time.tolerance;
    NumericsChoice       choice;
    Numerics            &numerics = choice.numerics;
    numerics.degree              = parameters.discretization.degree.value_or(automatic_degree);
    numerics.initial_step        = parameters.time.initial_step.value_or(1e-5 * T);
    const unsigned int q         = numerics.degree;

    const bool fixed = parameters.time.step_control == "fixed";
    if (user_cells && (user_tolerance || fixed))
      {
        numerics.n_cells   = *user_cells;
        numerics.tolerance = user_tolerance.value_or(1e-10 * L); // of Newton's method only
        choice.explanation = "cells and time steps as set by the user";
        return choice;
      }

    TimeParameters pilot_time = parameters.time;
    pilot_time.integrator     = "bdf";
    pilot_time.order          = 5;
    pilot_time.step_control   = "adaptive";
    pilot_time.petsc_prefix   = "pilot_"; // options after "--" are for the real run
    double           scale    = displacement_scale(scene);
    if (scale == 0.)
      scale = L;
    double           tolerance = 1e-3 * scale;
    unsigned int     n_cells   = user_cells.value_or(fewest_cells);
    double           size = 0., space_error = 0.;
    SimulationResult pilot;
    unsigned int     n_pilots = 0;
    for (; n_pilots < 20; ++n_pilots)
      {
        Simulation simulation(communicator, scene, pilot_time, {q, n_cells, tolerance, 1e-5 * T});
        pilot = simulation.run({}, {.ledger = false, .resolution = true});
        if (pilot.time.status != "finished")
          {
            // Too coarse a mesh can look like an inversion; a finer one tells. Then the real run will name it.
            if (user_cells || n_cells >= 64)
              break;
            n_cells *= 2;
            continue;
          }
        size = std::max(std::abs(pilot.displacement), displacement_floor * pilot.largest_u);
        if (size > 0. && tolerance > 0.03 * size)
          {
            tolerance = std::max(0.01 * size, 1e-3 * tolerance);
            continue;
          }
        // The error of the displacement decreases as (cell size)^(2q), `unresolved` as (cell size)^(2q-2).
        const double margin = space_factor * pilot.unresolved / accuracy;
        space_error         = space_factor * pilot.unresolved;
        if (user_cells || margin <= 1. || n_cells == most_cells)
          break;
        const double factor = q > 1 ? std::pow(margin, 1. / (2. * q - 2.)) : 4.;
        n_cells = std::min(most_cells, std::max(n_cells + 1, static_cast<unsigned int>(std::ceil(n_cells * std::min(factor, 4.)))));
      }
    numerics.n_cells = n_cells;
    if (size == 0.)
      size = scale;
    numerics.tolerance = user_tolerance.value_or(std::max(accuracy * size / time_factor, 1e-15 * scale));
    choice.pilot_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    choice.explanation =
      fmt::format("for Accuracy {:g}: displacement about {:.3g}, space error predicted below {:.2g}, {} pilot runs",
                  accuracy,
                  pilot.displacement,
                  space_error,
                  n_pilots + 1);
    return choice;
  }
} // namespace crawler
