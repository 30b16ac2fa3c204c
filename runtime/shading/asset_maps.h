// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gpu/gl_objects.h"
#include "runtime/shading/shaded_scene.h"

namespace kiln {

/// Pictures of one kind, a layer each in its lower left corner; beyond it their border is repeated, so that filters and
/// levels of the mip map find nothing else.
struct PackedMaps {
  GlTexture texture;                   ///< none where there is no picture
  std::vector<int> layers;             ///< of each mesh; -1: none
  std::vector<Eigen::Vector2f> parts;  ///< of each mesh: of the layer's sides
};

/// Maps that ship with the assets of a scene, as shading_maps.glsl reads them.
struct AssetMaps {
  PackedMaps albedo, normals, opacity;
  std::vector<Eigen::Vector3f> colors;  ///< of each mesh: linear, which the albedo's picture is multiplied by
  std::vector<int> albedo_levels;       ///< of each mesh: levels of its mip map
  std::vector<int> albedo_texels;       ///< of each mesh: of the longer side
};

/// Uploads maps. An asset that does not know its albedo is grey, 0.8, as for kiln-render; a mesh without asset is
/// white. Throws BadInput for a normal map that cannot be read, MachineLacks.
AssetMaps upload_asset_maps(std::span<const ShadedMesh> meshes);

}  // namespace kiln
