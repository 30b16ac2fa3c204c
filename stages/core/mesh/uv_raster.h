// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface_point.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Triangle that a texel of the atlas lies in, and the place in it.
struct TexelSource {
  static constexpr std::uint32_t none = ~0u;
  std::uint32_t triangle = none;  ///< `none`: the texel's centre lies in no triangle
  float u = 0;                    ///< weight of the triangle's second corner
  float v = 0;                    ///< weight of the third; the first has 1 - u - v

  bool covered() const { return triangle != none; }
};

/// Texel sources of a whole texture: texel (column i, row j from the bottom) is [j * width + i].
struct UvRaster {
  int width = 0;
  int height = 0;
  std::vector<TexelSource> texels;
  std::int64_t covered_texels = 0;
  std::int64_t overlapping_texels = 0;  ///< centres claimed by more than one triangle

  const TexelSource& at(int i, int j) const { return texels[static_cast<std::size_t>(j) * width + i]; }
};

/// Rasterises a mesh with uvs. A texel is covered when its centre ((i+0.5)/W, (j+0.5)/H) lies in a triangle's uv; a
/// centre on an edge shared by two triangles belongs to just one of them (exact integer edge functions on uvs rounded
/// to 1/256 texel or finer, with a top-left rule). A texel claimed by several triangles keeps the first.
UvRaster rasterise_uvs(const TriangleMesh& mesh, int width, int height);

}  // namespace kiln
