// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/site_export.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <system_error>

#include "asset/check.h"
#include "asset/prt_asset.h"
#include "asset/read_description.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "serve/viewer_files.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* page_name = "index.html";

/// Lists what ships of an asset, relative to the folder of all: its description last.
std::vector<std::string> shipped_paths(const fs::path& folder, const ListedAsset& asset) {
  if (asset.is_file()) return {asset.path};
  const fs::path relative = asset.path == "." ? fs::path() : fs::path(asset.path);
  const PrtDescription description = load_prt_description(folder / relative);
  std::vector<std::string> paths;
  for (const std::string& name : named_files(description)) paths.push_back((relative / name).generic_string());
  paths.push_back((relative / description.ranges_file.filename()).generic_string());
  return paths;
}

/// Tells whether a path stays in its folder.
bool stays_inside(const std::string& path) {
  const fs::path whole(path);
  return !whole.is_absolute() && std::ranges::none_of(whole, [](const fs::path& part) { return part == ".."; });
}

/// Lists the files of assets that an earlier export left in a folder, and those folders after them.
std::vector<std::string> earlier_paths(const fs::path& site) {
  std::vector<std::string> paths;
  std::error_code error;
  if (!fs::is_regular_file(site / asset_list_name, error)) return paths;
  const Json list = Json::parse(read_text(site / asset_list_name), nullptr, false);
  if (!list.is_object() || !list.contains("assets") || !list["assets"].is_array()) return paths;
  for (const Json& entry : list["assets"]) {
    if (!entry.is_object() || !entry.contains("path") || !entry["path"].is_string()) continue;
    const ListedAsset asset{"", path_of_url(entry["path"].get<std::string>())};
    if (!stays_inside(asset.path)) continue;
    try {
      for (const std::string& path : shipped_paths(site, asset)) paths.push_back(path);
    } catch (const BadInput&) {
      continue;  // somebody has removed or changed it: it is theirs now
    }
    for (fs::path up = asset.is_file() ? fs::path(asset.path).parent_path() : fs::path(asset.path);
         !up.empty() && up != "."; up = up.parent_path())
      paths.push_back(up.generic_string());
  }
  return paths;
}

}  // namespace

std::vector<ListedAsset> find_whole_assets(const fs::path& folder, const fs::path& site) {
  std::vector<ListedAsset> assets = list_assets(folder, site);
  if (assets.empty())
    throw BadInput(folder.string(), "has no asset", "folders of kiln-bake or kiln-compress in it",
                   "build one with 'kiln build', or name the folder that has them");
  for (const ListedAsset& asset : assets) {
    if (asset.is_file()) continue;
    for (const CheckedFolder& checked : check_folder(folder / asset.path))
      for (const BadInput& fault : checked.faults) throw fault;
  }
  std::error_code error;
  if (fs::exists(site / page_name, error) && !fs::exists(site / asset_list_name, error))
    throw BadInput((site / page_name).string(), "is a page of something else",
                   "a new folder, or one that kiln web-export has written", "name another folder with -o");
  return assets;
}

void add_site(OutputSet& outputs, const fs::path& folder, const std::vector<ListedAsset>& assets) {
  for (const ViewerFile& file : viewer_files()) outputs.add_text(std::string(file.path), std::string(file.bytes));
  for (const ListedAsset& asset : assets)
    for (const std::string& path : shipped_paths(folder, asset)) outputs.add_text(path, read_text(folder / path));
  outputs.add_text(asset_list_name, asset_list_text(assets));
  const std::set<std::string> added(outputs.names().begin(), outputs.names().end());
  for (const std::string& path : earlier_paths(outputs.folder()))
    if (!added.contains(path)) outputs.remove_stale(path);
}

Json site_metrics(const OutputSet& outputs, const std::vector<ListedAsset>& assets) {
  Json names = Json::array();
  for (const ListedAsset& asset : assets) names.push_back(asset.name);
  std::uintmax_t bytes = 0;
  for (const std::string& name : outputs.names()) bytes += fs::file_size(outputs.staging() / name);
  return {{"assets", names}, {"files", outputs.names().size()}, {"bytes", bytes}};
}

}  // namespace kiln
