// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/drivers/error_estimate.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace crawler
{
  namespace
  {
    // Calibrated by tests/verification/calibration.cc.
    constexpr double measured_factor = 1.1, promised_part = 0.2, factor_without_promise = 2.;
    /// The finer run: cells and tolerances relative to the run's.
    constexpr double more_cells = 1.1, finer_tolerance = 0.1, finer_mesh_tolerance = 0.1;
    /// The same if the run is not by radau 9, which is more accurate for the same tolerance than all others.
    constexpr double finer_tolerance_than_others = 0.5;
    /// For the next try.
    constexpr double refined_cells = 1.2, refined_tolerance = 0.1;
    constexpr const char *best_integrator = "radau 9";
    /// No displacement is more accurate than this part of the body length.
    constexpr double round_off = 1e-15;

    Numerics
    finer(const Numerics &numerics, const std::string &integrator)
    {
      Numerics n = numerics;
      if (n.mesh.tolerance > 0.)
        n.mesh.tolerance *= finer_mesh_tolerance;
      else
        n.n_cells = static_cast<unsigned int>(std::ceil(more_cells * n.n_cells));
      n.tolerance *= integrator == best_integrator ? finer_tolerance : finer_tolerance_than_others;
      n.integrator = best_integrator;
      if (integrator == "bdf" || integrator == "") // which starts with tiny steps
        n.initial_step = std::max(n.initial_step, n.tolerance);
      return n;
    }
  } // namespace

  ErrorEstimate
  estimate_error(MPI_Comm communicator,
                 const Scene &scene,
                 const TimeParameters &time,
                 const NumericsChoice &choice,
                 const SimulationResult &result,
                 const std::function<bool()> &keep_going)
  {
    ErrorEstimate estimate;
    if (result.time.status != "finished")
      return estimate;
    const auto start   = std::chrono::steady_clock::now();
    const double least = round_off * scene.body.length;
    double total       = choice.promised_error;
    if (!choice.is_collapse)
    {
      const std::string integrator = time.integrator == "automatic" ? choice.numerics.integrator : time.integrator;
      TimeParameters second        = time;
      second.integrator            = "automatic";
      second.engine                = "automatic";
      second.step_control          = "adaptive";
      second.petsc_prefix          = "second_"; // options after "--" are for the run itself
      Simulation simulation(communicator, scene, second, finer(choice.numerics, integrator));
      const SimulationResult better = simulation.run({}, {}, {}, keep_going);
      const double x = better.time.status == "finished" ? std::abs(better.displacement - result.displacement)
                                                        : DisplacementError::unknown;
      total = std::isfinite(choice.promised_error) ? measured_factor * x + promised_part * choice.promised_error
                                                   : factor_without_promise * x;
    }
    if (std::isfinite(total))
    {
      DisplacementError &error = estimate.error;
      error.total              = std::max(total, least);
      error.space              = choice.space_share * error.total;
      error.time               = error.total - error.space;
      error.model              = 0.;
    }
    estimate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return estimate;
  }

  NumericsChoice
  refined(const NumericsChoice &choice)
  {
    NumericsChoice next = choice;
    Numerics &n         = next.numerics;
    if (n.mesh.tolerance > 0.)
      n.mesh.tolerance *= refined_tolerance;
    else
      n.n_cells = static_cast<unsigned int>(std::ceil(refined_cells * n.n_cells));
    n.tolerance *= refined_tolerance;
    return next;
  }
} // namespace crawler
