#pragma once

#include <cstdint>

#include "base/options.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// A picture of an atlas: each chart in a colour of its own with its triangles' edges, what lies within `gutter_texels`
/// of a chart in grey, free room dark. As large as the atlas, or the smallest whole multiple of it that is at least
/// 1024 along its longer side.
Image<std::uint8_t> draw_atlas(const TriangleMesh& atlas, const Extent& size, int gutter_texels);

}  // namespace kiln
