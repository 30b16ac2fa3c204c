// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lights/light_settings.h"
#include "view/files/asset_forms.h"
#include "view/state/view_lights.h"

namespace kiln {

/// Everything that the viewer reads from files.
struct ViewScene {
  AssetForms forms;
  GivenLights lights;
};

/// Reads a scene. Throws BadInput for folders that kiln-render would not draw either, WrongUsage for invalid lights.
ViewScene load_view_scene(const AssetFolders& folders, const LightSettings& lights);

/// Finds what the scene allows.
ViewLimits limits_of(const ViewScene& scene);

}  // namespace kiln
