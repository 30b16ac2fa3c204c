// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/files/view_scene.h"

namespace kiln {

ViewScene load_view_scene(const AssetFolders& folders, const LightSettings& light_settings) {
  ViewScene scene{load_asset_forms(folders), {}};
  SceneLights lights = scene_lights(light_settings, scene.forms.main().bands);
  scene.lights = {std::move(lights.specs), std::move(lights.environment), bounding_box(scene.forms.main().mesh)};
  return scene;
}

ViewLimits limits_of(const ViewScene& scene) {
  ViewLimits limits = limits_of(scene.forms);
  limits.has_environment = scene.lights.environment.has_value();
  return limits;
}

}  // namespace kiln
