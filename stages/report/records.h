// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/asset_layout.h"
#include "base/json.h"

namespace kiln {

/// Record and folder of one stage.
struct StageRecord {
  std::string stage;
  std::filesystem::path file;
  Json json;
};

/// Folder of an asset that has passed all stages up to the bake.
struct AssetFolder {
  std::filesystem::path folder;
  std::string name;                  ///< of the asset: the folder's
  std::vector<StageRecord> records;  ///< simplify, atlas, normals, bake (per vertex: simplify and bake); compress and
                                     ///< probes where given
  PrtDescription baked;              ///< what ranges.json says
  std::filesystem::path compressed;  ///< what kiln-compress made of it; empty: nothing

  std::filesystem::path prt() const { return layout::stage_folder(folder, "bake"); }
  bool is_per_vertex() const { return baked.vertices > 0; }
  const StageRecord& stage_record(const std::string& stage) const;
  const Json& record(const std::string& stage) const { return stage_record(stage).json; }
};

/// Reads the stages' records and ranges.json, and the records in `compressed`, an output folder of kiln-compress, and
/// in `probes`, one of kiln-probes, unless those are empty. Of an asset baked per vertex atlas and normals have none.
/// Throws BadInput where one is missing or is not what its
/// stage writes.
AssetFolder load_asset_folder(const std::filesystem::path& folder, const std::filesystem::path& compressed = {},
                              const std::filesystem::path& probes = {});

/// Returns the high mesh that the simplification started from, as its record names it. Throws BadInput where that file
/// no longer exists.
std::filesystem::path recorded_high_mesh(const AssetFolder& asset);

}  // namespace kiln
