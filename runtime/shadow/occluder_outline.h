// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/placement.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// A part of a mesh's surface that is a convex polygon, or nearly.
struct FlatPart {
  std::vector<Eigen::Vector3f> corners;  ///< in order around it, all on the surface
  float slack = 0;                       ///< how far the part reaches beyond the polygon, or is off its plane
};

/// Simple shapes around and within a mesh, by which most directions from a point need no ray. What goes through a flat
/// part meets the mesh; what misses all boxes and all flat parts with their slack misses it. Object space.
struct OccluderOutline {
  std::vector<BoundingBox> boxes;  ///< around parts of the mesh, all of it together but for its flat parts
  std::vector<FlatPart> flats;     ///< the largest first
  float nearest = 0;               ///< from a point nearer to a flat part's plane it may be in any direction
};

/// Finds up to eight boxes, where many bound the mesh better than one, and up to eight flat parts: convex ones, plane
/// to a ten-thousandth of the mesh's radius, of more than a fiftieth of its disc.
OccluderOutline outline_of(const TriangleMesh& mesh);

/// Directions from a point that lie within a convex shape: those whose dot product with all of the planes' normals is
/// not negative; nearly within, if it is not below -margin. Without planes: all directions.
struct ViewPyramid {
  std::vector<Eigen::Vector3f> planes;  ///< unit normals, inwards
  float margin = 0;
};

/// What an outline is as seen from a point, in the scene's space.
struct OutlineView {
  std::vector<ViewPyramid> boxes, flats;
  std::size_t box_count = 0, flat_count = 0;  ///< of the above that are in use; the rest keeps its memory
};

/// Looks at a placed outline from `point` (scene's space).
void look_at_outline(const OccluderOutline& outline, const Placement& placement, const Eigen::Vector3d& point,
                     OutlineView& view);

}  // namespace kiln
