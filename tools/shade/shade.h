// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json_fwd.h"
#include "image/image.h"
#include "shade/shade_scene.h"
#include "shade/shade_settings.h"

namespace kiln {

/// Draws a scene without a window: linear radiance times coverage, and coverage. `metrics` is set to how it was made.
/// `threads` is for a software GL renderer. Throws BadInput for faulty shaders, MachineLacks without OpenGL.
Image<float> draw_shade_scene(const ShadeScene& scene, const ShadeSettings& settings, int threads, Json& metrics);

/// Returns the camera that the settings describe.
Camera shade_camera(const ShadeScene& scene, const ShadeSettings& settings);

}  // namespace kiln
