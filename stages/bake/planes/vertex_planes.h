// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "asset/prt_asset.h"
#include "bake/scene/receiver_set.h"
#include "base/outputs.h"
#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// Writes vertices.drc, the mesh with its stored coefficients as attributes, and ranges.json, last. Range compression
/// is that of the planes of a textured asset, over all vertices; one entry of `channels` per channel, all for the same
/// receivers, one per vertex of the mesh. Planes that a textured bake left in the folder are removed. Returns
/// the vertex of `mesh` that each vertex of the file is.
std::vector<std::uint32_t> write_vertex_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                                               const ReceiverSet& receivers, const TriangleMesh& mesh, int bits,
                                               const PrtAlbedo& albedo = {},
                                               const std::optional<PrtSpectrum>& spectrum = {});

/// Returns the vertex of the file that each receiver is; `sources` is what write_vertex_planes returned.
std::vector<std::uint32_t> stored_vertices(const ReceiverSet& receivers, const std::vector<std::uint32_t>& sources);

}  // namespace kiln
