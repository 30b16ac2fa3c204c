// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "mesh/triangle_mesh.h"
#include "simplify/unit_frame.h"

namespace kiln {

/// CGAL's polyhedral envelope of a mesh: a prism about each triangle that has area. Each contains all points within
/// distance / sqrt(3) of its triangle, and none farther than distance. Triangles are tested by [Wang 2020].
class CgalEnvelope {
 public:
  /// Takes a mesh, the frame that triangles are asked about in, and a distance in that frame. The mesh must outlive
  /// this object.
  CgalEnvelope(const TriangleMesh& mesh, const UnitFrame& frame, double distance);
  ~CgalEnvelope();

  /// Tells whether the whole triangle lies within the envelope: within some prism at each of its points. Decides as
  /// CGAL does; where distances to the mesh tell, without the exact arithmetic, which is a hundred times slower. `hint`
  /// is that of an earlier call for a triangle close by, or 0; it changes how fast the answer comes.
  bool contains(const std::array<Eigen::Vector3d, 3>& triangle, std::uint32_t& hint) const;

 private:
  struct Parts;
  enum class Answer { inside, outside, unknown };
  Answer by_distance(const std::array<Eigen::Vector3d, 3>& triangle, int depth, std::uint32_t& hint) const;

  std::unique_ptr<Parts> parts_;
};

}  // namespace kiln
