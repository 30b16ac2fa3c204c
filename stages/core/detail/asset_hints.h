#pragma once

#include <filesystem>

namespace kiln {

/// What earlier stages noted beside the atlas; 0 where they did not.
struct AssetHints {
  int size = 0;                   ///< atlas.json: texels along a side
  double hausdorff_distance = 0;  ///< simplify.json: from the high to the low mesh, object units
};

/// Reads atlas.json and simplify.json of `folder`, where there are any. Throws BadInput for a file that is no JSON
/// object.
AssetHints read_asset_hints(const std::filesystem::path& folder);

}  // namespace kiln
