// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"
#include "normals/point_matcher.h"
#include "normals/surface_walk.h"

namespace kiln {

/// Vectors at the points of a grid in a texel, row by row, component by component; absent points are zero.
struct TexelPoints {
  static constexpr int most = 64;
  using Components = Eigen::Array<float, most, 3>;

  Components vectors = Components::Zero();
  std::array<std::uint8_t, most> present{};
  int count = 0;  ///< number of points present
};

/// Finds the high mesh's normals at the samples of one texel after another. Samples of a texel mostly meet the same few
/// high triangles, so each triangle that a walk finds is tried for all samples of the texel at once.
class TexelSamples {
 public:
  /// Keeps references. `samples` per texel, at most TexelPoints::most.
  TexelSamples(const TriangleMesh& high, const SurfaceWalk& walk, const PointMatcher& matcher, int samples);

  /// Starts a texel: the triangle of its centre's point, if it has one, and how far away samples' points may be.
  void start(std::uint32_t triangle, float reach);

  /// Adds sample number `sample` of the texel, which lies at `source`.
  void add(int sample, const TexelSource& source);

  /// Returns the high normals, of unit length, of the samples added.
  const TexelPoints& finish();

  /// Returns, after finish(), the point of the high mesh that an added sample stands for; without its distance.
  const SurfacePoint& place(int sample) const { return places_[static_cast<std::size_t>(sample)]; }

 private:
  /// Low triangle: a value at its first corner, and the differences to the others.
  struct Corners {
    Eigen::Vector3f first, second, third;
    Corners() = default;
    Corners(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c)
        : first(a), second(b - a), third(c - a) {}
    Eigen::Vector3f at(float u, float v) const { return first + u * second + v * third; }
  };

  void try_triangle(std::uint32_t triangle);
  void find(int sample);
  void normalise(TexelPoints::Components& vectors) const;

  const TriangleMesh& high_;
  const SurfaceWalk& walk_;
  const PointMatcher& matcher_;
  int samples_;

  std::uint32_t triangle_ = SurfacePoint::none;
  float reach_ = 0;
  std::uint32_t low_triangle_ = TexelSource::none;
  Corners low_positions_, low_lines_;
  TexelPoints::Components points_ = TexelPoints::Components::Zero(), directions_ = TexelPoints::Components::Zero();
  std::array<std::int32_t, TexelPoints::most> pending_{};  ///< -1 or 0
  TexelPoints found_;
  std::array<SurfacePoint, TexelPoints::most> places_;
  std::array<TexelSource, TexelPoints::most> sources_;
};

}  // namespace kiln
