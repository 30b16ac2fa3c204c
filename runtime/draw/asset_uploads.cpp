// SPDX-License-Identifier: MIT
#include "runtime/draw/asset_uploads.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>

#include "base/errors.h"
#include "gpu/program.h"
#include "image/image_file.h"
#include "maps/detail_maps.h"
#include "maps/footprint.h"

namespace kiln {

namespace {

// Width of the light texture of shaders/common_prt.glsl.
constexpr int light_width = 1024;

// Attribute locations of shaders/render_*.vert.
constexpr GLuint position_location = 0, uv_location = 1, normal_location = 2, contributions_location = 3;

/// Packs four planes into the channels of one picture; channels without a plane are 0.
template <class Value>
std::vector<Value> interleaved(const std::vector<Image<Value>>& planes, std::size_t first) {
  std::vector<Value> texels(planes_per_layer * planes[first].values().size(), Value{0});
  for (std::size_t k = first; k < std::min(planes.size(), first + planes_per_layer); ++k)
    for (std::size_t i = 0; i < planes[k].values().size(); ++i)
      texels[planes_per_layer * i + k - first] = planes[k].values()[i];
  return texels;
}

void set_sampling(const GlTexture& texture, GLint filter) {
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, filter);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void add_attribute(GLuint vertices, GLuint location, const GlBuffer& buffer, int components, int offset = 0,
                   int stride = 0) {
  constexpr int bytes = sizeof(float);
  glVertexArrayVertexBuffer(vertices, location, buffer.name(), offset * bytes,
                            (stride > 0 ? stride : components) * bytes);
  glVertexArrayAttribFormat(vertices, location, components, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vertices, location, location);
  glEnableVertexArrayAttrib(vertices, location);
}

/// Looks up transfer vectors at the vertices of a textured asset, bilinearly at their uvs.
std::vector<float> looked_up_transfer(const PrtAsset& asset) {
  const std::size_t length = asset.vector_length();
  std::vector<float> vectors(asset.mesh.positions.size() * length, 0.f), texels(4 * length);
  for (std::size_t v = 0; v < asset.mesh.positions.size(); ++v) {
    const Footprint footprint(asset.mesh.uvs[v], asset.width, asset.height);
    decode_transfer(asset, footprint.texels, texels);
    for (std::size_t corner = 0; corner < 4; ++corner)
      for (std::size_t i = 0; i < length; ++i)
        vectors[v * length + i] += footprint.weights[corner] * texels[corner * length + i];
  }
  return vectors;
}

/// Uploads a picture of one byte a texel; none where it is empty.
UploadedTexture upload_bytes(const Image<std::uint8_t>& picture, GLenum stored_as, GLenum given_as, GLint filter) {
  if (picture.values().empty()) return {};
  require_at_most(GL_MAX_TEXTURE_SIZE, std::max(picture.width(), picture.height()), "textures with a side");
  UploadedTexture map{make_texture(GL_TEXTURE_2D), picture.values().size()};
  glTextureStorage2D(map.texture.name(), 1, stored_as, picture.width(), picture.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(map.texture.name(), 0, 0, 0, picture.width(), picture.height(), given_as, GL_UNSIGNED_BYTE,
                      picture.values().data());
  set_sampling(map.texture, filter);
  check_gl("uploading a map of bytes");
  return map;
}

}  // namespace

int layer_count(std::size_t planes) { return static_cast<int>((planes + planes_per_layer - 1) / planes_per_layer); }

std::size_t weight_texels(const PlaneWeights& weights) {
  const auto numbers = static_cast<std::size_t>(weights.scales.rows());
  return (numbers + 3) / 4 + numbers * static_cast<std::size_t>(layer_count(weights.scales.cols()));
}

void require_at_most(GLenum limit, int wanted, const char* what) {
  GLint most = 0;
  glGetIntegerv(limit, &most);
  if (wanted > most)
    throw MachineLacks(std::string("the GL device takes ") + what + " of at most " + std::to_string(most) + ", and " +
                       std::to_string(wanted) + " are needed; ask for less, or try --gl-device software");
}

void upload_planes_into(const PrtAsset& asset, const GlTexture& planes, int first_layer) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const auto upload = [&](const auto& pictures) {
    for (int layer = 0; layer < layer_count(asset.planes.size()); ++layer)
      glTextureSubImage3D(planes.name(), 0, 0, 0, first_layer + layer, asset.width, asset.height, 1, GL_RGBA,
                          asset.bits == 16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                          interleaved(pictures, planes_per_layer * static_cast<std::size_t>(layer)).data());
  };
  std::visit(upload, asset.pictures);
}

void set_linear_sampling(const GlTexture& texture) { set_sampling(texture, GL_LINEAR); }

UploadedTexture upload_planes(const PrtAsset& asset) {
  const int layers = layer_count(asset.planes.size());
  require_at_most(GL_MAX_TEXTURE_SIZE, std::max(asset.width, asset.height), "textures with a side");
  require_at_most(GL_MAX_ARRAY_TEXTURE_LAYERS, layers, "texture arrays with layers");
  UploadedTexture planes{make_texture(GL_TEXTURE_2D_ARRAY), 0};
  const bool deep = asset.bits == 16;
  glTextureStorage3D(planes.texture.name(), 1, deep ? GL_RGBA16 : GL_RGBA8, asset.width, asset.height, layers);
  check_gl("making room for the coefficient planes");
  upload_planes_into(asset, planes.texture, 0);
  set_sampling(planes.texture, GL_LINEAR);
  planes.bytes = std::uint64_t{planes_per_layer} * (deep ? 2u : 1u) * static_cast<std::uint64_t>(layers) *
                 static_cast<std::uint64_t>(asset.width) * static_cast<std::uint64_t>(asset.height);
  check_gl("uploading the coefficient planes");
  return planes;
}

UploadedTexture upload_cluster_ids(const PrtAsset& asset) {
  if (!asset.clusters || asset.clusters->count == 1) return {};
  UploadedTexture ids{make_texture(GL_TEXTURE_2D), asset.clusters->ids.values().size()};
  glTextureStorage2D(ids.texture.name(), 1, GL_R8UI, asset.width, asset.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(ids.texture.name(), 0, 0, 0, asset.width, asset.height, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                      asset.clusters->ids.values().data());
  set_sampling(ids.texture, GL_NEAREST);
  check_gl("uploading the clusters");
  return ids;
}

Image<std::uint16_t> object_normals(const PrtAsset& asset) {
  const std::filesystem::path file = asset.ranges_file.parent_path() / asset.normals_file;
  Image<std::uint16_t> encoded = read_png_as16(file);
  if (encoded.channels() != 3)
    throw BadInput(file.string(), "has " + std::to_string(encoded.channels()) + " channels", "an RGB normal map",
                   "bake the asset again with kiln-bake");
  if (asset.normal_space == NormalSpace::tangent)
    encoded = quantise_normals(decode_normals(encoded, asset.normal_space, asset.mesh,
                                              rasterise_uvs(asset.mesh, encoded.width(), encoded.height())));
  return encoded;
}

UploadedTexture upload_normal_map(const PrtAsset& asset) {
  const Image<std::uint16_t> encoded = object_normals(asset);
  require_at_most(GL_MAX_TEXTURE_SIZE, std::max(encoded.width(), encoded.height()), "textures with a side");
  UploadedTexture map{make_texture(GL_TEXTURE_2D),
                      8 * encoded.values().size() / 3};  // drivers pad RGB to four channels
  glTextureStorage2D(map.texture.name(), 1, GL_RGB16, encoded.width(), encoded.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(map.texture.name(), 0, 0, 0, encoded.width(), encoded.height(), GL_RGB, GL_UNSIGNED_SHORT,
                      encoded.values().data());
  set_sampling(map.texture, GL_LINEAR);
  check_gl("uploading the normal map");
  return map;
}

int albedo_levels(const PrtAsset& asset) {
  if (!asset.albedo.has_own_size()) return 1;
  const int times = std::min(asset.albedo.width / asset.width, asset.albedo.height / asset.height);
  return times > 1 ? std::bit_width(static_cast<unsigned>(times)) : 1;
}

UploadedTexture upload_albedo(const Image<std::uint8_t>& picture, int levels) {
  if (picture.values().empty()) return {};
  require_at_most(GL_MAX_TEXTURE_SIZE, std::max(picture.width(), picture.height()), "textures with a side");
  UploadedTexture map{make_texture(GL_TEXTURE_2D),
                      4 * picture.values().size() / 3};  // drivers pad RGB to four channels
  glTextureStorage2D(map.texture.name(), levels, GL_SRGB8, picture.width(), picture.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(map.texture.name(), 0, 0, 0, picture.width(), picture.height(), GL_RGB, GL_UNSIGNED_BYTE,
                      picture.values().data());
  set_sampling(map.texture, GL_LINEAR);
  if (levels > 1) {
    glGenerateTextureMipmap(map.texture.name());
    glTextureParameteri(map.texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  }
  check_gl("uploading the albedo");
  return map;
}

UploadedTexture upload_color_table(const ColorTable& table) {
  const int side = table.side, depth = side * table.functions();
  require_at_most(GL_MAX_3D_TEXTURE_SIZE, depth, "textures of three dimensions with a side");
  UploadedTexture colors{make_texture(GL_TEXTURE_3D),
                         4 * sizeof(float) * table.colors.size() / 3};  // drivers pad RGB to four channels
  glTextureStorage3D(colors.texture.name(), 1, GL_RGB32F, side, side, depth);
  glTextureSubImage3D(colors.texture.name(), 0, 0, 0, 0, side, side, depth, GL_RGB, GL_FLOAT, table.colors.data());
  set_sampling(colors.texture, GL_LINEAR);
  glTextureParameteri(colors.texture.name(), GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
  check_gl("uploading the table of colours");
  return colors;
}

UploadedTexture upload_opacity(const Image<std::uint8_t>& picture) {
  return upload_bytes(picture, GL_R8, GL_RED, GL_LINEAR);
}

UploadedTexture upload_material_numbers(const Image<std::uint8_t>& numbers) {
  return upload_bytes(numbers, GL_R8UI, GL_RED_INTEGER, GL_NEAREST);
}

UploadedTexture upload_measured_colors(const LightReaders& materials) {
  if (materials.empty()) return {};
  const auto count = static_cast<int>(materials.size());
  const auto functions = static_cast<int>(materials.front().cols());
  std::vector<float> colors;
  for (int k = 0; k < functions; ++k)
    for (const LightReader& material : materials)
      for (int c = 0; c < 3; ++c) colors.push_back(material(c, k));
  UploadedTexture map{make_texture(GL_TEXTURE_2D), 4 * sizeof(float) * colors.size() / 3};  // padded to four channels
  glTextureStorage2D(map.texture.name(), 1, GL_RGB32F, count, functions);
  glTextureSubImage2D(map.texture.name(), 0, 0, 0, count, functions, GL_RGB, GL_FLOAT, colors.data());
  set_sampling(map.texture, GL_NEAREST);
  check_gl("uploading the colours of measured materials");
  return map;
}

UploadedVertexTransfer upload_vertex_transfer(const PrtAsset& asset) {
  const std::vector<float> vectors = asset.is_per_vertex() ? asset.vertex_transfer : looked_up_transfer(asset);
  const std::size_t length = asset.vector_length(), vertices = asset.mesh.positions.size();
  const std::size_t stride = planes_per_layer * static_cast<std::size_t>(layer_count(length));
  require_at_most(GL_MAX_TEXTURE_BUFFER_SIZE, static_cast<int>(stride / planes_per_layer * vertices),
                  "buffer textures with texels");
  std::vector<float> padded(stride * vertices, 0.f);
  for (std::size_t v = 0; v < vertices; ++v)
    std::copy_n(vectors.begin() + static_cast<std::ptrdiff_t>(v * length), length,
                padded.begin() + static_cast<std::ptrdiff_t>(v * stride));
  UploadedVertexTransfer transfer{make_buffer(std::span<const float>(padded)), make_texture(GL_TEXTURE_BUFFER),
                                  padded.size() * sizeof(float)};
  glTextureBuffer(transfer.texture.name(), GL_RGBA32F, transfer.buffer.name());
  check_gl("uploading the vertices' transfer");
  return transfer;
}

UploadedTexture upload_light(const std::vector<std::vector<PlaneWeights>>& samples) {
  std::vector<PlaneWeights> all;
  for (const std::vector<PlaneWeights>& sample : samples) all.insert(all.end(), sample.begin(), sample.end());
  return upload_weights(all);
}

UploadedTexture upload_weights(std::span<const PlaneWeights> all) {
  std::size_t texels = 0;
  for (const PlaneWeights& weights : all) texels += weight_texels(weights);
  const int rows = static_cast<int>((texels + light_width - 1) / light_width);
  std::vector<float> values(4 * static_cast<std::size_t>(light_width) * static_cast<std::size_t>(rows), 0.f);
  float* to = values.data();
  for (const PlaneWeights& weights : all) {
    const Eigen::Index numbers = weights.scales.rows(), constants = (numbers + 3) / 4;
    for (Eigen::Index k = 0; k < numbers; ++k) {
      to[k] = weights.constant[k];
      for (Eigen::Index plane = 0; plane < weights.scales.cols(); ++plane)
        to[4 * (constants + numbers * (plane / planes_per_layer) + k) + plane % planes_per_layer] =
            weights.scales(k, plane);
    }
    to += 4 * weight_texels(weights);
  }
  require_at_most(GL_MAX_TEXTURE_SIZE, rows, "textures with a side");
  UploadedTexture light{make_texture(GL_TEXTURE_2D), values.size() * sizeof(float)};
  glTextureStorage2D(light.texture.name(), 1, GL_RGBA32F, light_width, rows);
  glTextureSubImage2D(light.texture.name(), 0, 0, 0, light_width, rows, GL_RGBA, GL_FLOAT, values.data());
  set_sampling(light.texture, GL_NEAREST);
  check_gl("uploading the light");
  return light;
}

UploadedMesh upload_mesh(const TriangleMesh& mesh, const IncidentSamples& samples) {
  UploadedMesh uploaded;
  uploaded.vertex_count = mesh.positions.size();
  uploaded.index_count = static_cast<GLsizei>(3 * mesh.triangles.size());
  uploaded.positions = make_buffer(std::span<const Eigen::Vector3f>(mesh.positions));
  uploaded.normals = make_buffer(std::span<const Eigen::Vector3f>(mesh.normals));
  uploaded.indices = make_buffer(std::span<const Triangle>(mesh.triangles));
  uploaded.vertices = make_vertex_array();
  const GLuint vertices = uploaded.vertices.name();
  add_attribute(vertices, position_location, uploaded.positions, 3);
  add_attribute(vertices, normal_location, uploaded.normals, 3);
  if (!mesh.uvs.empty()) {
    uploaded.uvs = make_buffer(std::span<const Eigen::Vector2f>(mesh.uvs));
    add_attribute(vertices, uv_location, uploaded.uvs, 2);
  }
  if (samples.count() > 1 && !samples.are_vertices()) {
    const auto count = static_cast<std::size_t>(samples.count());
    std::vector<float> padded(most_incident_samples * mesh.positions.size(), 0.f);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      std::copy_n(samples.contributions.begin() + static_cast<std::ptrdiff_t>(v * count), count,
                  padded.begin() + static_cast<std::ptrdiff_t>(v * most_incident_samples));
    uploaded.contributions = make_buffer(std::span<const float>(padded));
    add_attribute(vertices, contributions_location, uploaded.contributions, 4, 0, most_incident_samples);
    add_attribute(vertices, contributions_location + 1, uploaded.contributions, 4, 4, most_incident_samples);
  }
  glVertexArrayElementBuffer(vertices, uploaded.indices.name());
  check_gl("uploading the mesh");
  return uploaded;
}

UploadedCorners upload_corners(const TriangleMesh& mesh, const UploadedMesh& uploaded) {
  require_at_most(GL_MAX_TEXTURE_BUFFER_SIZE, static_cast<int>(mesh.triangles.size()), "buffer textures with texels");
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector2f> uvs;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) {
      positions.push_back(mesh.positions[vertex]);
      uvs.push_back(mesh.uvs[vertex]);
    }
  UploadedCorners corners;
  corners.count = static_cast<GLsizei>(positions.size());
  corners.bytes = positions.size() * (sizeof(Eigen::Vector3f) + sizeof(Eigen::Vector2f));
  corners.positions = make_buffer(std::span<const Eigen::Vector3f>(positions));
  corners.uvs = make_buffer(std::span<const Eigen::Vector2f>(uvs));
  corners.vertices = make_vertex_array();
  add_attribute(corners.vertices.name(), position_location, corners.positions, 3);
  add_attribute(corners.vertices.name(), uv_location, corners.uvs, 2);
  corners.triangles = make_texture(GL_TEXTURE_BUFFER);
  glTextureBuffer(corners.triangles.name(), GL_RGB32UI, uploaded.indices.name());
  check_gl("uploading the corners");
  return corners;
}

}  // namespace kiln
