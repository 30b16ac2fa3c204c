// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

struct SurfaceTransferSettings {
  int bands = 3;
  int directions = 256;
};

/// Transfer vectors (the numeric contract's: unoccluded t_0 is 0.282095) of points on or near the surface of
/// `occluder`, shadowed by it: what decisions about a mesh need to know of its light before anything is baked. Beams of
/// rays, within about 2 % of what many directions would give; the same bits for any number of threads. Points with
/// neighbours close by in their order are as fast as others.
TransferVectors surface_transfer(const TriangleMesh& occluder, const Receivers& points,
                                 const SurfaceTransferSettings& settings = {});

/// Share of the sky above each point that is open, weighted by the cosine: t_0 over that of an unoccluded point.
std::vector<float> surface_openness(const TriangleMesh& occluder, const Receivers& points, int directions = 64);

}  // namespace kiln
