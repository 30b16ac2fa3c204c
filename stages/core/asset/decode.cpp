// SPDX-License-Identifier: MIT
#include <algorithm>

#include "asset/prt_asset.h"
#include "asset/read_description.h"
#include "asset/read_parts.h"
#include "base/errors.h"
#include "sh/basis.h"

namespace kiln {

namespace {

template <class Texel>
void recover_picture(const std::filesystem::path& file, const PrtDescription& asset, const PrtPlane& plane,
                     std::span<const std::uint32_t> texels, std::span<float> values) {
  const Image<Texel> stored = read_grey<Texel>(file, asset.width, asset.height, remedy_for(asset));
  for (std::size_t k = 0; k < texels.size(); ++k)
    values[k] = static_cast<float>(plane.range.recover(stored.values()[texels[k]], plane.bits));
}

}  // namespace

void decode_transfer(const PrtAsset& asset, std::span<const std::uint32_t> texels, std::span<float> vectors) {
  const std::size_t length = asset.vector_length();
  const auto decode = [&](const auto& pictures) {
    // Texels decoded at a time: few enough that their vectors stay in the first-level cache while plane after plane is
    // read.
    constexpr std::size_t group = 64;
    for (std::size_t first = 0; first < texels.size(); first += group) {
      const std::size_t last = std::min(first + group, texels.size());
      for (std::size_t plane = 0; plane < pictures.size(); ++plane) {
        const PlaneRange& range = asset.planes[plane].range;
        const auto lowest = static_cast<float>(range.lowest), step = static_cast<float>(range.step(asset.bits));
        const auto* stored = pictures[plane].values().data();
        for (std::size_t k = first; k < last; ++k) {
          const float value = lowest + step * static_cast<float>(stored[texels[k]]);
          float* to = vectors.data() + k * length;
          if (!asset.clusters) {
            to[plane] = value;
            continue;
          }
          const int cluster = asset.clusters->of_texel(texels[k]);
          const std::span<const float> mean = asset.clusters->mean(cluster),
                                       basis = asset.clusters->vector(cluster, static_cast<int>(plane));
          if (plane == 0) std::copy(mean.begin(), mean.end(), to);
          for (std::size_t i = 0; i < length; ++i) to[i] += value * basis[i];
        }
      }
    }
  };
  std::visit(decode, asset.pictures);
}

std::vector<TransferVectors> read_transfer(const std::filesystem::path& folder, std::span<const std::uint32_t> places) {
  const PrtDescription asset = load_prt_description(folder);
  if (asset.pca)
    throw BadInput(asset.ranges_file.string(), "is a compressed asset", "the output folder of kiln-bake",
                   "name the folder that it was compressed from");
  AttributedMesh mesh;
  if (asset.vertices > 0) mesh = read_vertex_mesh(folder, asset);
  std::vector<TransferVectors> channels(static_cast<std::size_t>(asset.channels),
                                        TransferVectors(places.size(), coefficient_count(asset.bands)));
  for (std::size_t k = 0; k < asset.planes.size(); ++k) {
    const PrtPlane& plane = asset.planes[k];
    const std::span<float> values = channels[static_cast<std::size_t>(plane.channel)].plane(plane.coefficient);
    if (asset.vertices > 0)
      std::ranges::copy(vertex_values(attribute_of(mesh, folder, asset, k), plane, places), values.begin());
    else if (plane.bits == 8)
      recover_picture<std::uint8_t>(folder / plane.file, asset, plane, places, values);
    else
      recover_picture<std::uint16_t>(folder / plane.file, asset, plane, places, values);
  }
  return channels;
}

}  // namespace kiln
