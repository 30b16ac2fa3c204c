// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace kiln {

/// Returns the weights of b and c at the point of the triangle a, b, c that is closest to `point` ([Ericson 2005],
/// section 5.1.5). Not finite for a triangle without area.
Eigen::Vector2d closest_weights(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c);

}  // namespace kiln
