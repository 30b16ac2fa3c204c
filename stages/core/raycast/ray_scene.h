// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "mesh/surface_point.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// A mesh in a bounding volume hierarchy (Embree 3). All queries may be called from many threads at once.
class RayScene {
 public:
  /// Keeps no reference to `mesh`.
  explicit RayScene(const TriangleMesh& mesh);
  RayScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// The first hit of the ray from `origin` along the unit vector `direction` at a distance of `nearest` to `farthest`.
  SurfacePoint first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                         float farthest) const;

  /// The first hits of up to 16 parallel rays, those whose bit is set in `rays`, from `origin` along the unit vector
  /// `direction`. Returns the bits of those that hit the front of a triangle; only of these, `hits` is set.
  struct PacketHits {
    static constexpr std::size_t lanes = 16;
    std::uint32_t triangle[lanes];
    float u[lanes], v[lanes];  ///< as in SurfacePoint
  };
  std::uint32_t first_front_hits(const float (&origin)[3][PacketHits::lanes], const Eigen::Vector3f& direction,
                                 std::uint32_t rays, PacketHits& hits) const;

  /// The surface point closest to `point`, at most `farthest` away.
  SurfacePoint closest_point(const Eigen::Vector3f& point, float farthest) const;

  /// closest_point among the triangles that face `facing`: whose normal by winding is less than a right angle from it,
  /// by more than rounding.
  SurfacePoint closest_facing_point(const Eigen::Vector3f& point, const Eigen::Vector3f& facing, float farthest) const;

  /// Casts one ray from each origin along the one unit vector `direction`, from `nearest` to infinity, as one stream of
  /// neighbouring rays (rtcOccluded1M, 256 at a time); occluded[k] becomes 1 where origin k is in shadow, else 0.
  void occluded(std::span<const Eigen::Vector3f> origins, const Eigen::Vector3f& direction, float nearest,
                std::span<std::uint8_t> occluded) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The ray library and its version, for the record.
std::string ray_library_name();

}  // namespace kiln
