// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bake/engines/shadow_rays.h"
#include "bake/engines/transfer_engine.h"

namespace kiln {

/// Returns functions by which Embree answers the EGL engine. Rays start `ray_offset` (object units) off the receiver
/// along its normal, as EmbreeEngine's do. The tree is built at the first question and lives as long as any copy of the
/// functions; `scene` lives until then.
ShadowRays make_shadow_rays(const TransferScene& scene, float ray_offset);

}  // namespace kiln
