// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "runtime/draw/technique.h"
#include "view/state/view_state.h"

namespace kiln {

/// Where the forms of one asset lie.
struct AssetFolders {
  std::string name;                  ///< for the window's title
  std::filesystem::path plain;       ///< of kiln-bake; empty: none
  std::filesystem::path compressed;  ///< of kiln-compress; empty: none
};

/// Finds them: `folder` is such a folder itself, or an asset's folder with prt/ in it, beside which a compressed form
/// may lie (the first by name of the folders that have a pca.json). `compressed` is named by itself, or empty. Throws
/// BadInput where there is nothing to show.
AssetFolders find_asset_folders(const std::filesystem::path& folder, const std::filesystem::path& compressed);

/// An asset as kiln-bake made it, and as kiln-compress did; one of the two, or both.
struct AssetForms {
  std::optional<PrtAsset> plain, compressed;

  const PrtAsset& main() const { return plain ? *plain : *compressed; }

  /// The form that a technique draws.
  const PrtAsset& of(Technique technique) const;
};

/// Reads them. Throws BadInput for what kiln-render would not draw either.
AssetForms load_asset_forms(const AssetFolders& folders);

/// What they allow. `has_environment` is left as it is.
ViewLimits limits_of(const AssetForms& forms);

}  // namespace kiln
