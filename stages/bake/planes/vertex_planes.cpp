// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/planes/vertex_planes.h"

#include <algorithm>
#include <stdexcept>

#include "asset/write_asset.h"
#include "sh/basis.h"

namespace kiln {

std::vector<std::uint32_t> write_vertex_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                                               const ReceiverSet& receivers, const TriangleMesh& mesh, int bits,
                                               const PrtAlbedo& albedo, const std::optional<PrtSpectrum>& spectrum) {
  if (static_cast<std::size_t>(receivers.width) != mesh.positions.size())
    throw std::invalid_argument("write_vertex_planes: receivers of this mesh's vertices are needed");
  PrtDescription asset;
  asset.channels = static_cast<int>(channels.size());
  asset.bands = band_of(channels[0].coefficients - 1) + 1;
  asset.bits = bits;
  asset.albedo = albedo;
  asset.spectrum = spectrum;
  return write_vertex_asset(outputs, asset, mesh, [&](int channel, int coefficient) {
    const std::span<const float> values = channels[static_cast<std::size_t>(channel)].plane(coefficient);
    VertexPlane plane{std::vector<float>(mesh.positions.size(), 0.f),
                      range_of(values)};  // 0 (dark) where nothing fills
    for (std::size_t r = 0; r < values.size(); ++r) plane.values[receivers.slots[r]] = values[r];
    receivers.fills.apply(plane.values);
    return plane;
  });
}

std::vector<std::uint32_t> stored_vertices(const ReceiverSet& receivers, const std::vector<std::uint32_t>& sources) {
  constexpr std::uint32_t lost = ~0u;
  std::vector<std::uint32_t> place(static_cast<std::size_t>(receivers.width),
                                   lost);  // place in the file of each vertex of the mesh
  for (std::uint32_t k = 0; k < sources.size(); ++k) place[sources[k]] = k;
  if (std::find(place.begin(), place.end(), lost) != place.end())
    throw std::invalid_argument("stored_vertices: a vertex has no proper triangle and is not in the file");
  std::vector<std::uint32_t> stored(receivers.slots.size());
  std::transform(receivers.slots.begin(), receivers.slots.end(), stored.begin(),
                 [&](std::uint32_t vertex) { return place[vertex]; });
  return stored;
}

}  // namespace kiln
