// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/json_fwd.h"
#include "gpu/egl_context.h"
#include "image/image.h"
#include "runtime/draw/scene_renderer.h"
#include "sh/light_spec.h"

namespace kiln {

/// Makes the metrics of a picture: the renderer, the sizes, the lights, the picture's coverage (0 to 1), the mean
/// radiance (R, G, B) of the covered part, and how each asset was drawn and its memory on the GPU.
Json render_metrics(const std::vector<SceneAsset>& assets, const std::vector<LightSpec>& lights,
                    const Image<float>& radiance, const EglContext& context);

}  // namespace kiln
