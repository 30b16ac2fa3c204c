// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "raycast/ray_scene.h"
#include "sh/light_spec.h"
#include "sh/transfer.h"

namespace kiln {

/// Tells whether a light has two bands at most, so that spherical harmonics hold all of it: ambient ones and
/// hemispheres.
bool has_few_bands(const LightSpec& light);

/// Returns the radiance that white receivers send out under a light itself, not cut to bands, that reaches them
/// directly: by rays to places of the cap of sky that it fills, one for a directional light, `places` for others, which
/// turn from receiver to receiver. `first` numbers the receivers. The light has more than a few bands.
std::vector<Eigen::Vector3f> direct_radiance(const RayScene& scene, const Receivers& receivers, const LightSpec& light,
                                             float ray_offset, std::uint64_t first, int places = 16);

}  // namespace kiln
