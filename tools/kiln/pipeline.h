// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// One asset of pipeline.yaml. Paths are as written there: absolute, or relative to its folder.
struct Asset {
  std::string name;
  std::string where;              ///< "FILE:LINE" of its name
  std::filesystem::path mesh;     ///< a mesh file; empty: the mesh is `member` of `archive`
  std::filesystem::path archive;  ///< a tar file, compressed or not
  std::string member;
  std::string square;       ///< half the side of a square that is the mesh, instead of a file
  bool on_request = false;  ///< whether it is built only when named
  AssetSettings settings;
  AssetSettings setting_lines;       ///< "FILE:LINE" of each setting
  std::vector<std::string> budgets;  ///< "simplify.hausdorff<=0.012"
};

struct Pipeline {
  std::filesystem::path file;
  std::filesystem::path folder;  ///< folder of `file`, in which commands run
  std::filesystem::path output;  ///< relative to `folder`, or absolute
  std::vector<Asset> assets;
  std::map<std::string, std::string> places;  ///< places of the assets of the scene, written as for kiln-bake --place
};

/// Reads and checks a pipeline file and those that it includes, as far as possible without the meshes. Throws BadInput
/// that names the line of whatever is unknown or cannot work: an unknown key, a key given twice, a value out of range,
/// a budget for a metric that no stage writes, an asset without a mesh, a pattern that no file matches, a scene of
/// assets that do not exist.
Pipeline load_pipeline(const std::filesystem::path& file);

/// Returns the assets of these names or, without names, those that are not built on request only. Throws WrongUsage for
/// a name that is not in the pipeline.
std::vector<const Asset*> select_assets(const Pipeline& pipeline, const std::vector<std::string>& names);

}  // namespace kiln
