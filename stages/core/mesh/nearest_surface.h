#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Answers where a mesh is nearest to a point, exactly up to the rounding of doubles, from a hierarchy of bounding
/// boxes. May be asked by several threads at once. Triangles without area are left out.
class NearestSurface {
 public:
  /// Throws std::invalid_argument where the mesh has no area.
  explicit NearestSurface(const TriangleMesh& mesh);
  ~NearestSurface();
  NearestSurface(NearestSurface&&) noexcept;
  NearestSurface& operator=(NearestSurface&&) noexcept;

  struct Hit {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double squared_distance = 0;
    std::uint32_t triangle = 0;  ///< its index in the mesh
    std::uint32_t hint = 0;      ///< for the next query
  };

  /// `hint` is that of an earlier hit, best of a point close by; it changes how fast the answer comes, not the
  /// distance.
  Hit nearest(const Eigen::Vector3d& point, std::uint32_t hint = 0) const;

  /// The unit normal of the triangle of a hit.
  Eigen::Vector3d normal(const Hit& hit) const;

 private:
  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace kiln
