// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/texel_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace kiln {

namespace {

// Vectors of four lanes: an extension of both compilers, for which every machine has instructions.
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));  ///< of a comparison: -1 or 0

template <class Lanes, class Value>
Lanes load(const Value* values) {
  Lanes lanes;
  std::memcpy(&lanes, values, sizeof lanes);
  return lanes;
}

template <class Lanes, class Value>
void store(Value* values, const Lanes& lanes) {
  std::memcpy(values, &lanes, sizeof lanes);
}

struct Vectors {
  Floats x, y, z;

  Vectors(Floats vx, Floats vy, Floats vz) : x(vx), y(vy), z(vz) {}
  Vectors(const TexelPoints::Components& values, int first)
      : x(load<Floats>(&values(first, 0))), y(load<Floats>(&values(first, 1))), z(load<Floats>(&values(first, 2))) {}

  friend Vectors operator-(const Eigen::Vector3f& a, const Vectors& b) {
    return {a.x() - b.x, a.y() - b.y, a.z() - b.z};
  }
  Floats dot(const Vectors& v) const { return x * v.x + y * v.y + z * v.z; }
  Vectors cross(const Vectors& v) const { return {y * v.z - z * v.y, z * v.x - x * v.z, x * v.y - y * v.x}; }
};

}  // namespace

TexelSamples::TexelSamples(const TriangleMesh& high, const SurfaceWalk& walk, const PointMatcher& matcher, int samples)
    : high_(high), walk_(walk), matcher_(matcher), samples_(samples) {}

void TexelSamples::start(std::uint32_t triangle, float reach) {
  triangle_ = triangle;
  reach_ = reach;
  pending_.fill(0);
  found_.present.fill(0);
  found_.count = 0;
  found_.vectors.setZero();
}

void TexelSamples::add(int sample, const TexelSource& source) {
  if (source.triangle != low_triangle_) {
    low_triangle_ = source.triangle;
    const TriangleMesh& atlas = matcher_.atlas();
    const Triangle& t = atlas.triangles[low_triangle_];
    low_positions_ = Corners(atlas.positions[t[0]], atlas.positions[t[1]], atlas.positions[t[2]]);
    const std::array<Eigen::Vector3f, 3> lines = matcher_.lines(low_triangle_);
    low_lines_ = Corners(lines[0], lines[1], lines[2]);
  }
  points_.row(sample) = low_positions_.at(source.u, source.v);
  directions_.row(sample) = low_lines_.at(source.u, source.v);
  sources_[static_cast<std::size_t>(sample)] = source;
  pending_[static_cast<std::size_t>(sample)] = -1;
  found_.present[static_cast<std::size_t>(sample)] = 1;
  ++found_.count;
}

const TexelPoints& TexelSamples::finish() {
  if (found_.count == 0) return found_;
  normalise(directions_);
  if (triangle_ != SurfacePoint::none) try_triangle(triangle_);
  for (int sample = 0; sample < samples_; ++sample) {
    if (pending_[static_cast<std::size_t>(sample)] == 0) continue;
    find(sample);
    try_triangle(triangle_);
  }
  normalise(found_.vectors);
  return found_;
}

/// Tries a triangle for all pending samples, four at a time, as SurfaceWalk::meet does.
void TexelSamples::try_triangle(std::uint32_t triangle) {
  const Triangle& t = high_.triangles[triangle];
  const Eigen::Vector3f p0 = high_.positions[t[0]], p1 = high_.positions[t[1]], p2 = high_.positions[t[2]];
  const Eigen::Vector3f n0 = corner_normal(high_, triangle, 0), n1 = corner_normal(high_, triangle, 1),
                        n2 = corner_normal(high_, triangle, 2);
  for (int k = 0; k < samples_; k += 4) {
    const Ints pending = load<Ints>(&pending_[static_cast<std::size_t>(k)]);
    if ((pending[0] | pending[1] | pending[2] | pending[3]) == 0) continue;
    const Vectors point(points_, k), direction(directions_, k);
    const Vectors a = p0 - point, b = p1 - point, c = p2 - point;
    const Vectors c_turned = c.cross(direction);
    const Floats of_a = b.dot(c_turned), of_b = -a.dot(c_turned), of_c = a.cross(b).dot(direction);
    const Floats sum = of_a + of_b + of_c;
    const Floats distance_times_sum = of_a * a.dot(direction) + of_b * b.dot(direction) + of_c * c.dot(direction);
    const Ints take = (of_a >= 0) & (of_b >= 0) & (of_c >= 0) & (sum > 0) & (distance_times_sum <= reach_ * sum) &
                      (-distance_times_sum <= reach_ * sum) & pending;
    if ((take[0] | take[1] | take[2] | take[3]) == 0) continue;
    const Floats scale = 1 / (take ? sum : Floats{} + 1);
    for (int axis = 0; axis < 3; ++axis) {
      float* found = &found_.vectors(k, axis);
      const Floats normal = (of_a * n0[axis] + of_b * n1[axis] + of_c * n2[axis]) * scale;
      store(found, take ? normal : load<Floats>(found));
    }
    for (int lane = 0; lane < 4; ++lane)
      if (take[lane] != 0)
        places_[static_cast<std::size_t>(k + lane)] = {triangle, of_b[lane] * scale[lane], of_c[lane] * scale[lane], 0};
    store(&pending_[static_cast<std::size_t>(k)], pending & ~take);
  }
}

void TexelSamples::find(int sample) {
  const Eigen::Vector3f point = points_.row(sample), direction = directions_.row(sample);
  SurfacePoint met;
  if (triangle_ != SurfacePoint::none) met = walk_.meet(point, direction, triangle_);
  if (!met.found() || !(std::abs(met.distance) <= reach_)) {
    met = matcher_.match(point, direction, sources_[static_cast<std::size_t>(sample)]).point;
    reach_ = std::max(reach_, met.distance);
  }
  triangle_ = met.triangle;
  found_.vectors.row(sample) = normal_at(high_, met);
  places_[static_cast<std::size_t>(sample)] = met;
  pending_[static_cast<std::size_t>(sample)] = 0;
}

void TexelSamples::normalise(TexelPoints::Components& vectors) const {
  constexpr float least_squared_length = 1e-12f;  // vertex normals that cancel each other stay near zero
  auto used = vectors.topRows(samples_);
  const Eigen::Array<float, Eigen::Dynamic, 1, 0, TexelPoints::most, 1> scale =
      used.square().rowwise().sum().max(least_squared_length).rsqrt();
  used.colwise() *= scale;
}

}  // namespace kiln
