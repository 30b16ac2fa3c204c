// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

namespace kiln {

/// Returns the distance (object units) that a ray starts off its surface, so that it does not hit that surface again:
/// 16 float32 roundings of the largest coordinate. A point of a triangle is off its plane by three roundings (its own
/// and that of the interpolation), a shifted origin by one more, and the ray's intersection takes the rest ([Waechter
/// 2019] bounds the same parts). The distance does not grow with the object's size, so crevices, sheets and small parts
/// keep their shadows. 0 for no positions.
float rounding_offset(std::span<const Eigen::Vector3f> positions);

}  // namespace kiln
