// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Place of a point along the Morton curve: 21 bits of each coordinate, interleaved, x lowest. The topmost three bits
/// in use (62 to 60) are the octant of the bounding cube, the next three the octant of that, and so on.
struct MortonPlace {
  std::uint64_t code = 0;
  std::uint32_t index = 0;  ///< index of the point

  auto operator<=>(const MortonPlace&) const = default;
};

/// Number of levels of octants in a code.
inline constexpr int morton_levels = 21;

/// Sorts `points` along the Morton curve [Morton 1966] through their bounding cube; points in the same of its 2^63
/// cells by index.
std::vector<MortonPlace> morton_order(std::span<const Eigen::Vector3f> points);

}  // namespace kiln
