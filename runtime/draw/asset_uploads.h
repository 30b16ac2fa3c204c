// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "gpu/gl_objects.h"
#include "runtime/decode/plane_weights.h"
#include "runtime/draw/surface_colors.h"
#include "runtime/light/incident_samples.h"

namespace kiln {

/// Coefficient planes per layer of a texture.
inline constexpr int planes_per_layer = 4;
int layer_count(std::size_t planes);

/// A texture, and its size on the GPU.
struct UploadedTexture {
  GlTexture texture;
  std::uint64_t bytes = 0;
};

/// Throws MachineLacks if the device's `limit` is less than `wanted`.
void require_at_most(GLenum limit, int wanted, const char* what);

/// Uploads the planes, four to a layer, normalised to 0..1, with bilinear lookup, clamped at the edges.
UploadedTexture upload_planes(const PrtAsset& asset);

/// Uploads the planes into layers of an array of textures from `first_layer` on, into its lower left corner.
void upload_planes_into(const PrtAsset& asset, const GlTexture& planes, int first_layer);

/// Sets bilinear lookup, clamped at the edges.
void set_linear_sampling(const GlTexture& texture);

/// Uploads the cluster of every texel, clamped at the edges like the planes; no texture if there is only one cluster.
UploadedTexture upload_cluster_ids(const PrtAsset& asset);

/// Reads the asset's normal map as object-space n * 0.5 + 0.5, 16 bits, whatever space it is in. Throws BadInput.
Image<std::uint16_t> object_normals(const PrtAsset& asset);

/// Uploads the asset's normal map as object-space n * 0.5 + 0.5, 16 bits. Throws BadInput.
UploadedTexture upload_normal_map(const PrtAsset& asset);

/// Returns how many levels the asset's albedo has room for: each halves the texels, down to those of the planes, for
/// which gutters are wide enough.
int albedo_levels(const PrtAsset& asset);

/// Albedo of an asset that does not know its own, before whatever a picture's settings say.
inline constexpr float unknown_albedo = 0.8f;

/// Uploads an albedo that the texture unit decodes from sRGB, with bilinear lookup between texels and linear between
/// levels; no texture if the picture is empty.
UploadedTexture upload_albedo(const Image<std::uint8_t>& picture, int levels = 1);

/// Uploads a map of opacity, with bilinear lookup; none where the picture is empty.
UploadedTexture upload_opacity(const Image<std::uint8_t>& picture);

/// The tables of what surfaces show by their albedo: a texture of three dimensions, float32, in which the functions'
/// tables stand one on another.
UploadedTexture upload_color_table(const ColorTable& table);

/// The numbers of measured materials, 8 bits, not interpolated; none where the picture is empty.
UploadedTexture upload_material_numbers(const Image<std::uint8_t>& numbers);

/// What measured materials show: a texel for each material and, one row on another, function; none without materials.
UploadedTexture upload_measured_colors(const LightReaders& materials);

/// Transfer vectors at the vertices, float32, in a buffer texture: four coefficients per texel, layer_count texels per
/// vertex. Those of a textured asset are looked up at the vertices' uvs.
struct UploadedVertexTransfer {
  GlBuffer buffer;
  GlTexture texture;
  std::uint64_t bytes = 0;
};
UploadedVertexTransfer upload_vertex_transfer(const PrtAsset& asset);

/// Uploads the light for shaders/common_prt.glsl: the result of cluster_weights for each incident-light sample and
/// cluster.
UploadedTexture upload_light(const std::vector<std::vector<PlaneWeights>>& samples);

/// Uploads weights one after another, each in weight_texels texels.
UploadedTexture upload_weights(std::span<const PlaneWeights> all);
std::size_t weight_texels(const PlaneWeights& weights);

/// The mesh, and the contributions of incident-light samples at its vertices.
struct UploadedMesh {
  GlBuffer positions, normals, uvs, contributions, indices;
  GlVertexArray vertices;
  GLsizei index_count = 0;
  std::size_t vertex_count = 0;
};
UploadedMesh upload_mesh(const TriangleMesh& mesh, const IncidentSamples& samples);

/// Corners of the triangles, three after three, for light at vertices (shaders/render_corners.vert).
struct UploadedCorners {
  GlBuffer positions, uvs;
  GlVertexArray vertices;
  GlTexture triangles;  ///< buffer texture of `mesh.indices`: a triangle's vertices per texel
  GLsizei count = 0;
  std::uint64_t bytes = 0;
};
UploadedCorners upload_corners(const TriangleMesh& mesh, const UploadedMesh& uploaded);

}  // namespace kiln
