// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/scene_family.h>

#include <memory>
#include <vector>

namespace crawler
{
  /// Makes the model of gaits of the kinematic level. Throws InputError if the start does not make a scene with a given
  /// strain.
  std::unique_ptr<GaitModel>
  kinematic_gait(SceneFamily &family, const GaitWishes &wishes, const std::vector<double> &start);
} // namespace crawler
