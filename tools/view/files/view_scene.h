// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lights/light_settings.h"
#include "render/lamps.h"
#include "view/files/asset_forms.h"
#include "view/state/view_lights.h"

namespace kiln {

/// Everything that the viewer reads from files.
struct ViewScene {
  AssetForms forms;
  GivenLights lights;
  LampSettings lamps;  ///< with lights.lamps
};

/// Reads a scene; `lamps` are those to choose among. Throws BadInput for folders that kiln-render would not draw
/// either, WrongUsage for invalid lights and lamps.
ViewScene load_view_scene(const AssetFolders& folders, const LightSettings& lights, const LampSettings& lamps = {});

/// Lists the forms that there are, in the order of LampScene::assets.
std::vector<const PrtAsset*> assets_of(const AssetForms& forms);

/// Finds what the scene allows.
ViewLimits limits_of(const ViewScene& scene);

}  // namespace kiln
