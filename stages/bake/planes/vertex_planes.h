#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "bake/scene/texel_receivers.h"
#include "base/outputs.h"
#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// The name of the mesh that write_vertex_planes writes.
inline constexpr char vertex_mesh_name[] = "vertices.drc";

/// Writes `vertices.drc`, the mesh with its stored coefficients as attributes of up to four components each, and
/// ranges.json, last. Range compression is that of the planes of a textured asset (PlaneRange, over all vertices); one
/// entry of `channels` per channel, all for the same receivers, one per vertex of the mesh. Planes that a textured bake
/// left in the folder are removed. Gives the vertex of `mesh` that each vertex of the file is.
std::vector<std::uint32_t> write_vertex_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                                               const TexelReceivers& receivers, const TriangleMesh& mesh, int bits,
                                               const Json& albedo = {});

/// Transfer as it reads back from the files in `folder` that write_vertex_planes wrote, in the order of `receivers`;
/// `sources` is what it gave.
std::vector<TransferVectors> read_vertex_planes(const std::filesystem::path& folder, const TexelReceivers& receivers,
                                                const std::vector<std::uint32_t>& sources);

}  // namespace kiln
