// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/chart_ring.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace kiln {

namespace {

/// Reach of a lookup, which sees texels whose centres are less than one texel away along each axis.
constexpr float reach_texels = 1.4143f;

/// Returns the weights of the second and third corner at the triangle's point nearest to the one with weights `at` (in
/// its plane).
Eigen::Vector2f clamped(const Eigen::Vector2f& at, const Eigen::Vector2f& ab, const Eigen::Vector2f& ac) {
  if (at.x() >= 0 && at.y() >= 0 && at.sum() <= 1) return at;
  const Eigen::Vector2f point = at.x() * ab + at.y() * ac;
  const std::array<std::array<Eigen::Vector2f, 2>, 3> sides = {{{Eigen::Vector2f(0, 0), Eigen::Vector2f(1, 0)},
                                                                {Eigen::Vector2f(1, 0), Eigen::Vector2f(0, 1)},
                                                                {Eigen::Vector2f(0, 1), Eigen::Vector2f(0, 0)}}};
  Eigen::Vector2f best(0, 0);
  float least = std::numeric_limits<float>::infinity();
  for (const auto& [from, to] : sides) {
    const Eigen::Vector2f start = from.x() * ab + from.y() * ac, along = to.x() * ab + to.y() * ac - start;
    const float squared = along.squaredNorm();
    const float s = squared > 0 ? std::clamp(along.dot(point - start) / squared, 0.0f, 1.0f) : 0.0f;
    const float distance = (start + s * along - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = from + s * (to - from);
    }
  }
  return best;
}

}  // namespace

std::vector<RingTexel> ring_of_charts(const TriangleMesh& atlas, const UvRaster& raster) {
  struct Nearest {
    float distance = reach_texels;
    RingTexel ring;
  };
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> place(raster.texels.size(), none);
  std::vector<Nearest> found;
  const Eigen::Vector2f size(static_cast<float>(raster.width), static_cast<float>(raster.height));
  for (std::uint32_t t = 0; t < atlas.triangles.size(); ++t) {
    std::array<Eigen::Vector2f, 3> corner;
    std::array<Eigen::Vector3f, 3> position;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = atlas.uvs[atlas.triangles[t][k]].cwiseProduct(size);
      position[k] = atlas.positions[atlas.triangles[t][k]];
    }
    const Eigen::Vector2f ab = corner[1] - corner[0], ac = corner[2] - corner[0];
    const float area = ab.x() * ac.y() - ab.y() * ac.x();
    if (!(std::abs(area) > 1e-6f)) continue;
    const Eigen::Vector2f low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]).array() - reach_texels - 0.5f,
                          high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]).array() + reach_texels - 0.5f;
    if (!low.allFinite() || !high.allFinite()) continue;
    const int first_i = static_cast<int>(std::max(0.0f, std::ceil(low.x()))),
              first_j = static_cast<int>(std::max(0.0f, std::ceil(low.y())));
    const int last_i = static_cast<int>(std::min(size.x() - 1, std::floor(high.x()))),
              last_j = static_cast<int>(std::min(size.y() - 1, std::floor(high.y())));
    for (int j = first_j; j <= last_j; ++j)
      for (int i = first_i; i <= last_i; ++i) {
        if (raster.at(i, j).covered()) continue;
        const Eigen::Vector2f from =
            Eigen::Vector2f(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f) - corner[0];
        const Eigen::Vector2f weights((from.x() * ac.y() - from.y() * ac.x()) / area,
                                      (ab.x() * from.y() - ab.y() * from.x()) / area);
        const Eigen::Vector2f nearest = clamped(weights, ab, ac);
        const float distance = (nearest.x() * ab + nearest.y() * ac - from).norm();
        const std::size_t texel =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(raster.width) + static_cast<std::size_t>(i);
        if (!(distance < (place[texel] == none ? reach_texels : found[place[texel]].distance))) continue;
        if (place[texel] == none) {
          place[texel] = static_cast<std::uint32_t>(found.size());
          found.emplace_back();
        }
        const Eigen::Vector3f low_point =
            position[0] + weights.x() * (position[1] - position[0]) + weights.y() * (position[2] - position[0]);
        found[place[texel]] = {distance, {static_cast<std::uint32_t>(texel), {t, nearest.x(), nearest.y()}, low_point}};
      }
  }
  std::vector<RingTexel> ring;
  ring.reserve(found.size());
  for (const Nearest& nearest : found) ring.push_back(nearest.ring);
  std::sort(ring.begin(), ring.end(), [](const RingTexel& a, const RingTexel& b) { return a.texel < b.texel; });
  return ring;
}

}  // namespace kiln
