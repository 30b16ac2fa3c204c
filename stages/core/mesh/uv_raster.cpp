// SPDX-License-Identifier: MIT
#include "mesh/uv_raster.h"

#include <algorithm>
#include <cmath>

namespace kiln {

namespace {

// Fixed point of 1/4096 texel. Coordinates of at most 2^18 texels (uvs up to 16 with 2^14 texels a side) stay below
// 2^30 then, and the products of the edge functions below 2^61.
constexpr int subtexel_bits = 12;
constexpr std::int64_t subtexels = std::int64_t{1} << subtexel_bits;
constexpr float largest_texels = 1 << 18;

struct FixedPoint {
  std::int64_t x = 0, y = 0;
};

/// Returns twice the signed area of (a, b, p).
std::int64_t edge_function(const FixedPoint& a, const FixedPoint& b, const FixedPoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Tells whether a centre on the edge from a to b belongs to the triangle at its left: true for exactly one of the
/// edge's two directions, that of left edges (downwards) and top edges (leftwards).
bool owns_edge(const FixedPoint& a, const FixedPoint& b) { return b.y < a.y || (b.y == a.y && b.x < a.x); }

/// Returns the first texel whose centre is at or after a coordinate.
std::int64_t first_centre_from(std::int64_t coordinate) {
  return (coordinate + subtexels / 2 - 1) >> subtexel_bits;  // = ceil((coordinate - half) / one); the shift floors
}

/// Returns the last texel whose centre is at or before a coordinate.
std::int64_t last_centre_to(std::int64_t coordinate) { return (coordinate - subtexels / 2) >> subtexel_bits; }

}  // namespace

UvRaster rasterise_uvs(const TriangleMesh& mesh, int width, int height) {
  UvRaster raster;
  raster.width = width;
  raster.height = height;
  raster.texels.resize(static_cast<std::size_t>(width) * height);
  if (mesh.uvs.size() != mesh.positions.size()) return raster;
  std::vector<bool> overlaps(raster.texels.size(), false);

  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    FixedPoint corner[3];
    bool usable = true;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2f& uv = mesh.uvs[mesh.triangles[t][k]];
      usable = usable && std::abs(uv.x()) * static_cast<float>(width) <= largest_texels &&  // false for NaN
               std::abs(uv.y()) * static_cast<float>(height) <= largest_texels;
      if (!usable) break;
      corner[k] = {std::llround(static_cast<double>(uv.x()) * width * subtexels),
                   std::llround(static_cast<double>(uv.y()) * height * subtexels)};
    }
    if (!usable) continue;

    // A mirrored triangle covers the same texels: reverse it, and its weights with it.
    std::int64_t twice_area = edge_function(corner[0], corner[1], corner[2]);
    if (twice_area == 0) continue;
    const bool mirrored = twice_area < 0;
    if (mirrored) {
      std::swap(corner[1], corner[2]);
      twice_area = -twice_area;
    }

    const auto [lowest_x, highest_x] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [lowest_y, highest_y] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    const std::int64_t first_i = std::max<std::int64_t>(0, first_centre_from(lowest_x));
    const std::int64_t last_i = std::min<std::int64_t>(width - 1, last_centre_to(highest_x));
    const std::int64_t first_j = std::max<std::int64_t>(0, first_centre_from(lowest_y));
    const std::int64_t last_j = std::min<std::int64_t>(height - 1, last_centre_to(highest_y));

    // Least value of each edge function at centres inside.
    std::int64_t least[3];
    for (int k = 0; k < 3; ++k) least[k] = owns_edge(corner[(k + 1) % 3], corner[(k + 2) % 3]) ? 0 : 1;

    for (std::int64_t j = first_j; j <= last_j; ++j)
      for (std::int64_t i = first_i; i <= last_i; ++i) {
        const FixedPoint centre{i * subtexels + subtexels / 2, j * subtexels + subtexels / 2};
        const std::int64_t weight0 = edge_function(corner[1], corner[2], centre);
        const std::int64_t weight1 = edge_function(corner[2], corner[0], centre);
        const std::int64_t weight2 = twice_area - weight0 - weight1;
        if (weight0 < least[0] || weight1 < least[1] || weight2 < least[2]) continue;

        const std::size_t index = static_cast<std::size_t>(j) * width + i;
        TexelSource& texel = raster.texels[index];
        if (texel.covered()) {
          if (!overlaps[index]) ++raster.overlapping_texels;
          overlaps[index] = true;
          continue;
        }
        texel.triangle = static_cast<std::uint32_t>(t);
        texel.u = static_cast<float>(static_cast<double>(mirrored ? weight2 : weight1) / twice_area);
        texel.v = static_cast<float>(static_cast<double>(mirrored ? weight1 : weight2) / twice_area);
        ++raster.covered_texels;
      }
  }
  return raster;
}

}  // namespace kiln
