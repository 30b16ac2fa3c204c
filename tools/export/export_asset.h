// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "base/json_fwd.h"
#include "export/glb_mesh.h"

namespace kiln {

struct ExportSettings {
  GlbMeshForm form = GlbMeshForm::draco;
  bool sh1 = false;  ///< make the pictures of bands 0 and 1, too
};

/// Asset as glTF.
struct ExportedAsset {
  std::string glb;  ///< the bytes of the file
  /// Bytes of the pictures that `sh1` asks for, in the order of sky_picture_names().
  std::optional<std::array<std::string, 4>> sky_pictures;
  Json metrics;  ///< vertices, triangles, textures, planes, bytes, what is left out
  /// What the file lacks of the asset, as sentences without a full stop.
  std::vector<std::string> warnings;
};

/// Makes a glTF file of the asset in `folder`, of kiln-bake or kiln-compress: a mesh, a material that any viewer shows,
/// and the extension KILN_prt (docs/format.md). `file` is what it will be written to: its stem names the nodes, and
/// `extras.kiln` of the material is the way from its folder to the asset's manifest. Throws BadInput for an asset that
/// is damaged, or whose transfer is neither of one nor of three channels, and for `sh1` of an asset baked per vertex.
ExportedAsset export_asset(const std::filesystem::path& folder, const std::filesystem::path& file,
                           const ExportSettings& settings);

}  // namespace kiln
