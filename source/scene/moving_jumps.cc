// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/moving_jumps.h>
#include <crawler/scene/scene.h>

namespace crawler
{
  std::optional<Scene>
  with_fronts(const Scene &scene, const double part)
  {
    const auto *const jumping = dynamic_cast<const MovingJumps *>(scene.active_stress.get());
    auto smooth               = jumping != nullptr ? jumping->with_fronts(part) : nullptr;
    if (!smooth)
      return std::nullopt;
    return Scene{
      scene.body, scene.friction->scaled(1.), std::move(smooth), scene.end_time, scene.profiles, scene.ground};
  }
} // namespace crawler
