// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/reduced_models/model_error.h>
#include <crawler/reduced_models/strain.h>
#include <crawler/scene/scene.h>

#include <memory>
#include <optional>

namespace crawler
{
  /// Scene as seen by the levels without a mesh, in natural units: which of them fit, and with what strain.
  class ReducedScene
  {
  public:
    /// @p physical is in the user's units and must outlive it.
    explicit ReducedScene(const Scene &physical);
    ReducedScene(const ReducedScene &) = delete;

    const Units units;
    const Scene scene; ///< in natural units

    /// Optimal wave; nothing for other active stresses. The perturbation level needs it.
    std::optional<NaturalWave> wave;

    /// Strain of the kinematic level: the prescribed one, that of the optimal wave to leading order, or that of a body
    /// so stiff that its elastic force balances the active stress at any time, -m/k. Null if the rate of the active
    /// stress is not known, or the stress jumps, so that the level does not fit.
    const ActiveStress *strain = nullptr;

    /// True if that strain is the body's by definition.
    bool
    is_prescribed() const
    {
      return scene.active_stress->prescribed_strain() != nullptr;
    }

    /// Model errors with the approximate strain.
    ModelErrors
    model_errors() const;

  private:
    std::unique_ptr<const ActiveStress> approximate_; ///< strain, if none is prescribed
  };
} // namespace crawler
