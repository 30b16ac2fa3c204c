#include "compress/compress_files.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <tbb/parallel_for.h>

#include "base/errors.h"
#include "base/outputs.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* basis_of_files = "real-sh-orthonormal";

/// A picture to be encoded, made when its turn comes, so that few are in memory at a time.
struct Work {
  std::string name;
  std::function<Image<std::uint16_t>()> picture;
  int bits;
};

EncodedFiles encode_all(const std::vector<Work>& work, PngEffort effort) {
  EncodedFiles files(work.size());
  tbb::parallel_for(std::size_t{0}, work.size(), [&](std::size_t k) {
    files[k] = {work[k].name, encode_grey_png(work[k].picture(), work[k].bits, effort)};
  });
  return files;
}

Json shared_head(const char* format, const PrtAsset& asset) {
  return {{"format", format}, {"version", 1}, {"bands", asset.bands}, {"channels", asset.channels}};
}

void add_names(Json& head, const PrtAsset& asset) {
  head["width"] = asset.width;
  head["height"] = asset.height;
  head["basis"] = basis_of_files;
  head["mesh"] = asset.mesh_file;
  if (!asset.normals_file.empty()) head["normals"] = asset.normals_file;
  if (asset.normal_space == NormalSpace::tangent) head["normal_space"] = "tangent";
  if (const Eigen::Vector3d& origin = asset.mesh.frame.origin; !origin.isZero(0))
    head["origin"] = {origin.x(), origin.y(), origin.z()};
  const Eigen::Vector3f& constant = asset.albedo.constant;
  if (!asset.albedo.file.empty())
    head["albedo"] = asset.albedo.file;
  else if (asset.albedo.known)
    head["albedo"] = {constant.x(), constant.y(), constant.z()};
}

std::uint8_t eight_of_sixteen_bits(std::uint16_t value) { return static_cast<std::uint8_t>((value + 128) / 257); }

void copy_into(OutputSet& outputs, const fs::path& input, const std::string& name) {
  if (name.find('/') != std::string::npos) fs::create_directories((outputs.staging() / name).parent_path());
  std::error_code error;
  const fs::path to = outputs.add(name);
  fs::copy_file(input / name, to, fs::copy_options::overwrite_existing, error);
  if (error)
    throw BadInput((input / name).string(), "cannot be copied (" + error.message() + ")", "a file of the asset",
                   "bake the asset again with kiln-bake");
}

/// Planes, weights and descriptions of an earlier run that are not among `written`.
void remove_stale_files(OutputSet& outputs, const EncodedFiles& written) {
  for (const auto& entry : fs::directory_iterator(outputs.folder())) {
    const std::string name = entry.path().filename().string();
    const bool picture = name.ends_with(".png") && (name.starts_with("coeff_") || name.starts_with("weight_") ||
                                                    name == "vectors.png" || name == "clusters.png");
    if (!picture && name != ranges_name && name != pca_name) continue;
    if (std::none_of(written.begin(), written.end(), [&](const auto& file) { return file.first == name; }))
      outputs.remove_stale(name);
  }
}

}  // namespace

EncodedFiles encode_pca(const StoredPca& stored, const TransferSource& source, PngEffort effort) {
  const PrtAsset& asset = source.asset();
  std::vector<Work> work;
  Json planes = Json::array();
  for (std::size_t j = 0; j < stored.weights.size(); ++j) {
    const StoredPicture& plane = stored.weights[j];
    work.push_back({fmt::format("weight_{:02d}.png", j), [&plane] { return plane.values; }, plane.bits});
    planes.push_back({{"file", work.back().name}, {"bits", plane.bits}, {"min", plane.lowest}, {"max", plane.highest}});
  }
  work.push_back({"vectors.png", [&] { return stored.vectors; }, 16});
  Image<std::uint16_t> ids;
  const int clusters = stored.decoded.model.clusters();
  if (clusters > 1) {
    ids = Image<std::uint16_t>(asset.width, asset.height, 1);
    std::copy(stored.decoded.ids.begin(), stored.decoded.ids.end(), ids.values().begin());
    work.push_back({"clusters.png", [&] { return ids; }, 8});
  }
  EncodedFiles files = encode_all(work, effort);

  Json head = shared_head("kiln-prt-pca", asset);
  add_names(head, asset);
  head["clusters"] = clusters;
  head["components"] = stored.weights.size();
  if (clusters > 1) head["cluster_ids"] = "clusters.png";
  head["coefficient_scales"] = Json::array();
  for (int i = 0; i < asset.bands * asset.bands; ++i)
    head["coefficient_scales"].push_back(1 / static_cast<double>(source.scale()[i]));
  head["vectors_file"] = "vectors.png";
  head["vector_ranges"] = Json::array();
  for (const StoredPicture& row : stored.vector_rows)
    head["vector_ranges"].push_back({{"min", row.lowest}, {"max", row.highest}});
  head["planes"] = planes;
  files.emplace_back(pca_name, head.dump(2) + "\n");
  return files;
}

