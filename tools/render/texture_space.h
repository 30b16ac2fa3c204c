// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "asset/prt_asset.h"
#include "base/json_fwd.h"
#include "image/image.h"
#include "render/render_settings.h"
#include "runtime/light/scene_lights.h"

namespace kiln {

/// Computes the exit radiance of every texel of an atlas, gutters included, as the runtime does: four channels (linear
/// RGB, and 1), rows from the bottom, of the planes' size. Radiance may be below 0 where truncated harmonics ring.
/// Throws WrongUsage for an asset whose transfer is stored at vertices.
Image<float> relit_atlas(const PrtAsset& asset, const SceneLights& lights, const SurfaceLook& look);

/// Makes the metrics of such a picture.
Json texture_metrics(const PrtAsset& asset, const std::vector<LightSpec>& lights);

}  // namespace kiln
