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

/// Folders of the forms of one asset.
struct AssetFolders {
  std::string name;                  ///< title of the window
  std::filesystem::path plain;       ///< folder of kiln-bake; empty: none
  std::filesystem::path compressed;  ///< folder of kiln-compress; empty: none
};

/// Finds the forms: `folder` is one itself, or an asset's folder with prt/ in it, beside which a compressed form may
/// lie (the first by name of the folders that have a pca.json). `compressed` names one explicitly, or is empty. Throws
/// BadInput if there is nothing to show.
AssetFolders find_asset_folders(const std::filesystem::path& folder, const std::filesystem::path& compressed);

/// An asset as kiln-bake made it, as kiln-compress did, or both.
struct AssetForms {
  std::optional<PrtAsset> plain, compressed;

  const PrtAsset& main() const { return plain ? *plain : *compressed; }

  /// Returns the form that a technique draws.
  const PrtAsset& of(Technique technique) const;
};

/// Reads the forms. Throws BadInput for folders that kiln-render would not draw either.
AssetForms load_asset_forms(const AssetFolders& folders);

/// Finds what the forms allow. Leaves `has_environment` as it is.
ViewLimits limits_of(const AssetForms& forms);

}  // namespace kiln
