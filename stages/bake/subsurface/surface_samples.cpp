// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/subsurface/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kiln {

namespace {

constexpr float least_cosine = 0.25f;
constexpr int neighbourhood = 2;  // texels around an uncovered one that are searched for a covered one

/// Convex polygon of at most seven corners: a triangle cut by a square's four sides.
struct Polygon {
  std::array<Eigen::Vector2d, 8> corners;
  int size = 0;

  Polygon() { corners.fill(Eigen::Vector2d::Zero()); }

  void add(const Eigen::Vector2d& corner) { corners[size++] = corner; }

  double twice_area() const {
    double sum = 0;
    for (int k = 0; k < size; ++k) {
      const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % size];
      sum += a.x() * b.y() - a.y() * b.x();
    }
    return sum;
  }

  Eigen::Vector2d mean() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int k = 0; k < size; ++k) sum += corners[k];
    return sum / size;
  }
};

/// Cuts a polygon to the side where sign * (coordinate - bound) >= 0 [Sutherland 1974].
Polygon clip(const Polygon& polygon, int axis, double bound, double sign) {
  Polygon kept;
  for (int k = 0; k < polygon.size; ++k) {
    const Eigen::Vector2d &a = polygon.corners[k], &b = polygon.corners[(k + 1) % polygon.size];
    const double at_a = sign * (a[axis] - bound), at_b = sign * (b[axis] - bound);
    if (at_a >= 0) kept.add(a);
    if ((at_a < 0) != (at_b < 0)) kept.add(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return kept;
}

Polygon clip_to_texel(Polygon polygon, int i, int j) {
  polygon = clip(polygon, 0, i, 1);
  polygon = clip(polygon, 0, i + 1, -1);
  polygon = clip(polygon, 1, j, 1);
  return clip(polygon, 1, j + 1, -1);
}

/// Map from texels to receivers.
class ReceiverMap {
 public:
  static constexpr std::uint32_t none = ~0u;

  explicit ReceiverMap(const ReceiverSet& receivers)
      : receivers_(receivers), map_(static_cast<std::size_t>(receivers.width) * receivers.height, none) {
    for (std::uint32_t r = 0; r < receivers.slots.size(); ++r) map_[receivers.slots[r]] = r;
  }

  std::uint32_t at(int i, int j) const {
    const bool inside = i >= 0 && j >= 0 && i < receivers_.width && j < receivers_.height;
    return inside ? map_[static_cast<std::size_t>(j) * receivers_.width + i] : none;
  }

  /// Returns the receiver nearest to `point` in the texels around, or `none`.
  std::uint32_t nearest(int i, int j, const Eigen::Vector3d& point) const {
    std::uint32_t best = none;
    double least = std::numeric_limits<double>::infinity();
    for (int b = j - neighbourhood; b <= j + neighbourhood; ++b)
      for (int a = i - neighbourhood; a <= i + neighbourhood; ++a) {
        const std::uint32_t r = at(a, b);
        if (r == none) continue;
        const double distance = (receivers_.positions[r].cast<double>() - point).squaredNorm();
        if (distance < least) {
          least = distance;
          best = r;
        }
      }
    return best;
  }

 private:
  const ReceiverSet& receivers_;
  std::vector<std::uint32_t> map_;
};

}  // namespace

std::vector<float> texel_areas(const TriangleMesh& atlas, const ReceiverSet& receivers) {
  const ReceiverMap map(receivers);
  std::vector<double> areas(receivers.slots.size(), 0);
  for (const Triangle& t : atlas.triangles) {
    // Step 1: map the triangle to texels, and find how much surface a square texel of it is.
    Polygon triangle;
    for (std::uint32_t vertex : t)
      triangle.add({static_cast<double>(atlas.uvs[vertex].x()) * receivers.width,
                    static_cast<double>(atlas.uvs[vertex].y()) * receivers.height});
    const double twice_texels = triangle.twice_area();
    const Eigen::Vector3d cross = area_normal(atlas, t);
    if (!(std::abs(twice_texels) > 0) || !(cross.norm() > 0)) continue;
    const double area_per_texel = cross.norm() / std::abs(twice_texels);
    const Eigen::Vector3d normal = cross.normalized();
    Eigen::Matrix2d sides;
    sides << triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0];
    const Eigen::Matrix2d weights_of = sides.inverse();

    // Step 2: add its part of every texel that it touches.
    Eigen::Vector2d lowest = triangle.corners[0], highest = lowest;
    for (int k = 1; k < 3; ++k) {
      lowest = lowest.cwiseMin(triangle.corners[k]);
      highest = highest.cwiseMax(triangle.corners[k]);
    }
    const auto first = [](double at) { return std::max(0, static_cast<int>(std::floor(at))); };
    for (int j = first(lowest.y()); j < receivers.height && j < highest.y(); ++j)
      for (int i = first(lowest.x()); i < receivers.width && i < highest.x(); ++i) {
        const Polygon part = clip_to_texel(triangle, i, j);
        const double area = 0.5 * std::abs(part.twice_area()) * area_per_texel;
        if (!(area > 0)) continue;
        std::uint32_t r = map.at(i, j);
        if (r == ReceiverMap::none) {
          const Eigen::Vector2d weights = weights_of * (part.mean() - triangle.corners[0]);
          const Eigen::Vector3f point = static_cast<float>(1 - weights.sum()) * atlas.positions[t[0]] +
                                        static_cast<float>(weights.x()) * atlas.positions[t[1]] +
                                        static_cast<float>(weights.y()) * atlas.positions[t[2]];
          r = map.nearest(i, j, point.cast<double>());
          if (r == ReceiverMap::none) continue;
        }
        areas[r] += area / std::max<double>(least_cosine, normal.dot(receivers.normals[r].cast<double>()));
      }
  }
  return {areas.begin(), areas.end()};
}

std::vector<float> vertex_areas(const TriangleMesh& mesh, const ReceiverSet& receivers) {
  std::vector<double> of_vertex(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (std::uint32_t vertex : t) of_vertex[vertex] += area_normal(mesh, t).norm() / 6;
  std::vector<float> areas;
  areas.reserve(receivers.slots.size());
  for (std::uint32_t vertex : receivers.slots) areas.push_back(static_cast<float>(of_vertex[vertex]));
  return areas;
}

}  // namespace kiln
