// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bake/egl/shadow_settings.h"
#include "bake/engines/transfer_engine.h"

namespace kiln {

/// Embree behind what the EGL engine asks of a ray library. Rays start `ray_offset` off the receiver along its normal,
/// a fraction of the occluders' bounding box diagonal, as EmbreeEngine's do. The scene is built when first asked, and
/// lives as long as any copy of the functions; `scene` must do so until then.
ShadowRays make_shadow_rays(const TransferScene& scene, float ray_offset);

}  // namespace kiln
