// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/options.h"
#include "gpu/egl_context.h"
#include "image/image.h"
#include "runtime/draw/scene_renderer.h"
#include "sh/light_spec.h"

namespace kiln {

/// What kiln-render says of a picture: the renderer, the sizes, the lights, the picture's coverage (0 to 1), the mean
/// radiance (R, G, B) of what it covers, and of every asset how it was drawn and what it takes on the GPU.
Json render_metrics(const std::vector<SceneAsset>& assets, const std::vector<LightSpec>& lights,
                    const Image<float>& radiance, const EglContext& context);

}  // namespace kiln
