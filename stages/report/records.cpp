// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/records.h"

#include <stdexcept>

#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/json.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

Json load_json(const fs::path& file, const std::string& stage) {
  if (!fs::exists(file))
    throw BadInput(file.string(), "does not exist", "the record of kiln-" + stage, "run kiln-" + stage + " first");
  Json json = Json::parse(read_text(file), nullptr, false);
  if (!json.is_object())
    throw BadInput(file.string(), "is no JSON object", "what kiln-" + stage + " writes",
                   "run kiln-" + stage + " again");
  return json;
}

StageRecord load_record(const fs::path& file, const std::string& stage) {
  Json json = load_json(file, stage);
  if (json.value("stage", Json()) != stage || !json.value("seconds", Json()).is_number())
    throw BadInput(file.string(), "has no stage and seconds", "the record of kiln-" + stage,
                   "run kiln-" + stage + " again");
  return {stage, file, std::move(json)};
}

/// Tells whether the record of the bake, if there is one, says that vertices were baked: atlas and normals have no part
/// in that.
bool is_baked_per_vertex(const fs::path& folder) {
  const fs::path record = layout::record(folder, "bake");
  if (!fs::is_regular_file(record)) return false;
  const Json json = Json::parse(read_text(record), nullptr, false);
  return json.is_object() && json.value("settings", Json::object()).value("per-vertex", false);
}

}  // namespace

const StageRecord& AssetFolder::stage_record(const std::string& stage) const {
  for (const StageRecord& record : records)
    if (record.stage == stage) return record;
  throw std::logic_error("no record of stage " + stage);
}

AssetFolder load_asset_folder(const fs::path& folder, const fs::path& compressed, const fs::path& probes) {
  if (!fs::is_directory(folder))
    throw BadInput(folder.string(), "is not a folder", "the folder of a baked asset", "run kiln build");
  AssetFolder asset;
  asset.folder = folder;
  // The path "out/bunny/" has an empty last part.
  const fs::path whole = fs::weakly_canonical(folder);
  asset.name = (whole.filename().empty() ? whole.parent_path() : whole).filename().string();
  const bool is_per_vertex = is_baked_per_vertex(folder);
  const std::vector<std::string> of_texels = {"simplify", "atlas", "normals", "bake"},
                                 of_vertices = {"simplify", "bake"};
  for (const std::string& stage : is_per_vertex ? of_vertices : of_texels)
    asset.records.push_back(load_record(layout::record(folder, stage), stage));
  asset.compressed = compressed;
  if (!compressed.empty()) asset.records.push_back(load_record(layout::record_in(compressed, "compress"), "compress"));
  if (!probes.empty()) asset.records.push_back(load_record(layout::record_in(probes, "probes"), "probes"));

  asset.baked = load_prt_description(asset.prt());
  const fs::path lod = layout::record(folder, "lod");
  if (!asset.baked.levels.empty() && fs::exists(lod)) asset.records.push_back(load_record(lod, "lod"));
  if (asset.baked.pca || asset.is_per_vertex() != is_per_vertex)
    throw BadInput(asset.baked.ranges_file.string(), "has no planes of coefficients in pictures",
                   "the ranges of kiln-bake for an atlas", "run kiln-bake again");
  return asset;
}

fs::path recorded_high_mesh(const AssetFolder& asset) {
  const Json inputs = asset.record("simplify").value("inputs", Json::object());
  const fs::path high = inputs.empty() ? fs::path() : path_of_text(inputs.begin().key());
  if (high.empty() || !fs::is_regular_file(high))
    throw BadInput(asset.stage_record("simplify").file.string(),
                   "names the high mesh '" + high.string() + "', which does not exist", "a mesh to compare with",
                   "give it by --high");
  return high;
}

}  // namespace kiln
