// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Returns, for each position, the index of the first one that is the very same (-0 is 0): its own where there is none
/// before it.
std::vector<std::uint32_t> first_at_position(std::span<const Eigen::Vector3f> positions);
std::vector<std::uint32_t> first_at_position(std::span<const Eigen::Vector3d> positions);

/// Returns the same for things of `width` values each, one after the other in `values`: the first thing that has all of
/// them.
std::vector<std::uint32_t> first_of_equals(std::span<const float> values, std::size_t width);

/// Renumbers what first_at_position returns, so that the first ones have the numbers 0, 1, 2 and so on, in their order.
/// Sets `count`, if given, to how many there are.
std::vector<std::uint32_t> without_gaps(std::vector<std::uint32_t> first, std::uint32_t* count = nullptr);

/// Welds vertices at the very same position; the triangles keep their order. Normals and other attributes are dropped.
TriangleMesh join_at_positions(const TriangleMesh& mesh);

}  // namespace kiln
