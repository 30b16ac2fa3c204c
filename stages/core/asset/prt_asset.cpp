// SPDX-License-Identifier: MIT
#include "asset/prt_asset.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

#include "asset/read_description.h"
#include "asset/read_parts.h"
#include "base/errors.h"
#include "image/resize.h"
#include "image/srgb.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Stretches a plane of weights that uses few of the 256 stored values over all of them, which changes no weight. GPUs
/// (and software drivers) that filter 8-bit textures in 8 bits then round to less than a step of the weights.
void spread(Image<std::uint8_t>& picture, PlaneRange& range) {
  const int largest = *std::max_element(picture.values().begin(), picture.values().end());
  if (largest == 0) return;
  const int factor = 255 / largest;
  for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(factor * value);
  range.highest = range.lowest + range.width() / factor;
}

/// Reads pictures of 8 and 16 bits as 16-bit ones, scaled so that white stays white.
std::vector<Image<std::uint16_t>> read_mixed_pictures(const fs::path& folder, const PrtDescription& asset,
                                                      const std::string& remedy) {
  std::vector<Image<std::uint16_t>> pictures;
  for (const PrtPlane& plane : asset.planes) {
    if (plane.bits == 16) {
      pictures.push_back(read_grey<std::uint16_t>(folder / plane.file, asset.width, asset.height, remedy));
      continue;
    }
    const Image<std::uint8_t> narrow = read_grey<std::uint8_t>(folder / plane.file, asset.width, asset.height, remedy);
    Image<std::uint16_t>& wide = pictures.emplace_back(asset.width, asset.height, 1);
    std::transform(narrow.values().begin(), narrow.values().end(), wide.values().begin(),
                   [](std::uint8_t value) { return static_cast<std::uint16_t>(257 * value); });
  }
  return pictures;
}

PrtClusters read_clusters(const fs::path& folder, const PrtDescription& asset) {
  PrtClusters clusters;
  clusters.count = asset.pca->clusters;
  clusters.components = static_cast<int>(asset.planes.size());
  clusters.length = static_cast<int>(asset.vector_length());
  clusters.vectors = read_vectors(folder, asset);
  clusters.ids = read_cluster_ids(folder, asset);
  return clusters;
}

void load_vertices(const fs::path& folder, PrtAsset& asset) {
  AttributedMesh stored = read_vertex_mesh(folder, asset);
  const std::size_t length = asset.vector_length(), vertices = stored.mesh.positions.size();
  std::vector<std::uint32_t> all(vertices);
  std::iota(all.begin(), all.end(), 0);
  asset.vertex_transfer.resize(vertices * length);
  for (std::size_t k = 0; k < length; ++k) {
    const std::vector<float> values = vertex_values(attribute_of(stored, folder, asset, k), asset.planes[k], all);
    for (std::size_t v = 0; v < vertices; ++v) asset.vertex_transfer[v * length + k] = values[v];
  }
  asset.mesh = std::move(stored.mesh);
}

void load_pictures(const fs::path& folder, PrtAsset& asset) {
  const std::string remedy = remedy_for(asset);
  asset.albedo.picture = read_albedo_picture(folder, asset);
  if (asset.albedo.has_own_size())
    asset.albedo.at_planes =
        srgb_bytes(resized(linear_from_srgb_bytes(asset.albedo.picture), asset.width, asset.height));
  asset.albedo.measured_at = read_measured_picture(folder, asset);
  asset.opacity = read_opacity_picture(folder, asset);
  asset.mesh = read_atlas_mesh(folder, asset);
  if (asset.pca) asset.clusters = read_clusters(folder, asset);
  if (asset.bits == 8) {
    auto pictures = read_grey_pictures<std::uint8_t>(folder, asset, remedy);
    for (std::size_t k = 0; asset.pca && k < pictures.size(); ++k) spread(pictures[k], asset.planes[k].range);
    asset.pictures = std::move(pictures);
  } else if (asset.pca) {
    asset.pictures = read_mixed_pictures(folder, asset, remedy);
  } else {
    asset.pictures = read_grey_pictures<std::uint16_t>(folder, asset, remedy);
  }
}

}  // namespace

PrtDescription load_prt_description(const fs::path& folder) {
  Faults first;
  return read_description(description_file(folder), first).first;
}

const PrtReflectance* PrtAlbedo::measured(std::size_t texel) const {
  const std::size_t number = measured_at.values().empty() ? 0 : measured_at.values()[texel];
  return number == 0 ? nullptr : &reflectances[number - 1];
}

Eigen::Vector3f PrtAlbedo::at(std::size_t texel) const {
  if (!known) return Eigen::Vector3f::Ones();
  if (picture.width() == 0) return constant;
  const Image<std::uint8_t>& of_planes = has_own_size() ? at_planes : picture;
  const auto channel = [&](std::size_t c) {
    return linear_from_srgb(static_cast<float>(of_planes.values()[3 * texel + c]) / 255);
  };
  return {channel(0), channel(1), channel(2)};
}

PrtAsset load_prt_asset(const fs::path& folder) {
  PrtAsset asset;
  static_cast<PrtDescription&>(asset) = load_prt_description(folder);
  asset.vertices > 0 ? load_vertices(folder, asset) : load_pictures(folder, asset);
  return asset;
}

TriangleMesh load_level(const fs::path& folder, const PrtDescription& asset, int level) {
  if (level == 0 && asset.vertices == 0) return read_atlas_mesh(folder, asset);
  if (level < 1 || static_cast<std::size_t>(level) > asset.levels.size())
    throw BadInput(asset.ranges_file.string(),
                   asset.levels.empty() ? "has no levels of detail" : fmt::format("has no level {} of detail", level),
                   asset.levels.empty() ? "an asset baked with them" : fmt::format("0 to {}", asset.levels.size()),
                   "bake with levels of kiln-lod (lod: in pipeline.yaml), or ask for another level");
  return read_level_mesh(folder, asset, asset.levels[static_cast<std::size_t>(level) - 1]);
}

PrtAsset load_other_form(const fs::path& folder, const PrtAsset& asset) {
  PrtAsset other = load_prt_asset(folder);
  if (other.bands != asset.bands)
    throw BadInput(folder.string(), "has " + std::to_string(other.bands) + " bands",
                   std::to_string(asset.bands) + ", as the asset has",
                   "name the output of kiln-compress for this asset");
  return other;
}

}  // namespace kiln
