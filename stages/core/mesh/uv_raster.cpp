// SPDX-License-Identifier: MIT
#include "mesh/uv_raster.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

/// Triangle of an atlas in texels, counter-clockwise.
struct TexelTriangle {
  FixedPoint corner[3];
  std::int64_t twice_area = 0;
  bool mirrored = false;  ///< whether its second and third corner were swapped
};

/// Returns a triangle of a mesh; nothing where it has no area or lies too far out.
std::optional<TexelTriangle> texel_triangle(const TriangleMesh& mesh, const Triangle& corners, int width, int height) {
  TexelTriangle triangle;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2f& uv = mesh.uvs[corners[k]];
    const bool usable = std::abs(uv.x()) * static_cast<float>(width) <= largest_texels &&  // false for NaN
                        std::abs(uv.y()) * static_cast<float>(height) <= largest_texels;
    if (!usable) return std::nullopt;
    triangle.corner[k] = {std::llround(static_cast<double>(uv.x()) * width * subtexels),
                          std::llround(static_cast<double>(uv.y()) * height * subtexels)};
  }
  triangle.twice_area = edge_function(triangle.corner[0], triangle.corner[1], triangle.corner[2]);
  if (triangle.twice_area == 0) return std::nullopt;
  // A mirrored triangle covers the same texels: reverse it, and its weights with it.
  triangle.mirrored = triangle.twice_area < 0;
  if (triangle.mirrored) {
    std::swap(triangle.corner[1], triangle.corner[2]);
    triangle.twice_area = -triangle.twice_area;
  }
  return triangle;
}

/// Calls visit(i, j, u, v) for the texels of a picture whose centres lie in a triangle; u and v are the weights of its
/// second and third corner.
template <class Visit>
void for_each_texel(const TexelTriangle& triangle, int width, int height, const Visit& visit) {
  const auto& corner = triangle.corner;
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
      const std::int64_t weight2 = triangle.twice_area - weight0 - weight1;
      if (weight0 < least[0] || weight1 < least[1] || weight2 < least[2]) continue;
      const auto share = [&](std::int64_t weight) {
        return static_cast<float>(static_cast<double>(weight) / static_cast<double>(triangle.twice_area));
      };
      visit(i, j, share(triangle.mirrored ? weight2 : weight1), share(triangle.mirrored ? weight1 : weight2));
    }
}

}  // namespace

UvRaster rasterise_uvs(const TriangleMesh& mesh, int width, int height) {
  UvRaster raster;
  raster.width = width;
  raster.height = height;
  raster.texels.resize(static_cast<std::size_t>(width) * height);
  if (mesh.uvs.size() != mesh.positions.size()) return raster;
  std::vector<bool> overlaps(raster.texels.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::optional<TexelTriangle> triangle = texel_triangle(mesh, mesh.triangles[t], width, height);
    if (!triangle) continue;
    for_each_texel(*triangle, width, height, [&](std::int64_t i, std::int64_t j, float u, float v) {
      const std::size_t index = static_cast<std::size_t>(j) * width + i;
      TexelSource& texel = raster.texels[index];
      if (texel.covered()) {
        if (!overlaps[index]) ++raster.overlapping_texels;
        overlaps[index] = true;
        return;
      }
      texel.triangle = static_cast<std::uint32_t>(t);
      texel.u = u;
      texel.v = v;
      ++raster.covered_texels;
    });
  }
  return raster;
}

}  // namespace kiln
