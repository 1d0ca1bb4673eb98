// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <optional>

namespace crawler
{
  class ActiveStress;
  struct Scene;

  /// An active stress that may jump at places that move along the body, and knows how.
  class MovingJumps
  {
  public:
    virtual ~MovingJumps() = default;

    /// The same stress with smooth fronts in the place of these jumps, @p part (above 0, at most 1) as wide as the
    /// widest that fit; null if there are no such jumps.
    virtual std::unique_ptr<const ActiveStress>
    with_fronts(double part) const = 0;
  };

  /// The same problem with such fronts; nothing if the active stress does not know of moving jumps.
  std::optional<Scene>
  with_fronts(const Scene &scene, double part);
} // namespace crawler
