// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>
#include <crawler/accuracy/stress_scales.h>

#include <optional>

namespace crawler
{
  namespace mesh_choice
  {
    /// Smallest error that may be wanted, as a part of the length: round-off.
    inline constexpr double min_error = 3e-15;
    /// First step, relative to the duration, of methods that start with order 1.
    inline constexpr double multistep_start = 1e-5;
  } // namespace mesh_choice

  /// True if the user's settings leave the form open, and the stretch form can compute the scene.
  bool
  may_be_stretch_form(const Problem &problem);

  /// Exception for a stop that was requested during the pilots.
  struct PilotsInterrupted
  {
  };

  /// Exception for a pilot of many steps whose cycles should repeat and do not.
  struct PilotsUnsettled
  {
  };

  /// Problem with its pilot runs, coarse and with loose tolerances, and what the last one that counts has measured.
  struct Pilots : Problem
  {
    explicit Pilots(const Problem &problem);

    /// Runs the scene (collective). Throws PilotsInterrupted, and PilotsUnsettled if it must settle.
    SimulationResult
    run(const Numerics &numerics, ResolutionWish resolution);

    /// Runs the scene with these cells, this part of the present tolerance and the automatic first step; other settings
    /// are those of @p numerics.
    SimulationResult
    run(Numerics numerics, unsigned int degree, unsigned int n_cells, ResolutionWish resolution, double part = 1.);

    /// Lets a run count: measures the size of the displacement, to which Accuracy is relative.
    void
    count(const SimulationResult &result);

    bool
    finished() const
    {
      return last.time.status == Status::finished;
    }

    /// Number of steps of the last pilot to the end, whether it went there or its cycles were extrapolated.
    double
    steps_to_the_end() const;

    /// Stiffness k T/(g L^2) for the largest friction g of the last pilot, which determines thin layers.
    double
    stiffness_over_friction() const;

    /// True if the body is so soft that its thin layers are for the stretch form. Steep friction makes them thinner.
    bool
    is_soft() const;

    /// True if the user's settings leave the form open and the last pilot came near an emptied state.
    bool
    is_for_stretch() const;

    /// Smallest size of a displacement whose wanted error is round-off.
    double
    min_size() const;

    /// Displacements below this count as zero: their squares underflow.
    double
    negligible_displacement() const
    {
      return 1e-25 * scene.body.length;
    }

    /// The automatic size of the first step.
    double
    first_step(const Numerics &numerics) const;

    const StressScales scales;
    TimeParameters time;
    std::optional<CycleWish> cycles;
    SimulationResult last = {};  ///< last run that counts
    const double scale;          ///< expected size of the displacement, from the members above [length]
    double tolerance;            ///< of the next pilot in time [length]
    double size         = 0.;    ///< size of its displacement; 0 if that is not known [length]
    unsigned int n      = 0;     ///< number of runs
    bool must_settle    = false; ///< pilots must end early, as their cycles repeat
    bool inverts_at_end = false; ///< an end inverts at the same time in the last two
  };
} // namespace crawler
