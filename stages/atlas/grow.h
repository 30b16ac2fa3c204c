// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/disks.h"

namespace kiln {

struct GrowSettings {
  double largest_spread =
      0.015;  ///< largest spread of a disk's normals: 0 is flat, 0.015 a cap of 14 degrees around its pole
  double sharpest_bend = 1.3;  ///< radians; a run whose mean bend is larger stays a seam
};

/// Glues the given disks to one another, flattest and roundest results first, until all further gluing would bend too
/// much: agglomerative clustering by the distance of [Cohen-Steiner 2004], times the roundness of the result. Disks
/// outside the list are not touched.
void grow(Disks& disks, const std::vector<std::uint32_t>& ids, const GrowSettings& settings);

}  // namespace kiln
