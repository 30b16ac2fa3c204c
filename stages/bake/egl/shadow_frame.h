// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

namespace kiln {

/// Orthographic frame of one direction's depth map. A point p has map coordinates u = row_u . (p, 1) and v
/// likewise, both 0 to 1 over the map, and depth row_depth . (p, 1), 0 nearest to the light and 1 farthest.
struct ShadowFrame {
  Eigen::Vector4f row_u, row_v, row_depth;
  float width = 0;  ///< width of the map, object units
  float height = 0;
  float depth = 0;  ///< object units between depth 0 and 1
};

/// Returns the frame of least area around the projection of `hull` along `direction` (unit, towards the light), with a
/// margin of `margin_texels` of a map of `size_texels` at each side. The rectangle of least area shares a side with the
/// projection's convex hull [Freeman 1975].
ShadowFrame fit_shadow_frame(std::span<const Eigen::Vector3f> hull, const Eigen::Vector3f& direction, int size_texels,
                             int margin_texels);

}  // namespace kiln
