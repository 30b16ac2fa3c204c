#include "bake/shadow_maps.h"

#include <algorithm>

#include "gpu/program.h"

namespace kiln {

namespace {

constexpr int frame_margin_texels = 2;

/// As shaders/bake_views.glsl has it (std430).
struct View {
  Eigen::Vector4f row_u, row_v, row_depth, direction;
};

}  // namespace

ShadowMaps::ShadowMaps(const TransferScene& scene, const ShadowMapSettings& settings)
    : size_(settings.size_texels),
      indices_(static_cast<GLsizei>(3 * scene.triangles.size())),
      cull_(scene.closed),
      layered_(settings.layered_pass && epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array")),
      hull_(scene.hull.begin(), scene.hull.end()),
      positions_(make_buffer(scene.positions)),
      triangles_(make_buffer(scene.triangles)),
      views_(make_refilled_buffer(settings.batch_directions * sizeof(View))),
      occluders_(make_vertex_array()),
      maps_(make_texture(GL_TEXTURE_2D_ARRAY)),
      framebuffer_(make_framebuffer()),
      program_(
          load_program({"bake_depth.vert"}, layered_ ? ShaderDefines{{"HAS_VERTEX_LAYER", "1"}} : ShaderDefines{})) {
  glVertexArrayVertexBuffer(occluders_.name(), 0, positions_.name(), 0, sizeof(Eigen::Vector3f));
  glVertexArrayAttribFormat(occluders_.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
  glEnableVertexArrayAttrib(occluders_.name(), 0);
  glVertexArrayElementBuffer(occluders_.name(), triangles_.name());
  glTextureStorage3D(maps_.name(), 1, GL_DEPTH_COMPONENT32F, size_, size_, settings.batch_directions);
  for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(maps_.name(), filter, GL_NEAREST);
  glNamedFramebufferDrawBuffer(framebuffer_.name(), GL_NONE);
  if (layered_) glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0);
}

void ShadowMaps::draw(std::span<const Eigen::Vector3f> directions) {
  // Step 1: the frames.
  std::vector<View> views;
  for (const Eigen::Vector3f& direction : directions) {
    const ShadowFrame frame = fit_shadow_frame(hull_, direction, size_, frame_margin_texels);
    const float texel = std::max(frame.width, frame.height) / static_cast<float>(size_);
    views.push_back({frame.row_u, frame.row_v, frame.row_depth, {direction.x(), direction.y(), direction.z(), texel}});
  }
  refill_buffer<View>(views_, views);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, views_.name());

  // Step 2: the maps.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  if (cull_)
    glEnable(GL_CULL_FACE);
  else
    glDisable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glViewport(0, 0, size_, size_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindVertexArray(occluders_.name());
  glUseProgram(program_.name());
  const int count = static_cast<int>(directions.size());
  if (layered_) return draw_layers(0, count);
  for (int layer = 0; layer < count; ++layer) {
    glNamedFramebufferTextureLayer(framebuffer_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0, layer);
    draw_layers(layer, 1);
  }
}

void ShadowMaps::draw_layers(int first, int count) const {
  const float farthest = 1;
  glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, &farthest);
  glUniform1i(uniform_location(program_, "first_layer"), first);
  glDrawElementsInstanced(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr, count);
}

}  // namespace kiln
