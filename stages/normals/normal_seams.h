// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "maps/normal_space.h"
#include "maps/seams.h"

namespace kiln {

/// Equalises a map of unit vectors in `space` on both sides of seams, and normalises it. `covered` has one entry per
/// texel.
void equalise_normals(Image<float>& map, const Seams& seams, const std::vector<std::uint8_t>& covered,
                      NormalSpace space);

}  // namespace kiln
