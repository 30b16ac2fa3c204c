// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kiln {

/// Asset in a folder that is shown in a browser.
struct ListedAsset {
  std::string name;  ///< for people: "bunny" where the path is "bunny/prt"
  std::string path;  ///< relative to the folder, "." for itself; a folder of planes, or a .glb with KILN_prt

  bool is_file() const { return path.ends_with(".glb"); }
};

/// Name of the list beside the viewer page.
inline constexpr const char* asset_list_name = "assets.json";

/// Finds the assets in `folder` and three levels beneath it, sorted by path: folders that have ranges.json or pca.json,
/// and .glb files of `kiln export`. Hidden folders, links to folders, `but_not` and what is in it are left out, and so
/// are names that are not UTF-8, which no address can have. Throws BadInput where `folder` is no folder.
std::vector<ListedAsset> list_assets(const std::filesystem::path& folder, const std::filesystem::path& but_not = {});

/// Escapes a path for an address, bytes but letters, digits and -._~/ as %XX; and resolves escapes.
std::string url_of_path(const std::string& path);
std::string path_of_url(std::string_view url);

/// Makes assets.json: {"assets": [{"name": "bunny", "path": "bunny/prt"}]}, with paths as relative addresses.
std::string asset_list_text(const std::vector<ListedAsset>& assets);

}  // namespace kiln
