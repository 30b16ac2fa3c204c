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

/// Tells which points of a mesh's surface no one can see, because they stand inside the mesh: in another of its parts,
/// or where a part runs into itself. Such points are black in every light, but no truth about the surface that is seen
/// beside them.
///
/// A point is buried where the winding number of some component about it, moved off its surface along its normal, is
/// above a half (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding
/// numbers", 2013). About a closed component each ray tells that number, as the sum of its crossings: outwards 1,
/// inwards -1. About an open one it is the mean over all directions, and only points that no light reaches count:
/// a leg under a skirt is dark, not buried.
class BuriedTest {
 public:
  /// Keeps no reference. Vertices at the same place are taken as one. `ray_offset` (object units) is how far rays start
  /// off their points.
  BuriedTest(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles, float ray_offset);
  ~BuriedTest();

  /// 1 for each buried one of `points`, which lie on the mesh's surface, else 0; points without a normal are not.
  /// Neighbours should stand next to each other. Does not depend on the number of threads.
  std::vector<std::uint8_t> operator()(const Receivers& points) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
