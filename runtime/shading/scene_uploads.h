// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "gpu/gl_objects.h"
#include "runtime/draw/asset_uploads.h"
#include "runtime/shading/shaded_scene.h"
#include "runtime/shading/shader_glsl.h"
#include "runtime/shading/shading_settings.h"

namespace kiln {

/// A mesh on the GPU, with its colours.
struct UploadedShape {
  UploadedMesh mesh;
  GlBuffer colors;
};

/// Uploads meshes: attributes of shading_surface.vert. A mesh that several nodes stand for is there once.
std::vector<UploadedShape> upload_shapes(const std::vector<ShadedMesh>& meshes);

/// Values of all materials in one buffer, which the uniform parameters of each frame are written into.
struct UploadedMaterials {
  GlBuffer values;
  std::vector<int> shaders;              ///< of each material
  std::vector<int> first;                ///< first value of each material
  std::vector<int> first_of_shader;      ///< first value of each shader's materials, which stand together
  std::vector<int> materials_of_shader;  ///< number of these
};

/// Uploads constants. Throws WrongUsage for a shader or a constant that is not there, a value out of its range, and
/// more values than a buffer texture is sure to hold.
UploadedMaterials upload_materials(const std::vector<ShadedMaterial>& materials, const ShaderGlsl& glsl);

/// Uploads the pictures of the shaders, with mip maps, in the order of their texture units. Throws BadInput.
std::vector<GlTexture> upload_pictures(const ShaderGlsl& glsl);

/// Planes of all assets in one array of layers, and the light of each node.
struct UploadedPlanes {
  struct Place {
    int first_layer = 0, layers = 0;
    Eigen::Vector4f place = {1, 1, 0, 0};  ///< scale of uvs, half a texel
  };
  GlTexture planes;
  std::vector<Place> places;  ///< of each mesh; without layers where it has no planes
};

/// Uploads planes. Throws WrongUsage for an asset without planes or with several clusters, MachineLacks.
UploadedPlanes upload_all_planes(const std::vector<ShadedMesh>& meshes);

/// Light vectors of a node, one for each of its points; empty for a node without transfer.
using NodeLight = std::vector<LightCoefficients>;

/// Computes the light that arrives at each node with transfer, as if it stood alone; `direct`: whether that of lights
/// with a direction is among it.
std::vector<NodeLight> unshadowed_light(const ShadedScene& scene, int incident_samples, DirectLightBy direct);

/// Light of all nodes with planes: a texture as of upload_weights.
struct UploadedNodeLight {
  GlTexture texture;
  std::vector<int> first_texel;  ///< of each node
};
UploadedNodeLight upload_node_light(const ShadedScene& scene, const std::vector<NodeLight>& light);

}  // namespace kiln
