// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Returns the point of a triangle that is nearest to `point` ([Ericson 2005], section 5.1.5).
Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

/// Finds where a mesh is nearest to a point, exactly up to the rounding of doubles, by a hierarchy of bounding boxes.
/// May be asked by several threads at once. Triangles without area are ignored.
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
    std::uint32_t hint = 0;      ///< speeds up the next query
  };

  /// Finds the nearest point of the mesh. `hint` comes from an earlier hit, best at a point close by; it changes only
  /// the time taken.
  Hit nearest(const Eigen::Vector3d& point, std::uint32_t hint = 0) const;

  /// Condition on the triangles that count.
  struct Facing {
    Eigen::Vector3d normal;      ///< direction to face; of any length but 0
    double smallest_cosine = 0;  ///< least cosine between `normal` and the triangle's normal
    double within = std::numeric_limits<double>::infinity();  ///< largest distance from the point
  };
  /// Finds the nearest point among triangles that face as asked: on a wall thinner than the error of a simplified mesh,
  /// the near side rather than the far one. Nothing where none is near enough.
  std::optional<Hit> nearest_facing(const Eigen::Vector3d& point, const Facing& facing, std::uint32_t hint = 0) const;

  /// Returns the unit normal of the triangle of a hit.
  Eigen::Vector3d normal(const Hit& hit) const;

 private:
  struct Hierarchy;
  template <class Number, class Counts, class MayCount>
  void search(const Eigen::Vector3d& point, std::uint32_t hint, double within, Hit& hit, const Counts& counts,
              const MayCount& may_count) const;
  template <class Counts, class MayCount>
  void search(const Eigen::Vector3d& point, std::uint32_t hint, double within, Hit& hit, const Counts& counts,
              const MayCount& may_count) const;

  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace kiln
