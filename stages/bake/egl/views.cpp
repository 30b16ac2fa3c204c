// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/views.h"

#include <algorithm>

#include "bake/egl/shadow_frame.h"

namespace kiln {

namespace {

constexpr int frame_margin_texels = 2;

}  // namespace

std::vector<View> fit_views(std::span<const Eigen::Vector3f> hull, std::span<const Eigen::Vector3f> directions,
                            int size_texels) {
  std::vector<View> views;
  for (const Eigen::Vector3f& direction : directions) {
    const ShadowFrame frame = fit_shadow_frame(hull, direction, size_texels, frame_margin_texels);
    const float texel = std::max(frame.width, frame.height) / static_cast<float>(size_texels);
    views.push_back({frame.row_u,
                     frame.row_v,
                     frame.row_depth,
                     {direction.x(), direction.y(), direction.z(), texel},
                     {frame.width, frame.height, frame.depth, 0}});
  }
  return views;
}

}  // namespace kiln
