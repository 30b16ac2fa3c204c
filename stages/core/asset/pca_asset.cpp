#include <algorithm>
#include <cmath>

#include "asset/asset_parts.h"
#include "asset/fields.h"
#include "asset/prt_asset.h"
#include "image/image_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

constexpr const char* remedy = "compress the asset again with kiln-compress";
constexpr int most_clusters = 256;
constexpr double white16 = 65535;

/// The list under `key`, of `count` entries.
const json& list_of(const Fields& fields, const char* key, std::size_t count, const std::string& what) {
  const std::string expected = "a list of " + std::to_string(count) + " " + what;
  const json& list = fields.get(key, expected);
  if (!list.is_array()) fields.fail(fields.path(key), "no list", expected);
  if (list.size() != count) fields.fail(fields.path(key), "a list of " + std::to_string(list.size()), expected);
  return list;
}

/// "min" and "max" of an object.
std::pair<double, double> read_range(const Fields& fields) {
  const double lowest = fields.number("min"), highest = fields.number("max");
  if (lowest > highest)
    fields.fail(fields.path("min"), std::to_string(lowest) + ", above max " + std::to_string(highest), "min <= max");
  return {lowest, highest};
}

/// Means and basis vectors from their picture, whose rows are counted from the top.
std::vector<float> read_vectors(const fs::path& folder, const Fields& fields, const PrtClusters& clusters,
                                const std::vector<double>& scales) {
  const int rows = clusters.count * (clusters.components + 1);
  const Image<std::uint16_t> stored =
      read_grey<std::uint16_t>(folder / fields.safe_path("vectors_file"), clusters.length, rows, remedy);
  const auto count = static_cast<std::size_t>(clusters.components) + 1;
  const json& list = list_of(fields, "vector_ranges", count, "ranges: the means', then the basis vectors'");
  std::vector<std::pair<double, double>> ranges;
  for (std::size_t k = 0; k < count; ++k)
    ranges.push_back(read_range(Fields(fields.file(), "vector_ranges[" + std::to_string(k) + "]", list[k], remedy)));
  std::vector<float> vectors;
  for (int row = 0; row < rows; ++row) {
    const auto [lowest, highest] = ranges[static_cast<std::size_t>(row % (clusters.components + 1))];
    for (int i = 0; i < clusters.length; ++i)
      vectors.push_back(static_cast<float>((lowest + stored.at(i, rows - 1 - row) / white16 * (highest - lowest)) *
                                           scales[static_cast<std::size_t>(i) % scales.size()]));
  }
  return vectors;
}

/// The cluster of every texel. Throws BadInput where one is not there.
Image<std::uint8_t> read_ids(const fs::path& folder, const Fields& fields, const PrtAsset& asset, int clusters) {
  const fs::path file = folder / fields.safe_path("cluster_ids");
  Image<std::uint8_t> ids = read_grey<std::uint8_t>(file, asset.width, asset.height, remedy);
  const int highest = *std::max_element(ids.values().begin(), ids.values().end());
  if (highest >= clusters)
    throw BadInput(file.string(), "has a texel of cluster " + std::to_string(highest),
                   "clusters 0 to " + std::to_string(clusters - 1), remedy);
  return ids;
}

/// Pictures of 8 and 16 bits as 16-bit ones: the same part of white.
std::vector<Image<std::uint16_t>> read_mixed_pictures(const fs::path& folder, const PrtAsset& asset,
                                                      const std::vector<int>& bits) {
  std::vector<Image<std::uint16_t>> pictures;
  for (std::size_t k = 0; k < asset.planes.size(); ++k) {
    const std::vector<std::string> file = {asset.planes[k].file};
    if (bits[k] == 16) {
      pictures.push_back(
          std::move(read_grey_pictures<std::uint16_t>(folder, file, asset.width, asset.height, remedy).front()));
      continue;
    }
    const Image<std::uint8_t> narrow =
        std::move(read_grey_pictures<std::uint8_t>(folder, file, asset.width, asset.height, remedy).front());
    Image<std::uint16_t>& wide = pictures.emplace_back(asset.width, asset.height, 1);
    std::transform(narrow.values().begin(), narrow.values().end(), wide.values().begin(),
                   [](std::uint8_t value) { return static_cast<std::uint16_t>(257 * value); });
  }
  return pictures;
}

