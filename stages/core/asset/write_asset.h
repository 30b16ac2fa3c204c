// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/outputs.h"

namespace kiln {

/// Makes the text of ranges.json, or of pca.json if `asset` has the tables of one.
std::string description_text(const PrtDescription& asset);

/// Writes the description under its name, after the files that it names. Has commit() remove what an earlier run left
/// in the folder: planes, weights, tables, levels and descriptions that are not among `outputs`.
void write_description(OutputSet& outputs, const PrtDescription& asset);

/// Removes the remains of an earlier run as write_description does, for callers that write the text by other means.
void remove_stale_planes(OutputSet& outputs);

/// Writes the picture of one coefficient, stored with `bits`, 8 or 16, and returns its entry of the description.
PrtPlane write_plane(OutputSet& outputs, int channel, int coefficient, const Image<float>& values,
                     const PlaneRange& range, int bits);

/// Values of one coefficient at all vertices, and the range that they are stored in.
struct VertexPlane {
  std::vector<float> values;
  PlaneRange range;
};

/// Writes ranges.json and vertices.drc, the mesh with coefficients as attributes of up to four components each. `asset`
/// gives channels, bands, bits and albedo. Returns, for each vertex of the file, the vertex of `mesh` that it is.
std::vector<std::uint32_t> write_vertex_asset(OutputSet& outputs, PrtDescription asset, const TriangleMesh& mesh,
                                              const std::function<VertexPlane(int channel, int coefficient)>& plane_at);

}  // namespace kiln
