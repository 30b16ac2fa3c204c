#pragma once

#include <cstdint>
#include <vector>

#include "mesh/uv_raster.h"
#include "normals/texel_match.h"

namespace kiln {

/// Where parts of the high mesh intersect, a point of the low mesh beside the line is as close to the one as to the
/// other. Gives such texels the point of the part that most texels of their part of the low mesh stand for, if it has
/// one that faces as they do no farther than `farthest` (object units) away. `triangles` has the high triangle of every
/// covered texel's point; both are changed together. Parts hang together by vertices, those of the low mesh also by
/// places.
void keep_to_own_parts(const HighSurface& high, const TriangleMesh& atlas, const UvRaster& raster, float farthest,
                       TexelMatches& matches, std::vector<std::uint32_t>& triangles);

}  // namespace kiln