PrtAsset with_eight_bits(const PrtAsset& asset) {
  if (asset.bits == 8) return asset;
  PrtAsset narrow = asset;
  narrow.bits = 8;
  std::vector<Image<std::uint8_t>> pictures;
  for (const Image<std::uint16_t>& wide : std::get<std::vector<Image<std::uint16_t>>>(asset.pictures)) {
    Image<std::uint8_t>& picture = pictures.emplace_back(asset.width, asset.height, 1);
    std::transform(wide.values().begin(), wide.values().end(), picture.values().begin(), eight_of_sixteen_bits);
  }
  narrow.pictures = std::move(pictures);
  return narrow;
}

EncodedFiles encode_planes(const PrtAsset& asset, int bits, PngEffort effort) {
  const auto picture = [&](std::size_t k) {
    Image<std::uint16_t> wide(asset.width, asset.height, 1);
    const auto copy = [&](const auto& planes) {
      std::copy(planes[k].values().begin(), planes[k].values().end(), wide.values().begin());
    };
    std::visit(copy, asset.pictures);
    if (bits < asset.bits)
      std::transform(wide.values().begin(), wide.values().end(), wide.values().begin(), eight_of_sixteen_bits);
    return wide;
  };
  std::vector<Work> work;
  Json planes = Json::array();
  for (std::size_t k = 0; k < asset.planes.size(); ++k) {
    const PrtPlane& plane = asset.planes[k];
    work.push_back({fmt::format("coeff_{}_{:02d}.png", plane.channel, plane.coefficient),
                    [&picture, k] { return picture(k); }, bits});
    planes.push_back({{"file", work.back().name},
                      {"channel", plane.channel},
                      {"coefficient", plane.coefficient},
                      {"min", plane.lowest},
                      {"max", plane.highest}});
  }
  EncodedFiles files = encode_all(work, effort);
  Json head = shared_head("kiln-prt", asset);
  head["bits"] = bits;
  add_names(head, asset);
  head["planes"] = planes;
  files.emplace_back(ranges_name, head.dump(2) + "\n");
  return files;
}

Json save_compressed(OutputSet& outputs, const fs::path& input, const PrtAsset& asset, const CompressResult& result) {
  copy_into(outputs, input, asset.mesh_file);
  if (!asset.normals_file.empty()) copy_into(outputs, input, asset.normals_file);
  if (!asset.albedo.file.empty())
    copy_into(outputs, input, asset.albedo.file);
  else
    outputs.remove_stale("albedo.png");
  for (const auto& [name, bytes] : result.files) {
    const fs::path file = outputs.add(name);
    std::ofstream stream(file, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream.flush()) fail_to_write(file, "");
  }
  remove_stale_files(outputs, result.files);

  // Measure what was written.
  const TransferSource source(asset);
  const ErrorSpread spread = spread_of_decoded(load_prt_asset(outputs.staging()), source);
  std::uint64_t bytes_in = fs::file_size(asset.ranges_file);
  for (const PrtPlane& plane : asset.planes) bytes_in += fs::file_size(input / plane.file);
  const auto texels = static_cast<double>(source.covered().size());
  Json tried = Json::array();
  for (const CompressCandidate& candidate : result.tried) tried.push_back(candidate.to_json());
  Json chosen = result.chosen.to_json();
  chosen["error"] = spread.mean;
  chosen["texel_error"] = spread.texel;
  chosen["border_jump"] = spread.border;
  return {{"width", asset.width},
          {"height", asset.height},
          {"texels", source.covered().size()},
          {"target_error", result.target_error},
          {"error", spread.mean},
          {"texel_error", spread.texel},
          {"texel_error_bound", most_texel_error},
          {"border_jump", spread.border},
          {"border_jump_bound", most_border_jump},
          {"bytes_in", bytes_in},
          {"bytes_out", result.chosen.bytes},
          {"bytes_per_texel_in", static_cast<double>(bytes_in) / texels},
          {"bytes_per_texel_out", static_cast<double>(result.chosen.bytes) / texels},
          {"lookups_in", (asset.planes.size() + 3) / 4},
          {"lookups_out", result.chosen.lookups},
          {"border_share", result.border_share},
          {"plain", result.plain.to_json()},
          {"chosen", chosen},
          {"candidates", tried}};
}

}  // namespace kiln
