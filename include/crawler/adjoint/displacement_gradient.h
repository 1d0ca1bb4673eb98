// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/recorded_run.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Scenes in which one number p differs: p - 2d, p - d, p + d, p + 2d. All have_similar_breaks().
  struct Variation
  {
    std::array<const Scene *, 4> scenes;
    double step; ///< d, in units of p
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

  /**
   * The derivative of the displacement by numbers of the scene, by the discrete adjoint of one run
   * (lanes/adjoint_lanes.h; doc/numerics.md, "Sensitivities"): exact for its mesh and steps but for round-off and the
   * differences by which dF/dp is found at the points, of fourth order.
   */
  class DisplacementGradient
  {
  public:
    /// Of a run that is there; it must outlive it.
    explicit DisplacementGradient(const RecordedRun &run);

    /// The derivatives of the displacement [length/unit of p], one sweep for all. There is none where a jump of the
    /// active stress comes in or goes out at the start or the end of the run: the displacement has a kink there. Throws
    /// std::runtime_error if the adjoint cannot be found.
    std::vector<std::optional<double>>
    derivatives(std::span<const Variation> variations);

    /// Of the last derivatives().
    const LocalSensitivity &
    local() const
    {
      return local_;
    }

  private:
    const RecordedRun &run_;
    LocalSensitivity local_;
  };

  /// Do the breaks of another scene, which differs a little, lie near those of a scene? As many in space; in time
  /// several may come together in the scene itself, and some come in or go out at the ends.
  bool
  have_similar_breaks(const Scene &scene, const Scene &other);
} // namespace crawler
