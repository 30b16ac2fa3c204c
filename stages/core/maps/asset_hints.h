// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/import_settings.h"

namespace kiln {

/// Facts that earlier stages recorded beside the atlas; 0 where they did not.
struct AssetHints {
  int width = 0;  ///< atlas.json: size that the atlas was packed for, texels
  int height = 0;
  int gap_texels = 0;                   ///< atlas.json: least distance between two charts, or a chart and the border
  int position_bits = 0, uv_bits = 0;   ///< atlas.json: of the atlas's file
  double hausdorff_distance = 0;        ///< simplify.json: from the high to the low mesh, object units
  ImportSettings import = {};           ///< simplify.json: import settings of the high mesh, which later stages reuse
  std::filesystem::path low_file = {};  ///< simplify.json: the file of a low mesh that was taken as it is; else empty
  ImportSettings low_import = {};       ///< how that file was read
  std::vector<std::string> warnings = {};  ///< simplify.json: warnings about the high mesh
};

/// Reads atlas.json and simplify.json of `folder`, where there are any. Throws BadInput for a file that is no JSON
/// object.
AssetHints read_asset_hints(const std::filesystem::path& folder);

}  // namespace kiln
