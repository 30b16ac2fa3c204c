// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "gpu/gl_objects.h"
#include "runtime/decode/plane_weights.h"
#include "runtime/light/incident_samples.h"

namespace kiln {

/// Four coefficient planes to a layer of a texture.
inline constexpr int planes_per_layer = 4;
int layer_count(std::size_t planes);

/// A texture and what it takes on the GPU.
struct UploadedTexture {
  GlTexture texture;
  std::uint64_t bytes = 0;
};

/// Throws MachineLacks where the device's `limit` is less than `wanted`.
void require_at_most(GLenum limit, int wanted, const char* what);

/// The planes, four to a layer, normalised to 0..1, looked up bilinearly, clamped at the edges.
UploadedTexture upload_planes(const PrtAsset& asset);

/// The cluster of every texel, clamped at the edges as the planes are; none where there is one cluster.
UploadedTexture upload_cluster_ids(const PrtAsset& asset);

/// The asset's normal map as object-space n * 0.5 + 0.5, 16 bits. Throws BadInput.
UploadedTexture upload_normal_map(const PrtAsset& asset);

/// An albedo that the texture unit decodes from sRGB, looked up bilinearly; none of no picture.
UploadedTexture upload_albedo(const Image<std::uint8_t>& picture);

/// Transfer vectors at the vertices, float32, four coefficients to a texel of a buffer texture, layer_count texels to a
/// vertex: looked up in the texels at the vertices' uvs, or those of an asset that is baked per vertex.
struct UploadedVertexTransfer {
  GlBuffer buffer;
  GlTexture texture;
  std::uint64_t bytes = 0;
};
UploadedVertexTransfer upload_vertex_transfer(const PrtAsset& asset);

/// The light of shaders/common_prt.glsl: of every incident-light sample, of every cluster, what cluster_weights gives.
UploadedTexture upload_light(const std::vector<std::vector<PlaneWeights>>& samples);

/// The mesh, and the contributions of incident-light samples at its vertices.
struct UploadedMesh {
  GlBuffer positions, normals, uvs, contributions, indices;
  GlVertexArray vertices;
  GLsizei index_count = 0;
  std::size_t vertex_count = 0;
};
UploadedMesh upload_mesh(const TriangleMesh& mesh, const IncidentSamples& samples);

}  // namespace kiln
