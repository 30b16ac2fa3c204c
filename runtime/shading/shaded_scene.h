// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "mesh/placement.h"
#include "mesh/triangle_mesh.h"
#include "runtime/light/scene_lights.h"
#include "runtime/shading/shader_file.h"

namespace kiln {

/// Tests whether an asset's transfer is in planes, plain or of one cluster, which shaders of one's own share.
inline bool has_shadable_planes(const PrtAsset& asset) {
  return !asset.is_per_vertex() && !asset.planes.empty() && (!asset.clusters || asset.clusters->count == 1);
}

/// A mesh that nodes stand for. What is pointed at must outlive the scene.
struct ShadedMesh {
  const TriangleMesh* mesh = nullptr;  ///< with normals; uvs and colours if shaders look at them
  const PrtAsset* asset = nullptr;     ///< its maps, and its planes, which must be plain or of one cluster; null: none
  bool uses_planes = true;             ///< false: the asset's planes are left alone, and light is irradiance

  bool has_transfer() const { return asset != nullptr && uses_planes; }
};

/// A shader with values of its constants; those that are not named have the shader's defaults.
struct ShadedMaterial {
  std::string shader;
  std::map<std::string, ShaderValue> values = {};
};

struct ShadedNode {
  int mesh = 0;
  int material = 0;
  Placement placement;
  bool casts_shadow = true;  ///< whether shadow maps show it, which are fitted to those that do
};

/// Plane mirror: a node whose shader may look up the reflection map. It moves with the node.
struct MirrorPlane {
  int node = 0;  ///< not drawn in the map; the plane is in its object space
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  ///< unit, towards what is reflected
};

/// Nodes that shaders of their own shade under the same lights.
struct ShadedScene {
  std::vector<ShadedMesh> meshes;
  std::vector<ShadedMaterial> materials;
  std::vector<ShadedNode> nodes;
  /// Lights with a direction (is_direct), at most four, have shadow maps and highlights; all others arrive by
  /// precomputed transfer where there is some, else as irradiance. ShadingSettings::direct may give nodes with transfer
  /// all their light by it.
  SceneLights lights = {};
  std::optional<MirrorPlane> mirror = {};
  std::array<float, 3> background = {0, 0, 0};  ///< what the mirror shows where nothing is
};

/// Most lights with a direction; shading_light.glsl has the same number.
inline constexpr int most_direct_lights = 4;

}  // namespace kiln
