// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/compress_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "asset/shipped.h"
#include "asset/write_asset.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/parallel.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Picture to be encoded, made only when its turn comes, so that few are in memory at a time.
struct Work {
  std::string name;
  std::function<Image<std::uint16_t>()> picture;
  int bits;
};

EncodedFiles encode_all(const std::vector<Work>& work, PngEffort effort) {
  EncodedFiles files(work.size());
  parallel_for(std::size_t{0}, work.size(), [&](std::size_t k) {
    files[k] = {work[k].name, encode_grey_png(work[k].picture(), work[k].bits, effort)};
  });
  return files;
}

/// Returns the description of `asset` except its planes.
PrtDescription shared_description(const PrtAsset& asset) {
  PrtDescription form = asset;
  form.albedo.picture = {};
  form.albedo.measured_at = {};
  form.planes.clear();
  return form;
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

}  // namespace

EncodedFiles encode_pca(const StoredPca& stored, const TransferSource& source, PngEffort effort) {
  const PrtAsset& asset = source.asset();
  PrtDescription form = shared_description(asset);
  PcaTables& tables = form.pca.emplace();
  std::vector<Work> work;
  for (std::size_t j = 0; j < stored.weights.size(); ++j) {
    const StoredPicture& plane = stored.weights[j];
    form.planes.push_back({weight_file(static_cast<int>(j)), 0, static_cast<int>(j), plane.range, plane.bits});
    work.push_back({form.planes.back().file, [&plane] { return plane.values; }, plane.bits});
  }
  tables.vectors_file = vectors_name;
  work.push_back({tables.vectors_file, [&] { return stored.vectors; }, 16});
  Image<std::uint16_t> ids;
  tables.clusters = stored.decoded.model.clusters();
  if (tables.clusters > 1) {
    ids = Image<std::uint16_t>(asset.width, asset.height, 1);
    std::copy(stored.decoded.ids.begin(), stored.decoded.ids.end(), ids.values().begin());
    tables.ids_file = cluster_ids_name;
    work.push_back({tables.ids_file, [&] { return ids; }, 8});
  }
  for (int i = 0; i < asset.bands * asset.bands; ++i)
    tables.coefficient_scales.push_back(1 / static_cast<double>(source.scale()[i]));
  for (const StoredPicture& row : stored.vector_rows) tables.vector_ranges.push_back(row.range);
  EncodedFiles files = encode_all(work, effort);
  files.emplace_back(pca_name, description_text(form));
  return files;
}

PrtAsset with_eight_bits(const PrtAsset& asset) {
  if (asset.bits == 8) return asset;
  PrtAsset narrow = asset;
  narrow.bits = 8;
  for (PrtPlane& plane : narrow.planes) plane.bits = 8;
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
  PrtDescription form = shared_description(asset);
  form.bits = bits;
  std::vector<Work> work;
  for (std::size_t k = 0; k < asset.planes.size(); ++k) {
    PrtPlane plane = asset.planes[k];
    plane.file = plane_file(plane.channel, plane.coefficient);
    plane.bits = bits;
    work.push_back({plane.file, [&picture, k] { return picture(k); }, bits});
    form.planes.push_back(plane);
  }
  EncodedFiles files = encode_all(work, effort);
  files.emplace_back(ranges_name, description_text(form));
  return files;
}

Json save_compressed(OutputSet& outputs, const fs::path& input, const PrtAsset& asset, const CompressResult& result) {
  copy_into(outputs, input, asset.mesh_file);
  for (const PrtLevel& level : asset.levels) copy_into(outputs, input, level.mesh_file);
  if (!asset.normals_file.empty())
    copy_into(outputs, input, asset.normals_file);
  else
    outputs.remove_stale(normal_map_name);
  if (!asset.albedo.file.empty())
    copy_into(outputs, input, asset.albedo.file);
  else
    outputs.remove_stale(albedo_map_name);
  if (!asset.albedo.measured_file.empty())
    copy_into(outputs, input, asset.albedo.measured_file);
  else
    outputs.remove_stale(measured_map_name);
  if (!asset.opacity_file.empty())
    copy_into(outputs, input, asset.opacity_file);
  else
    outputs.remove_stale(opacity_map_name);
  for (const PrtMap& map : asset.maps) copy_into(outputs, input, map.file);
  for (const auto& [name, bytes] : result.files) {
    const fs::path file = outputs.add(name);
    std::ofstream stream(file, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream.flush()) fail_to_write(file, "");
  }
  remove_stale_planes(outputs);

  // Measure what was written.
  const TransferSource source(asset);
  const ErrorSpread spread = spread_of_decoded(load_prt_asset(outputs.staging()), source);
  std::uint64_t coefficient_bytes = fs::file_size(asset.ranges_file);
  for (const PrtPlane& plane : asset.planes) coefficient_bytes += fs::file_size(input / plane.file);
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
          {"bytes_in", shipped_bytes(input)},
          {"bytes_out", shipped_bytes(outputs.staging())},
          {"bytes_per_texel_in", static_cast<double>(coefficient_bytes) / texels},
          {"bytes_per_texel_out", static_cast<double>(result.chosen.bytes) / texels},
          {"lookups_in", (asset.planes.size() + 3) / 4},
          {"lookups_out", result.chosen.lookups},
          {"border_share", result.border_share},
          {"plain", result.plain.to_json()},
          {"chosen", chosen},
          {"candidates", tried}};
}

}  // namespace kiln
