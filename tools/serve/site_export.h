// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "base/json_fwd.h"
#include "base/outputs.h"
#include "serve/asset_list.h"

namespace kiln {

/// Lists the assets of `folder` that a site in `site` will show. Throws BadInput where there is none, where one of them
/// is damaged, and where `site` has a page that is not of an earlier export.
std::vector<ListedAsset> find_whole_assets(const std::filesystem::path& folder, const std::filesystem::path& site);

/// Adds the viewer page, the files that ship of each asset, and assets.json, the last of all. Has commit() remove the
/// files of assets that an earlier export into the same folder had.
void add_site(OutputSet& outputs, const std::filesystem::path& folder, const std::vector<ListedAsset>& assets);

/// Tells what was added, before commit(): assets, files, bytes.
Json site_metrics(const OutputSet& outputs, const std::vector<ListedAsset>& assets);

}  // namespace kiln