/// Spreads the values of a plane that uses few of the 256 over all of them. It means the same; GPUs (and drivers in
/// software) that filter 8-bit textures in 8 bits then round to less than a step of the weights.
void spread(Image<std::uint8_t>& picture, PrtPlane& plane) {
  const int largest = *std::max_element(picture.values().begin(), picture.values().end());
  if (largest == 0) return;
  const int factor = 255 / largest;
  for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(factor * value);
  plane.highest = plane.lowest + (plane.highest - plane.lowest) / factor;
}

}  // namespace

PrtAsset load_pca_asset(const fs::path& folder) {
  PrtAsset asset;
  asset.ranges_file = folder / pca_name;
  const json document = parse_json(asset.ranges_file, "kiln-compress", remedy);
  const Fields fields(asset.ranges_file.string(), "", document, remedy);

  // What stands in the file itself.
  fields.constant("format", "kiln-prt-pca");
  fields.integer("version", 1, 1);
  fields.constant("basis", "real-sh-orthonormal");
  asset.bands = fields.integer("bands", 1, most_asset_bands);
  asset.channels = fields.integer("channels", 1, most_asset_channels);
  asset.width = fields.integer("width", 1, largest_asset_side);
  asset.height = fields.integer("height", 1, largest_asset_side);
  asset.mesh_file = fields.safe_path("mesh");
  read_normals(fields, asset);
  PrtClusters& clusters = asset.clusters.emplace();
  clusters.length = asset.channels * asset.bands * asset.bands;
  clusters.count = fields.integer("clusters", 1, most_clusters);
  clusters.components = fields.integer("components", 1, clusters.length);
  const auto coefficients = static_cast<std::size_t>(asset.bands * asset.bands);
  const json& scale_list = list_of(fields, "coefficient_scales", coefficients, "numbers");
  std::vector<double> scales;
  for (const json& scale : scale_list) {
    if (!scale.is_number() || !std::isfinite(scale.get<float>()))
      fields.fail("coefficient_scales", scale.dump(), "finite numbers");
    scales.push_back(scale.get<double>());
  }
  const json& planes = list_of(fields, "planes", static_cast<std::size_t>(clusters.components), "planes");
  std::vector<int> bits;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Fields plane(fields.file(), "planes[" + std::to_string(k) + "]", planes[k], remedy);
    const auto [lowest, highest] = read_range(plane);
    asset.planes.push_back({plane.safe_path("file"), 0, static_cast<int>(k), lowest, highest});
    bits.push_back(plane.integer("bits", 8, 16));
    if (bits.back() != 8 && bits.back() != 16) plane.fail("bits", std::to_string(bits.back()), "8 or 16");
  }

  // What it names.
  asset.albedo = read_albedo(fields, folder, asset.width, asset.height, remedy);
  asset.mesh = read_asset_mesh(folder / asset.mesh_file);
  clusters.vectors = read_vectors(folder, fields, clusters, scales);
  if (clusters.count > 1) clusters.ids = read_ids(folder, fields, asset, clusters.count);
  asset.bits = *std::max_element(bits.begin(), bits.end());
  if (asset.bits == 8) {
    std::vector<std::string> files;
    for (const PrtPlane& plane : asset.planes) files.push_back(plane.file);
    auto pictures = read_grey_pictures<std::uint8_t>(folder, files, asset.width, asset.height, remedy);
    for (std::size_t k = 0; k < pictures.size(); ++k) spread(pictures[k], asset.planes[k]);
    asset.pictures = std::move(pictures);
  } else {
    asset.pictures = read_mixed_pictures(folder, asset, bits);
  }
  return asset;
}

void decode_transfer(const PrtAsset& asset, std::span<const std::uint32_t> texels, std::span<float> vectors) {
  const double white = asset.bits == 8 ? 255 : white16;
  const std::size_t length = static_cast<std::size_t>(asset.channels) * asset.bands * asset.bands;
  const auto decode = [&](const auto& pictures) {
    // In groups that stay in the first cache while plane after plane is read.
    constexpr std::size_t group = 64;
    for (std::size_t first = 0; first < texels.size(); first += group) {
      const std::size_t last = std::min(first + group, texels.size());
      for (std::size_t plane = 0; plane < pictures.size(); ++plane) {
        const auto lowest = static_cast<float>(asset.planes[plane].lowest),
                   step = static_cast<float>((asset.planes[plane].highest - asset.planes[plane].lowest) / white);
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

}  // namespace kiln
