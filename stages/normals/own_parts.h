// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/uv_raster.h"
#include "normals/texel_match.h"

namespace kiln {

/// Resolves texels where parts of the high mesh intersect: a point of the low mesh beside the intersection is equally
/// close to both parts. Such a texel gets the point of the high part that most texels of its low part stand for, if
/// that part has a point no farther than `farthest` (object units) that faces the same way. `triangles` has the high
/// triangle of every covered texel's point; both are changed together. Parts are connected by vertices; those of the
/// low mesh also by positions; none reaches beyond a part of the matcher's plan.
void keep_to_own_parts(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster, float farthest,
                       TexelMatches& matches, std::vector<std::uint32_t>& triangles);

}  // namespace kiln
