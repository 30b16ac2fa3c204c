// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "asset/prt_asset.h"
#include "bake/scene/occluders.h"
#include "bake/scene/receiver_set.h"

namespace kiln {

/// Returns a reflectance as ranges.json has it: in steps of 1 nm, shares rounded to 1e-6.
PrtReflectance shipped_reflectance(const std::string& name, const Spectrum& spectrum);

/// Gives an asset's albedo the measured reflectances of its surface's materials, and for every texel of the planes the
/// number of its own: that of the surface's point nearest to its receiver, elsewhere that of the nearest texel which
/// has one, so that lookups at borders of charts see no other. Throws BadInput for more than most_reflectances.
void add_measured_materials(PrtAlbedo& albedo, const ReceiverSet& receivers, const Occluders& occluders);

}  // namespace kiln
