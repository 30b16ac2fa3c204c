// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "mesh/surface_point.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"
#include "normals/high_parts.h"
#include "normals/match_plan.h"
#include "normals/surface_match.h"

namespace kiln {

/// Finds the points of a high mesh that points of an atlas stand for, as a plan says: each in its own part, by rays
/// along the low normals or through a cage. May be used by many threads at once.
class PointMatcher {
 public:
  /// Keeps references. `limits` has one entry for each part of the plan.
  PointMatcher(const TriangleMesh& high, const HighParts& parts, const TriangleMesh& atlas, const MatchPlan& plan,
               std::vector<MatchLimits> limits)
      : high_(high), parts_(parts), atlas_(atlas), plan_(plan), limits_(std::move(limits)) {}

  const TriangleMesh& atlas() const { return atlas_; }
  const MatchPlan& plan() const { return plan_; }
  float surface_tolerance() const { return limits_[0].surface_tolerance; }

  /// Returns the vectors at a triangle's corners, of any length, between which the lines through its points lie:
  /// normals, or the way to the cage.
  std::array<Eigen::Vector3f, 3> lines(std::uint32_t triangle) const;

  /// Returns the direction, outwards, of the line through a point of the atlas; a unit vector.
  Eigen::Vector3f line(const TexelSource& source) const;

  /// Finds the point of the high mesh for `low_point`, which lies at `source` or beside it; `direction` is its line's.
  SurfaceMatch match(const Eigen::Vector3f& low_point, const Eigen::Vector3f& direction,
                     const TexelSource& source) const;

 private:
  /// Tells whether the cage leaves the low mesh at a triangle, so that it gives lines.
  bool leaves(const std::array<Eigen::Vector3f, 3>& offsets) const;

  const TriangleMesh& high_;
  const HighParts& parts_;
  const TriangleMesh& atlas_;
  const MatchPlan& plan_;
  std::vector<MatchLimits> limits_;
};

}  // namespace kiln
