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
  /// Builds the hierarchy; keeps no reference to `mesh`.
  explicit RayScene(const TriangleMesh& mesh);
  RayScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// Finds the first hit of the ray from `origin` along the unit vector `direction` at a distance of `nearest` to
  /// `farthest`.
  SurfacePoint first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                         float farthest) const;

  /// First hits of up to 16 parallel rays. first_front_hits casts those whose bit is set in `rays`, from `origin` along
  /// the unit vector `direction`, and returns the bits of rays that hit the front of a triangle; `hits` is set only for
  /// these.
  struct PacketHits {
    static constexpr std::size_t lanes = 16;
    std::uint32_t triangle[lanes];
    float u[lanes], v[lanes];  ///< as in SurfacePoint
  };
  std::uint32_t first_front_hits(const float (&origin)[3][PacketHits::lanes], const Eigen::Vector3f& direction,
                                 std::uint32_t rays, PacketHits& hits) const;

  /// Finds how far 16 parallel rays go from `nearest` on before they meet anything: those whose bit is set in `rays`;
  /// infinity where there is nothing.
  void first_distances(const float (&origin)[3][PacketHits::lanes], const Eigen::Vector3f& direction,
                       std::uint32_t rays, float nearest, float (&distances)[PacketHits::lanes]) const;

  /// Finds the surface point closest to `point`, at most `farthest` away.
  SurfacePoint closest_point(const Eigen::Vector3f& point, float farthest) const;

  /// Finds the closest point among the triangles that face `facing`: their normals by winding form less than a right
  /// angle with it, by more than rounding.
  SurfacePoint closest_facing_point(const Eigen::Vector3f& point, const Eigen::Vector3f& facing, float farthest) const;

  /// Casts one ray from each origin along the unit vector `direction`, from `nearest` to infinity, as one stream of
  /// neighbouring rays (rtcOccluded1M, 256 at a time). occluded[k] becomes 1 if the ray of origin k is blocked, else 0.
  void occluded(std::span<const Eigen::Vector3f> origins, const Eigen::Vector3f& direction, float nearest,
                std::span<std::uint8_t> occluded) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Names the ray library and its version, for the record.
std::string ray_library_name();

}  // namespace kiln
