// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/json_fwd.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "shade/shade_scene.h"
#include "shade/shade_settings.h"

namespace kiln {

/// Draws pictures of a scene without a window, at the times that the settings say, into files of `outputs`. Returns how
/// the first was made, and the times. `threads` is for a software GL renderer. Throws BadInput for faulty shaders and
/// for lights that have no shadow map, MachineLacks without OpenGL.
Json shade_to_files(OutputSet& outputs, const std::string& name, const ShadeScene& scene, const ShadeSettings& settings,
                    int threads, const ProgressFunction& progress);

/// Returns the camera for a scene as it is now; `camera` is film_camera's.
Camera shade_camera(MovingScene& scene, const CameraSettings& camera, int width, int height);

}  // namespace kiln
