#pragma once

#include <Eigen/Core>
#include <span>

namespace kiln {

/// How far a ray starts off a surface so that it does not find it again, from what float32 holds of its positions
/// (object units): 16 roundings of the largest coordinate. A point of a triangle is off its plane by three of them (its
/// own and that of the interpolation), a shifted origin by one more, and the intersection of the ray takes the rest
/// (Waechter and Binder, "A fast and robust method for avoiding self-intersection", 2019, bound the same parts).
/// No share of the size: crevices, sheets and small parts stay shadowed as they are. 0 for no positions.
float rounding_offset(std::span<const Eigen::Vector3f> positions);

}  // namespace kiln
