#include "relight/prt_renderer.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/errors.h"
#include "gpu/program.h"
#include "relight/relight.h"

namespace kiln {

namespace {

// Bindings and locations as shaders/common_prt.glsl, shaders/common_prt_pca.glsl and shaders/render_prt.vert have them.
constexpr GLuint planes_unit = 0, cluster_ids_unit = 1, weights_binding = 0;
constexpr GLuint position_location = 0, uv_location = 1;
constexpr GLint clip_from_object_location = 0, layers_location = 1;
constexpr std::size_t planes_per_layer = 4;

// Pictures are drawn in tiles of at most so many samples a side, so that memory does not grow with supersampling.
constexpr int tile_samples = 2048;

void require_at_most(GLenum limit, int wanted, const char* what) {
  GLint most = 0;
  glGetIntegerv(limit, &most);
  if (wanted > most)
    throw MachineLacks(std::string("the GL device takes ") + what + " of at most " + std::to_string(most) + ", and " +
                       std::to_string(wanted) + " are needed; ask for less, or try --gl-device software");
}

int layer_count(const PrtAsset& asset) {
  return static_cast<int>((asset.planes.size() + planes_per_layer - 1) / planes_per_layer);
}

/// Four planes as the channels of one picture; channels without a plane are 0.
template <class Value>
std::vector<Value> interleaved(const std::vector<Image<Value>>& planes, std::size_t first) {
  std::vector<Value> texels(planes_per_layer * planes[first].values().size(), Value{0});
  for (std::size_t k = first; k < std::min(planes.size(), first + planes_per_layer); ++k)
    for (std::size_t i = 0; i < planes[k].values().size(); ++i)
      texels[planes_per_layer * i + k - first] = planes[k].values()[i];
  return texels;
}

/// The coefficient planes, four to a layer, of a texture that is normalised to 0..1, looked up bilinearly, clamped at
/// its edges.
GlTexture upload_planes(const PrtAsset& asset) {
  require_at_most(GL_MAX_TEXTURE_SIZE, std::max(asset.width, asset.height), "textures with a side");
  require_at_most(GL_MAX_ARRAY_TEXTURE_LAYERS, layer_count(asset), "texture arrays with layers");
  GlTexture texture = make_texture(GL_TEXTURE_2D_ARRAY);
  const bool deep = asset.bits == 16;
  glTextureStorage3D(texture.name(), 1, deep ? GL_RGBA16 : GL_RGBA8, asset.width, asset.height, layer_count(asset));
  check_gl("making room for the coefficient planes");
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const auto upload = [&](const auto& pictures) {
    for (int layer = 0; layer < layer_count(asset); ++layer)
      glTextureSubImage3D(texture.name(), 0, 0, 0, layer, asset.width, asset.height, 1, GL_RGBA,
                          deep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                          interleaved(pictures, planes_per_layer * static_cast<std::size_t>(layer)).data());
  };
  std::visit(upload, asset.pictures);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

void add_attribute(GLuint vertices, GLuint location, const GlBuffer& buffer, int components) {
  glVertexArrayVertexBuffer(vertices, location, buffer.name(), 0,
                            static_cast<GLsizei>(components * static_cast<int>(sizeof(float))));
  glVertexArrayAttribFormat(vertices, location, components, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vertices, location, location);
  glEnableVertexArrayAttrib(vertices, location);
}

/// The buffer of common_prt.glsl and common_prt_pca.glsl: for each cluster the constant, then for each layer what its
/// planes add to red, green and blue.
GlBuffer upload_weights(const std::vector<PlaneWeights>& clusters) {
  const std::size_t layers = (clusters.front().scales.size() + planes_per_layer - 1) / planes_per_layer;
  const std::size_t stride = 4 + 3 * planes_per_layer * layers;
  std::vector<float> values(stride * clusters.size(), 0.f);
  for (std::size_t cluster = 0; cluster < clusters.size(); ++cluster) {
    const PlaneWeights& weights = clusters[cluster];
    float* to = values.data() + stride * cluster;
    for (int colour = 0; colour < 3; ++colour) {
      to[colour] = weights.constant[colour];
      for (std::size_t plane = 0; plane < weights.scales.size(); ++plane)
        to[4 + planes_per_layer * (3 * (plane / planes_per_layer) + static_cast<std::size_t>(colour)) +
           plane % planes_per_layer] = weights.scales[plane][colour];
    }
  }
  return make_buffer(std::span<const float>(values));
}

bool is_clustered(const PrtAsset& asset) { return asset.clusters && asset.clusters->count > 1; }

/// The cluster of every texel, clamped at the edges as the planes are; none where there is one cluster.
GlTexture upload_cluster_ids(const PrtAsset& asset) {
  if (!is_clustered(asset)) return {};
  GlTexture texture = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_R8UI, asset.width, asset.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.name(), 0, 0, 0, asset.width, asset.height, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                      asset.clusters->ids.values().data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  check_gl("uploading the clusters");
  return texture;
}

/// Part of a picture, in pixels of it.
struct Tile {
  int left = 0, bottom = 0, width = 0, height = 0;
};

/// Scales and moves clip space so that `tile` of the picture fills it.
Eigen::Matrix4f clip_of_tile(const Tile& tile, int width, int height) {
  const float across = static_cast<float>(width) / static_cast<float>(tile.width);
  const float up = static_cast<float>(height) / static_cast<float>(tile.height);
  Eigen::Matrix4f zoom = Eigen::Matrix4f::Identity();
  zoom(0, 0) = across;
  zoom(1, 1) = up;
  zoom(0, 3) = across - 1 - 2 * static_cast<float>(tile.left) / static_cast<float>(tile.width);
  zoom(1, 3) = up - 1 - 2 * static_cast<float>(tile.bottom) / static_cast<float>(tile.height);
  return zoom;
}

/// Where tiles are drawn: linear radiance in float, and depth.
struct Frame {
  explicit Frame(int width, int height)
      : colour(make_texture(GL_TEXTURE_2D)), depth(make_texture(GL_TEXTURE_2D)), framebuffer(make_framebuffer()) {
    glTextureStorage2D(colour.name(), 1, GL_RGBA32F, width, height);
    glTextureStorage2D(depth.name(), 1, GL_DEPTH_COMPONENT32F, width, height);
    glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, colour.name(), 0);
    glNamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
    check_gl("making the frame");
  }

  void clear() const {
    const GLfloat nothing[4] = {0, 0, 0, 0}, farthest = 1;
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, nothing);
    glClearNamedFramebufferfv(framebuffer.name(), GL_DEPTH, 0, &farthest);
  }

