#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// The point of a triangle that is nearest to `point`. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5.
Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

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

  /// What a triangle has to face to count.
  struct Facing {
    Eigen::Vector3d normal;                                   ///< of any length but 0
    double smallest_cosine = 0;                               ///< between it and the triangle's normal
    double within = std::numeric_limits<double>::infinity();  ///< distance from the point
  };
  /// The same among the triangles that face so: on a wall that is thinner than the error of a simplified mesh, its near
  /// side rather than its far one. Nothing where none is near enough.
  std::optional<Hit> nearest_facing(const Eigen::Vector3d& point, const Facing& facing, std::uint32_t hint = 0) const;

  /// The unit normal of the triangle of a hit.
  Eigen::Vector3d normal(const Hit& hit) const;

 private:
  struct Hierarchy;
  template <class Counts, class MayCount>
  void search(const Eigen::Vector3d& point, std::uint32_t hint, double within, Hit& hit, const Counts& counts,
              const MayCount& may_count) const;

  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace kiln
