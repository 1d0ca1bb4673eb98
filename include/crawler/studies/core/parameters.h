// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/run_parameters.h>
#include <crawler/scene/unit_names.h>

#include <optional>
#include <string>

namespace crawler
{
  /// Syntax of Sweep/Axes, in words.
  inline const std::string sweep_syntax = "\"Section/Entry : VALUES\", several of them separated by semicolons";

  /// Syntax of Optimize/Variables and Fit/Variables, in words.
  inline const std::string variables_syntax = "\"Section/Entry : FROM to TO\", several of them separated by semicolons";

  /// Section "Sweep": which scenes `crawler sweep` computes (sweep_design.h reads the axes).
  struct SweepParameters
  {
    static constexpr unsigned int max_points = 10000000;

    std::string design      = "grid";
    std::string axes        = "";
    unsigned int n_points   = 100; ///< points of a random or Latin hypercube design
    unsigned int seed       = 1;
    std::string keep_fields = "";
    bool cross_check        = false;
    double refinement       = 10.;          ///< refinement of the cross-check
    std::optional<double> point_time_limit; ///< [s]
    std::optional<double> time_limit;       ///< [s]

    void
    add_parameters(Declarations &declarations);
  };

  /// Section "Tradeoff": the settings that `crawler tradeoff` tries, as lists (tradeoff_settings.h reads them).
  struct TradeoffParameters
  {
    std::string models          = "perturbation, kinematic, nonlinear";
    std::string formulations    = "position, stretch";
    std::string meshes          = "uniform, adaptive";
    std::string engines         = "fused, petsc, batch";
    std::string integrators     = "radau 5, radau 9, bdf";
    std::string degrees         = "2, 4, 6, 8";
    std::string cells           = "2, 4, 8, 16, 32";
    std::string mesh_tolerances = "logspace(-2, -8, 4)";
    std::string tolerances      = "logspace(-2, -10, 5)";
    unsigned int repetitions    = 3;
    double run_time_limit       = 10.;   ///< [s]
    double time_limit           = 3600.; ///< limit of all runs together [s]

    void
    add_parameters(Declarations &declarations);
  };

  /// Section "Optimize": the gait that `crawler optimize` looks for (scene_numbers.h reads the variables).
  struct OptimizeParameters
  {
    std::string objective = "displacement";
    std::string direction = "forward";
    std::string variables = "";
    std::optional<double> work, positive_work, dissipation, smallest_strain, largest_strain, mean_square_strain,
      largest_stress, largest_stress_rate;
    unsigned int n_starts = 1, seed = 1;
    double spread               = 0.2; ///< spread of the starts, in ranges of the variables
    double tolerance            = 1e-6;
    unsigned int max_iterations = 50;
    std::optional<double> time_limit; ///< [s]

    void
    add_parameters(Declarations &declarations);
  };

  /// Section "Fit": unknowns of `crawler fit` in measured data (contrib/python/crawler/fitting; scene_numbers.h reads
  /// the variables).
  struct FitParameters
  {
    std::string data = "", variables = "", markers_at = "first", origin = "unknown", deviation = "automatic";
    std::optional<double> first_time;      ///< [time]
    std::optional<double> place_deviation; ///< [length]
    unsigned int n_starts = 1, seed = 1;

    void
    add_parameters(Declarations &declarations);
  };

  /// Sections of the parameter file: those of one run, and those of each study of many runs.
  struct Parameters : RunParameters
  {
    SweepParameters sweep;
    TradeoffParameters tradeoff;
    OptimizeParameters optimize;
    FitParameters fit;
    UnitNames units;

    /// Returns the same with mesh and time steps that the program chooses.
    Parameters
    with_free_numerics() const
    {
      Parameters free     = *this;
      free.discretization = {};
      free.time           = {};
      free.time.end_time  = time.end_time;
      free.time.max_steps = time.max_steps;
      return free;
    }

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
