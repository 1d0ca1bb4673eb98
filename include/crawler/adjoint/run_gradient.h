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
  /// Scenes in which one number p differs by d times -2, -1, 1 and 2, or 1, 2, 3 and 4 to one side. All
  /// have_similar_breaks().
  struct Variation
  {
    std::array<const Scene *, 4> scenes;
    double step;               ///< d, in units of p
    bool is_one_sided = false; ///< where p is at a limit
  };

  /// How a local change of the body changes the displacement: for k(s) (1 + x(s)) it is int density x ds.
  struct LocalSensitivity
  {
    std::vector<double> s;               ///< [length]
    std::vector<double> elastic_modulus; ///< [1]
    std::vector<double> friction;        ///< the same for the friction
    /// Where and when the active stress pushes: dD/dm(s,t) [1/(force time)], [time][point] at the stages of the steps;
    /// empty if there would be too many. For m + x(s,t) the displacement grows by int int stress x ds dt.
    std::vector<double> times; ///< [time]
    std::vector<double> stress;
  };

  /// A stretch of the body in a run: an extreme, say.
  struct StretchPlace
  {
    double s, t;  ///< over length and duration
    double value; ///< which tells the sides of a jump apart
  };

  /// Derivatives by one number; there may be none, see RunGradient.
  using Derivatives = std::array<std::optional<double>, all_quantities.size()>;

  /**
   * Derivatives of the displacement and of the works by numbers of the scene, by the discrete adjoint of one run
   * (lanes/adjoint_lanes.h; doc/numerics.md, "Sensitivities"): exact for its mesh and steps but for round-off and the
   * differences by which dF/dp is found at the points, of fourth order.
   */
  class RunGradient
  {
  public:
    /// Of a run that is there; it must outlive it.
    explicit RunGradient(const RecordedRun &run);

    /// The derivatives [unit of the quantity/unit of p], one sweep for each quantity of a list. There is none of the
    /// others (the speed comes with the stride), none of the last stride if the active stress does not say how long
    /// that is, none where a jump of the active stress comes in or goes out at the start or the end of the run, since
    /// the displacement has a kink there, and none of works where jumps come together in time. The paper's energy has
    /// none with feedback. Throws std::runtime_error if the adjoint cannot be found.
    std::vector<Derivatives>
    derivatives(std::span<const Variation> variations,
                std::span<const Quantity> quantities,
                std::span<const StretchPlace> stretches = {});

    /// Of the last derivatives(): those of the stretches where they were wanted, each on the polynomial of a step,
    /// [variation][stretch]. Where it is an extreme this is the derivative of the extreme, too.
    const std::vector<std::vector<std::optional<double>>> &
    of_stretches() const
    {
      return of_stretches_;
    }

    /// Of the last derivatives(), if they were of the displacement, too.
    const LocalSensitivity &
    local() const
    {
      return local_;
    }

  private:
    const RecordedRun &run_;
    LocalSensitivity local_;
    std::vector<std::vector<std::optional<double>>> of_stretches_;
  };

  /// Do the breaks of another scene, which differs a little, lie near those of a scene? As many in space; in time
  /// several may come together in the scene itself, and some come in or go out at the ends.
  bool
  have_similar_breaks(const Scene &scene, const Scene &other);
} // namespace crawler
