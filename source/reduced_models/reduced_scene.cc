// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/reduced_scene.h>
#include <crawler/scene/strain_extremes.h>

namespace crawler
{
  ReducedScene::ReducedScene(const Scene &scene)
    : units_(natural_units(scene))
    , scene_(in_units(scene, units_))
  {
    if (const auto *wave = dynamic_cast<const OptimalWave *>(scene.active_stress.get()); wave != nullptr)
      wave_ = natural_wave(scene, *wave);
    if (is_prescribed())
      strain_ = scene_.active_stress->prescribed_strain();
    else if (wave_)
      strain_ = &approximate_.emplace(leading_order_strain(*wave_));
    else if (scene_.active_stress->rate_at({0.}) != nullptr)
    {
      const ActiveStress &stiff = approximate_.emplace(stiff_strain(scene_));
      if (!find_jump(stiff, 1., 1.))
        strain_ = &stiff;
    }
  }

  ModelErrors
  ReducedScene::model_errors() const
  {
    if (is_prescribed())
      return {.known = true};
    if (wave_)
      return estimate_model_errors(scene_, *wave_);
    if (strain_ != nullptr)
      return estimate_model_errors(scene_, *strain_);
    return {};
  }
} // namespace crawler
