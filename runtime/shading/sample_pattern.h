// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace kiln {

/// Returns the places of `count` samples within a pixel, 0 to 1 along both axes: a lattice with one sample in each
/// column and each row of `count` x `count` cells, the one of those whose samples are farthest apart from each other
/// and from the neighbouring pixels'.
std::vector<Eigen::Vector2d> sample_pattern(int count);

}  // namespace kiln
