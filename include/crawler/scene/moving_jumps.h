// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <optional>

namespace crawler
{
  class ActiveStress;
  struct Scene;

  /// An active stress that may have jumps which move along the body, and knows them.
  class MovingJumps
  {
  public:
    virtual ~MovingJumps() = default;

    /// The stress with smooth fronts in place of these jumps, @p part (above 0, at most 1) as wide as the widest that
    /// fit; null if there are no such jumps.
    virtual std::unique_ptr<const ActiveStress>
    with_fronts(double part) const = 0;
  };

  /// The scene with these fronts; nothing if the active stress knows no moving jumps.
  std::optional<Scene>
  with_fronts(const Scene &scene, double part);
} // namespace crawler
