// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sh/transfer.h"

namespace kiln {

/// Receivers whose visibility along one direction is asked for.
struct ShadowRayQuery {
  Eigen::Vector3f direction;             ///< unit vector towards the light
  std::vector<std::uint32_t> receivers;  ///< indices, rising
  std::vector<std::uint8_t> occluded;    ///< answer, one per receiver: 1 in shadow, 0 lit
};

/// Questions that the EGL engine, which links no ray library, asks one. rays/embree_shadow_rays.h answers them.
struct ShadowRays {
  /// Returns the occluders' triangle that each receiver stands on.
  std::function<std::vector<std::uint32_t>(const Receivers&)> triangles_below;
  /// Answers each query.
  std::function<void(const Receivers&, std::span<ShadowRayQuery>)> occluded;
};

}  // namespace kiln
