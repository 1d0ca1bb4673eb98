// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/equation/general_laws.h>
#include <crawler/scene/scene.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace crawler
{
  /**
   * Stretch after the active stress starts or jumps suddenly, or a body starts that is not in balance. From the ends of
   * the body, and from the jumps in space, layers grow like sqrt(D t) with D = k/(gamma w^a): at first they are thinner
   * than the cells, and the polynomials there overshoot by some per cent of the jump, on any mesh. In a layer the
   * stretch lies between its earlier value and that set by the conditions at the ends and jumps; so as long as layers
   * are thin, the extremes are those of the ends, 1 - m/k, which are known (doc/numerics.md, "Extremes after sudden
   * changes").
   */
  class SuddenChanges
  {
  public:
    /// Part of the duration up to which layers are thin at most.
    static constexpr double longest = 1e-3;

    /// False with feedback, unless it is by the stretch at the same point and time alone, and has no jumps in space.
    static bool
    are_known(const Scene &scene);

    /// @p scene is in the @p units of the user and must outlive this; @p smallest_cell in natural units.
    SuddenChanges(const Scene &scene, const Units &units, double smallest_cell);

    /// Smallest and largest stretch at the ends, if layers are thin at time @p t (in natural units, not before that of
    /// the last call).
    std::optional<std::pair<Extreme, Extreme>>
    extremes_if_thin(double t);

    /// True if layers of the start are thin at time @p t, as above, and no jump of the stress in space is so large that
    /// the stretch, between its initial value and that plus or minus the jump over k, could be lost inside.
    bool
    keeps_stretch_inside(double t);

    /// Stretch that the end conditions set at @p s, if that is an end of the body and known.
    std::optional<double>
    stretch_at_end(double s, double t);

  private:
    /// Stretch that balances the stress, 1 - m/k without feedback, at the ends and both sides of the breaks in space,
    /// in pairs.
    std::vector<double>
    balanced_at(double t);
    void
    look_at_next_start();

    const Units units_;
    const double cell_, a_, k_;           ///< in natural units
    std::vector<double> starts_, moduli_; ///< times when the stress may jump; k where the stress is
    std::size_t next_   = 0;              ///< index of the next start
    double thin_until_  = 0.;
    bool keeps_stretch_ = false;                   ///< no jump in space of the last start can invert the body
    std::vector<double> initial_;                  ///< stretch at the start there
    std::unique_ptr<ActiveStressAtPoints> stress_; ///< stress there; nothing if stretches are not known
    std::optional<EndStretches> ends_;             ///< with feedback
  };
} // namespace crawler
