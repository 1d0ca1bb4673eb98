// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/optimal_wave.h>
#include <crawler/scene/scene.h>
#include <crawler/scene/strain_history.h>

#include <vector>

namespace crawler
{
  /// The optimal wave in natural units (L = T = gamma = 1), where a few numbers are left of it.
  struct NaturalWave
  {
    /// n = 1, 2, ...; those of amplitude 0 are left out.
    struct Harmonic
    {
      double q;    ///< 2 pi n
      double a, b; ///< chi a_n/c and chi b_n/c: the amplitudes of the strain [1]
    };

    double speed;             ///< c T/L: strides until the end, with the sign of c
    double friction_exponent; ///< a
    double stiffness;         ///< k T/(gamma L^2)
    std::vector<Harmonic> harmonics;

    /// The largest n.
    unsigned int
    n_waves() const;
  };

  /// Of a scene in the user's units, whose active stress is @p wave.
  NaturalWave
  natural_wave(const Scene &scene, const OptimalWave &wave);

  /// The strain of the optimal wave to leading order in chi (theory.md, section 3), in natural units:
  /// e = sum a (sin q(s+ct) - sin q s) + b (cos q(s+ct) - cos q s).
  class LeadingOrderStrain : public StrainHistory
  {
  public:
    explicit LeadingOrderStrain(NaturalWave wave)
      : wave_(std::move(wave))
    {
    }

    std::unique_ptr<StrainAtPoints>
    at(const std::vector<double> &points) const override;
    std::optional<FieldBounds>
    bounds(const SpaceTimeBox &box) const override;

  private:
    const NaturalWave wave_;
  };

  /// The strain of a body that is so stiff that its elastic force balances the active stress at any time: e = -m/k.
  class StiffStrain : public StrainHistory
  {
  public:
    /// @p scene must outlive it, and its active stress know its rate.
    explicit StiffStrain(const Scene &scene)
      : scene_(scene)
    {
    }

    std::unique_ptr<StrainAtPoints>
    at(const std::vector<double> &points) const override;
    std::optional<FieldBounds>
    bounds(const SpaceTimeBox &box) const override;

  private:
    const Scene &scene_;
  };
} // namespace crawler
