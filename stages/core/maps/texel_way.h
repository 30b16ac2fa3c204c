// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace kiln {

/// Way in which a texel's point of the high mesh was found, as match.png shows it; `buried`: nothing can see that
/// point.
enum class TexelWay : std::uint8_t { uncovered, ray_outwards, ray_inwards, nearest_point, disagreeing, buried };

struct TexelWayColor {
  const char* name;
  std::array<std::uint8_t, 3> color;  ///< sRGB
};

/// Legend of match.png, by TexelWay.
inline constexpr std::array<TexelWayColor, 6> texel_way_colors = {{{"not covered", {24, 22, 20}},
                                                                   {"ray outwards", {214, 164, 88}},
                                                                   {"ray inwards", {74, 132, 150}},
                                                                   {"nearest point", {196, 120, 190}},
                                                                   {"disagreeing", {228, 40, 30}},
                                                                   {"buried in another part", {96, 92, 88}}}};

}  // namespace kiln
