// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lights/light_settings.h"
#include "view/files/asset_forms.h"
#include "view/state/view_lights.h"

namespace kiln {

/// All that the viewer reads from files.
struct ViewScene {
  AssetForms forms;
  GivenLights lights;
};

/// Throws BadInput for what kiln-render would not draw either, WrongUsage for lights that are none.
ViewScene load_view_scene(const AssetFolders& folders, const LightSettings& lights);

/// What it allows.
ViewLimits limits_of(const ViewScene& scene);

}  // namespace kiln
