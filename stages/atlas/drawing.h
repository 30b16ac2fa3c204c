// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/extent.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Draws an atlas: each chart in a colour of its own with its triangles' edges, texels within `gutter_texels` of a
/// chart in grey, free texels dark. The picture is as large as the atlas, or the smallest whole multiple of it that is
/// at least 1024 pixels along its longer side.
Image<std::uint8_t> draw_atlas(const TriangleMesh& atlas, const Extent& size, int gutter_texels);

}  // namespace kiln