  GlTexture colour, depth;
  GlFramebuffer framebuffer;
};

/// Adds the means of squares of `factor` x `factor` samples of `fine` to the pixels of `tile`, which are 0.
void box_filter(const Image<float>& fine, int factor, const Tile& tile, Image<float>& picture) {
  const float weight = 1.f / static_cast<float>(factor * factor);
  for (int j = 0; j < fine.height(); ++j)
    for (int i = 0; i < fine.width(); ++i)
      for (int channel = 0; channel < fine.channels(); ++channel)
        picture.at(tile.left + i / factor, tile.bottom + j / factor, channel) += weight * fine.at(i, j, channel);
}

}  // namespace

PrtRenderer::PrtRenderer(const PrtAsset& asset)
    : asset_(asset),
      program_(load_program({"render_prt.vert", "render_prt.frag"},
                            is_clustered(asset) ? ShaderDefines{{"CLUSTERED", "1"}} : ShaderDefines{})),
      planes_(upload_planes(asset)),
      cluster_ids_(upload_cluster_ids(asset)),
      positions_(make_buffer(std::span<const Eigen::Vector3f>(asset.mesh.positions))),
      uvs_(make_buffer(std::span<const Eigen::Vector2f>(asset.mesh.uvs))),
      indices_(make_buffer(std::span<const Triangle>(asset.mesh.triangles))),
      vertices_(make_vertex_array()) {
  add_attribute(vertices_.name(), position_location, positions_, 3);
  add_attribute(vertices_.name(), uv_location, uvs_, 2);
  glVertexArrayElementBuffer(vertices_.name(), indices_.name());
  check_gl("uploading the asset");
}

Image<float> PrtRenderer::render(const LightCoefficients& light, const PrtView& view) const {
  const int factor = view.supersample;
  const int tile_side = std::max(1, tile_samples / factor);
  const int widest = std::min(tile_side, view.width), highest = std::min(tile_side, view.height);
  const Frame frame(widest * factor, highest * factor);

  // What all tiles share.
  const GlBuffer weights = upload_weights(cluster_weights(asset_, light, view.albedo));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, weights_binding, weights.name());
  glBindTextureUnit(planes_unit, planes_.name());
  if (is_clustered(asset_)) {
    glBindTextureUnit(cluster_ids_unit, cluster_ids_.name());
    glProgramUniform1i(program_.name(), layers_location, layer_count(asset_));
  }
  glBindFramebuffer(GL_FRAMEBUFFER, frame.framebuffer.name());
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glBindVertexArray(vertices_.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);

  // Draw and fetch one tile after the other.
  Image<float> picture(view.width, view.height, 4);
  for (int bottom = 0; bottom < view.height; bottom += tile_side)
    for (int left = 0; left < view.width; left += tile_side) {
      const Tile tile{left, bottom, std::min(widest, view.width - left), std::min(highest, view.height - bottom)};
      const Eigen::Matrix4f clip = clip_of_tile(tile, view.width, view.height) * view.camera.clip_from_object();
      glProgramUniformMatrix4fv(program_.name(), clip_from_object_location, 1, GL_FALSE, clip.data());
      Image<float> fine(tile.width * factor, tile.height * factor, 4);
      glViewport(0, 0, fine.width(), fine.height());
      frame.clear();
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * asset_.mesh.triangles.size()), GL_UNSIGNED_INT, nullptr);
      glReadPixels(0, 0, fine.width(), fine.height(), GL_RGBA, GL_FLOAT, fine.values().data());
      check_gl("drawing the asset");
      box_filter(fine, factor, tile, picture);
    }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return picture;
}

}  // namespace kiln
