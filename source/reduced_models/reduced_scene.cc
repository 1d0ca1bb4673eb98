// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/reduced_scene.h>
#include <crawler/scene/strain_extremes.h>

namespace crawler
{
  ReducedScene::ReducedScene(const Scene &physical)
    : units(natural_units(physical))
    , scene(in_units(physical, units))
  {
    if (const auto *optimal = dynamic_cast<const OptimalWave *>(physical.active_stress.get()))
      wave = natural_wave(physical, *optimal);
    if (is_prescribed())
      strain = scene.active_stress->prescribed_strain();
    else if (wave)
      approximate_ = std::make_unique<StressByFunctions>(leading_order_strain(*wave));
    else if (scene.active_stress->rate_at({0.}) != nullptr)
      approximate_ = in_units(*scene.active_stress, Units{.force = -scene.body.elastic_modulus});
    if (approximate_ && (wave || !find_jump(*approximate_, 1., 1.)))
      strain = approximate_.get();
  }

  ModelErrors
  ReducedScene::model_errors() const
  {
    if (is_prescribed())
      return {.known = true};
    if (wave)
      return estimate_model_errors(scene, *wave);
    if (strain != nullptr)
      return estimate_model_errors(scene, *strain);
    return {};
  }
} // namespace crawler
