#pragma once

#include <vector>

#include "asset/prt_asset.h"
#include "base/options.h"
#include "gpu/egl_context.h"
#include "image/image.h"
#include "sh/light_spec.h"

namespace kiln {

/// What kiln-render says of a picture: the renderer, the sizes, the lights, the picture's coverage (0 to 1) and the
/// mean radiance (R, G, B) of what it covers.
Json render_metrics(const PrtAsset& asset, const std::vector<LightSpec>& lights, const Image<float>& radiance,
                    const EglContext& context);

}  // namespace kiln
