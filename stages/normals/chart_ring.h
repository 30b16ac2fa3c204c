// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// Texel that no triangle covers, but that bilinear lookups at a chart's edge see.
struct RingTexel {
  std::uint32_t texel = 0;    ///< j * width + i
  TexelSource nearest;        ///< nearest point of a chart
  Eigen::Vector3f low_point;  ///< the plane of that point's triangle, continued to the texel's centre; object space
};

/// Finds all texels that `raster`, that of `atlas`, leaves uncovered within a lookup's reach of a chart.
std::vector<RingTexel> ring_of_charts(const TriangleMesh& atlas, const UvRaster& raster);

}  // namespace kiln
