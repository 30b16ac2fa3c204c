// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace kiln {

/// Triangles to draw in one submission, at most: hardware takes a few tens of milliseconds for them.
inline constexpr int most_draw_triangles = 16'000'000;

/// Frame of one direction as shaders/bake_views.glsl has it (std430).
struct View {
  Eigen::Vector4f row_u, row_v, row_depth;
  Eigen::Vector4f direction;  ///< xyz: unit vector towards the light; w: size of a map's texel in object units
  Eigen::Vector4f extent;     ///< size of the map in object units: width, height, depth
};

/// Returns the tightest frames around `hull` (shadow_frame.h) of maps of `size_texels`.
std::vector<View> fit_views(std::span<const Eigen::Vector3f> hull, std::span<const Eigen::Vector3f> directions,
                            int size_texels);

}  // namespace kiln
