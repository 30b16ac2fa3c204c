// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/outputs.h"

namespace kiln {

/// The text of ranges.json, or of pca.json where `asset` has tables of one.
std::string description_text(const PrtDescription& asset);

/// Writes it, under its name, and has commit() remove what an earlier run left in the folder that is no part of
/// the asset: planes, weights, tables and descriptions that are not among the names of `outputs`. Comes after the files
/// that it names.
void write_description(OutputSet& outputs, const PrtDescription& asset);

/// The second half of it, for whoever writes the text by other means.
void remove_stale_planes(OutputSet& outputs);

/// Writes the picture of one coefficient, stored with `bits`, 8 or 16, and gives its entry of the description.
PrtPlane write_plane(OutputSet& outputs, int channel, int coefficient, const Image<float>& values,
                     const PlaneRange& range, int bits);

/// Values of one coefficient at all vertices, and the range they are stored in.
struct VertexPlane {
  std::vector<float> values;
  PlaneRange range;
};

/// Writes vertices.drc, the mesh with coefficients as attributes of up to four components each, and ranges.json.
/// `asset` says the rest: channels, bands, bits and albedo. Gives the vertex of `mesh` that each vertex of the file is.
std::vector<std::uint32_t> write_vertex_asset(OutputSet& outputs, PrtDescription asset, const TriangleMesh& mesh,
                                              const std::function<VertexPlane(int channel, int coefficient)>& plane_at);

}  // namespace kiln
