// SPDX-License-Identifier: MIT
#include "mesh/morton_order.h"

#include <algorithm>

#include "mesh/triangle_mesh.h"

namespace kiln {

namespace {

/// Spreads the lowest 21 bits of `value` to every third of 63 bits.
std::uint64_t spread_bits(std::uint64_t value) {
  value = (value | value << 32) & 0x1f00000000ffffull;
  value = (value | value << 16) & 0x1f0000ff0000ffull;
  value = (value | value << 8) & 0x100f00f00f00f00full;
  value = (value | value << 4) & 0x10c30c30c30c30c3ull;
  return (value | value << 2) & 0x1249249249249249ull;
}

}  // namespace

std::vector<MortonPlace> morton_order(std::span<const Eigen::Vector3f> points) {
  std::vector<MortonPlace> places;
  if (points.empty()) return places;
  const BoundingBox box = bounding_box(points);
  constexpr double top = (1 << morton_levels) - 1;
  const double side = box.sides().cast<double>().maxCoeff();
  const double scale = side > 0 ? top / side : 0;
  places.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d place = (p.cast<double>() - box.lowest.cast<double>()) * scale;
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis)
      code |= spread_bits(static_cast<std::uint64_t>(std::clamp(place[axis], 0.0, top))) << axis;
    places.push_back({code, static_cast<std::uint32_t>(places.size())});
  }
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace kiln
