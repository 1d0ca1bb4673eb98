// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/recorded_run.h>
#include <crawler/adjoint/works.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Four scenes in which one number p differs by d times -2, -1, 1 and 2, or 1, 2, 3 and 4 to one side. All
  /// have_similar_breaks().
  struct Variation
  {
    std::span<const Scene> scenes;
    double step;               ///< d, in units of p
    bool is_one_sided = false; ///< true where p is at a limit
  };

  /// Sensitivity of the displacement to a local change of the body: for k(s) (1 + x(s)) it is int density x ds.
  struct LocalSensitivity
  {
    std::vector<double> s;               ///< [length]
    std::vector<double> elastic_modulus; ///< [1]
    std::vector<double> friction;        ///< sensitivity to the friction
    /// Times and places at which the active stress pushes: dD/dm(s,t) [1/(force time)], [time][point] at the stages of
    /// the steps; empty if there would be too many. For m + x(s,t) the displacement grows by int int stress x ds dt.
    std::vector<double> times; ///< [time]
    std::vector<double> stress;
  };

  /// Place of a stretch of the body in a run: of an extreme, say.
  struct StretchPlace
  {
    double s, t;  ///< over length and duration
    double value; ///< tells the sides of a jump apart
  };

  /// Derivatives by one number; some may be missing, see gradient_of().
  using Derivatives = std::array<std::optional<double>, all_quantities.size()>;

  /// Derivatives of a run by some numbers, and what comes with them.
  struct RunGradient
  {
    std::vector<Derivatives> quantities; ///< [variation]
    /// [variation][stretch], each on the polynomial of a step. At an extreme this is the derivative of the extreme,
    /// too.
    std::vector<std::vector<std::optional<double>>> stretches;
    LocalSensitivity local; ///< of the displacement, if that was requested
  };

  /**
   * Derivatives of the displacement and of the works by numbers of the scene, by the discrete adjoint of one run
   * (lanes/adjoint_sweep.h; doc/numerics.md, "Sensitivities"): exact for its mesh and steps but for round-off and the
   * differences by which dF/dp is found at the points, of fourth order.
   *
   * They are in [unit of the quantity/unit of p], with one sweep for each quantity of a list (the speed comes with the
   * stride). Missing are those of other quantities; of the last stride if the active stress does not declare its
   * length; those where a jump of the active stress enters or leaves at the start or the end of the run, since the
   * displacement has a kink there; of works where jumps come together in time; and of the paper's energy with feedback.
   * Throws std::runtime_error if the adjoint cannot be found.
   */
  RunGradient
  gradient_of(const RecordedRun &run,
              std::span<const Variation> variations,
              std::span<const Quantity> quantities,
              std::span<const StretchPlace> stretches = {});

  /// True if the breaks of another scene, which differs a little, lie near those of a scene: as many in space; in time
  /// several may come together in the scene itself, and some may enter or leave at the ends.
  bool
  have_similar_breaks(const Scene &scene, const Scene &other);
} // namespace crawler
