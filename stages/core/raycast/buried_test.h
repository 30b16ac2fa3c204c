// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// Finds the points of a mesh's surface that no one can see, because they are inside the mesh: in another of its parts,
/// or where a part intersects itself. Such points are black under every light, but say nothing about the visible
/// surface beside them.
///
/// A point is buried if the winding number of some component about it, moved off its surface along its normal, is above
/// a half [Jacobson 2013]. For a closed component, each ray gives that number, as the sum of its crossings: outwards 1,
/// inwards -1. For an open one it is the mean over all directions, and only points that no light reaches count: a leg
/// under a skirt is dark, not buried.
class BuriedTest {
 public:
  /// Keeps no reference. Vertices at the same position are taken as one. `ray_offset` (object units) is the distance
  /// between a point and the start of its rays. Without triangles nothing is buried.
  BuriedTest(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles, float ray_offset);
  ~BuriedTest();

  /// Returns 1 for each buried point, else 0; `points` lie on the mesh's surface, and those without a normal are not
  /// buried. Neighbours should stand next to each other in the list. Does not depend on the number of threads.
  std::vector<std::uint8_t> operator()(const Receivers& points) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
