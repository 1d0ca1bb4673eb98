// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/scene_family.h>

#include <functional>
#include <memory>
#include <vector>

namespace crawler
{
  /// Makes the model of gaits of the kinematic level. Throws InputError if the start does not make a scene with a given
  /// strain.
  std::unique_ptr<GaitModel>
  kinematic_gait(SceneFamily &family, const GaitWishes &wishes, const std::vector<double> &start);

  /// Makes the model of gaits of the levels that are simulated. @p interrupted is called after every step. Throws
  /// InputError for a wish that only the kinematic level fulfils.
  std::unique_ptr<GaitModel>
  simulated_gait(SceneFamily &family, const GaitWishes &wishes, std::function<bool()> interrupted);
} // namespace crawler
