// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/reduced_models/model_error.h>
#include <crawler/reduced_models/strain.h>
#include <crawler/scene/scene.h>

#include <optional>

namespace crawler
{
  /// Scene as seen by the levels without a mesh, in natural units: which of them fit, and with what strain.
  class ReducedScene
  {
  public:
    /// @p scene is in the user's units and must outlive it.
    explicit ReducedScene(const Scene &scene);
    ReducedScene(const ReducedScene &) = delete;

    const Units &
    units() const
    {
      return units_;
    }
    /// Scene in natural units.
    const Scene &
    scene() const
    {
      return scene_;
    }

    /// Optimal wave; nothing for other active stresses. The perturbation level needs it.
    const std::optional<NaturalWave> &
    wave() const
    {
      return wave_;
    }

    /// Strain of the kinematic level: the prescribed one, that of the optimal wave to leading order, or that of a stiff
    /// body, -m/k. Null if the rate of the active stress is not known, or the stress jumps, so that the level does not
    /// fit.
    const ActiveStress *
    strain() const
    {
      return strain_;
    }

    /// True if that strain is the body's by definition.
    bool
    is_prescribed() const
    {
      return scene_.active_stress->prescribed_strain() != nullptr;
    }

    /// Model errors with the approximate strain.
    ModelErrors
    model_errors() const;

  private:
    const Units units_;
    const Scene scene_;
    std::optional<NaturalWave> wave_;
    std::optional<StressByFunctions> approximate_; ///< if none is prescribed
    const ActiveStress *strain_ = nullptr;
  };
} // namespace crawler
