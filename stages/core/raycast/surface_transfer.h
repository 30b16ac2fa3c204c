// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

struct SurfaceTransferSettings {
  int bands = 3;
  int directions = 256;
};

/// Computes transfer vectors (unoccluded t_0 is 0.282095; ARCHITECTURE.md, "Contracts") at points on or near the
/// surface of `occluder`, shadowed by it, for decisions about a mesh before anything is baked. Uses beams of rays, and
/// comes within about 2 % of the result of many directions; any number of threads gives the same bits. Points whose
/// neighbours are close by in the list are as fast as others.
TransferVectors surface_transfer(const TriangleMesh& occluder, const Receivers& points,
                                 const SurfaceTransferSettings& settings = {});

/// Computes the open share of the sky above each point, weighted by the cosine: t_0 over that of an unoccluded point.
std::vector<float> surface_openness(const TriangleMesh& occluder, const Receivers& points, int directions = 64);

}  // namespace kiln
