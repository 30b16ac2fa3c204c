// SPDX-License-Identifier: MIT
#include "runtime/shading/shaded_renderer.h"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "gpu/program.h"
#include "runtime/shading/sample_pattern.h"

namespace kiln {

namespace {

// Bindings of shaders/shading_* and common_prt.glsl.
constexpr GLuint planes_unit = 0, nodes_unit = 1, node_light_unit = 2, words_unit = 3, varyings_unit = 4,
                 depth_unit = 5, shadow_unit = 6, reflection_unit = 7, values_unit = 8, triangles_unit = 9,
                 triangle_vertices_unit = 10, vertex_vectors_unit = 11, albedo_unit = 12, normals_unit = 13,
                 opacity_unit = 14;
constexpr GLuint view_block = 0, lights_block = 1;
constexpr GLuint masks_binding = 1, commands_binding = 2, lists_binding = 3;
constexpr GLuint values_binding = 1, counts_binding = 2;  // of the pass of uniform parameters
constexpr GLuint color_attribute = 5;

/// Vectors of a node in shading_scene.glsl. Whole numbers are floats, which hold them up to 2^24.
struct NodeBlock {
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> scene_from_object, object_from_scene;
  Eigen::Vector4f material, planes, planes_place, points, albedo, albedo_place, maps, opacity_place;
};
constexpr int node_vector_count = 14;
static_assert(sizeof(NodeBlock) == node_vector_count * 16);

/// Block `Lights` of shading_light.glsl.
struct LightsBlock {
  std::array<GLint, 4> count = {};
  std::array<std::array<float, 4>, 9> irradiance = {};
  std::array<float, 4> background = {};
  struct {
    std::array<float, 4> place, radiance;
  } direct[most_direct_lights] = {};
  std::array<float, 16> shadow_from_scene[most_direct_lights] = {};
};

/// Turns clip space into what textures are looked up by: 0 to 1.
Eigen::Matrix4f lookup_matrix() {
  Eigen::Matrix4f matrix = 0.5f * Eigen::Matrix4f::Identity();
  matrix.topRightCorner<3, 1>().setConstant(0.5f);
  matrix(3, 3) = 1;
  return matrix;
}

/// Turns GL's clip space into one whose depths are 1 at the near plane and 0 at the far one: float32 then holds them as
/// exactly far away as near, and places that are computed from them.
Eigen::Matrix4d reversed_depth() {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(2, 2) = -0.5;
  matrix(2, 3) = 0.5;
  return matrix;
}

/// Sets how depths are compared, for reversed ones or for shadow maps.
void set_depth_order(bool reversed) {
  glClipControl(GL_LOWER_LEFT, reversed ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE);
  glDepthFunc(reversed ? GL_GREATER : GL_LESS);
}

/// Lists the shaders that a scene's materials name, each once, in the order in which they were read.
std::vector<SurfaceShader> used_shaders(const ShadedScene& scene, const std::vector<SurfaceShader>& shaders) {
  std::vector<SurfaceShader> used;
  for (const SurfaceShader& shader : shaders)
    if (std::any_of(scene.materials.begin(), scene.materials.end(),
                    [&](const ShadedMaterial& material) { return material.shader == shader.name; }))
      used.push_back(shader);
  return used.empty() ? shaders : used;
}

ShadingFeatures features_of(const ShadedScene& scene, const std::vector<SurfaceShader>& shaders, const AssetMaps& maps,
                            const ShadingSettings& settings) {
  ShadingFeatures features;
  features.planes =
      std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const ShadedMesh& mesh) { return mesh.has_transfer(); });
  if (features.planes) features.points = settings.incident_samples;
  features.albedo = maps.albedo.texture.name() != 0;
  features.normals = maps.normals.texture.name() != 0;
  features.opacity = maps.opacity.texture.name() != 0;
  features.varyings = std::any_of(shaders.begin(), shaders.end(),
                                  [](const SurfaceShader& shader) { return shader.varying_components() > 0; });
  features.steps = settings.steps;
  return features;
}

int direct_light_count(const ShadedScene& scene) {
  const auto count = std::count_if(scene.lights.specs.begin(), scene.lights.specs.end(), is_direct);
  if (count > most_direct_lights)
    throw WrongUsage("lights: found " + std::to_string(count) + " with a direction; expected at most " +
                     std::to_string(most_direct_lights) + ", as each has a shadow map");
  return static_cast<int>(count);
}

/// Turns a mirror's plane from its node's space to the scene's.
MirrorPlane in_scene(const MirrorPlane& mirror, const ShadedScene& scene) {
  const Placement& placement = scene.nodes[static_cast<std::size_t>(mirror.node)].placement;
  return {mirror.node, placement.to_scene(mirror.point), placement.rotation * mirror.normal};
}

void begin_part(PartTimes* times, const char* part) {
  if (times != nullptr) times->begin(part);
}

}  // namespace

/// Block `View` of shading_scene.glsl.
struct ShadedRenderer::View {
  Eigen::Matrix4f clip_from_scene, scene_from_clip, picture_from_scene;
  Eigen::Vector4f eye_and_weight, cut_plane;
  Eigen::Vector2f picture_size;
  float time = 0;
  GLint frame = 0;
  float pixel_angle = 0;
  float unused[3] = {};
};

ShadedRenderer::ShadedRenderer(ShadedScene scene, const std::vector<SurfaceShader>& shaders,
                               const ShadingSettings& settings)
    : scene_(std::move(scene)),
      settings_(settings),
      shapes_(upload_shapes(scene_.meshes)),
      planes_(upload_all_planes(scene_.meshes)),
      points_(upload_light_points(scene_.meshes, settings.incident_samples)),
      maps_(upload_asset_maps(scene_.meshes)),
      view_(make_refilled_buffer(sizeof(View))),
      lights_(make_refilled_buffer(sizeof(LightsBlock))),
      shadows_(settings.shadow_size, std::max(1, direct_light_count(scene_))),
      node_vectors_(make_texture(GL_TEXTURE_BUFFER)),
      material_values_(make_texture(GL_TEXTURE_BUFFER)),
      no_reflection_(make_texture(GL_TEXTURE_2D)),
      no_vertices_(make_vertex_array()) {
  for (const ShadedMesh& mesh : scene_.meshes) boxes_.push_back(bounding_box(*mesh.mesh));
  glTextureStorage2D(no_reflection_.name(), 1, GL_RGBA8, 1, 1);
  const GLubyte clear[4] = {0, 0, 0, 0};
  glTextureSubImage2D(no_reflection_.name(), 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, clear);
  set_shaders(shaders);
}

void ShadedRenderer::set_shaders(const std::vector<SurfaceShader>& shaders) {
  std::vector<SurfaceShader> used = used_shaders(scene_, shaders);
  const ShadingFeatures features = features_of(scene_, used, maps_, settings_);
  auto programs = std::make_unique<ShaderPrograms>(std::move(used), features);
  UploadedMaterials materials = upload_materials(scene_.materials, programs->glsl());
  std::vector<GlTexture> pictures = upload_pictures(programs->glsl());
  programs_ = std::move(programs);
  materials_ = std::move(materials);
  pictures_ = std::move(pictures);
  glTextureBuffer(material_values_.name(), GL_RGBA32F, materials_.values.name());
  evaluations_ = make_zero_buffer(sizeof(GLuint));
  reflection_.reset();
  if (scene_.mirror) {
    const int size = settings_.reflection_size;
    reflection_.emplace(size, size, extras(), static_cast<int>(programs_->sets().size()),
                        std::bit_width(static_cast<unsigned>(size)));
  }
  is_uploaded_ = false;
}

void ShadedRenderer::set_placements(std::span<const Placement> placements) {
  for (std::size_t k = 0; k < scene_.nodes.size(); ++k) scene_.nodes[k].placement = placements[k];
  is_uploaded_ = false;
}

void ShadedRenderer::set_node_light(std::vector<NodeLight> light) {
  if (!light.empty() && light.size() != scene_.nodes.size())
    throw std::invalid_argument("ShadedRenderer: the light must be that of each node");
  for (std::size_t k = 0; k < light.size(); ++k) {
    const auto mesh = static_cast<std::size_t>(scene_.nodes[k].mesh);
    if (scene_.meshes[mesh].has_transfer() && light[k].size() != static_cast<std::size_t>(points_.places[mesh].points))
      throw std::invalid_argument("ShadedRenderer: the light must have one vector for each of a node's points");
  }
  given_light_ = std::move(light);
  is_uploaded_ = false;
}

void ShadedRenderer::set_lights(const SceneLights& lights) {
  ShadedScene other = scene_;
  other.lights = lights;
  const int count = direct_light_count(other);
  if (std::max(1, count) != std::max(1, direct_light_count(scene_)))
    shadows_ = ShadowTable(settings_.shadow_size, std::max(1, count));
  scene_ = std::move(other);
  is_uploaded_ = false;
}

void ShadedRenderer::upload_moment() {
  if (is_uploaded_) return;
  upload_nodes();
  upload_lights();
  is_uploaded_ = true;
}

void ShadedRenderer::upload_nodes() {
  node_light_ = upload_node_light(scene_, given_light_.empty()
                                              ? unshadowed_light(scene_, settings_.incident_samples, settings_.direct)
                                              : given_light_);
  std::vector<NodeBlock> blocks;
  for (std::size_t k = 0; k < scene_.nodes.size(); ++k) {
    const ShadedNode& node = scene_.nodes[k];
    const Eigen::Matrix4d matrix = node.placement.matrix();
    const auto mesh = static_cast<std::size_t>(node.mesh);
    const UploadedPlanes::Place& place = planes_.places[mesh];
    const LightPoints::Place& points = points_.places[mesh];
    const bool direct = place.layers > 0 && settings_.direct == DirectLightBy::transfer;
    const auto material = static_cast<std::size_t>(node.material);
    NodeBlock block;
    block.scene_from_object = matrix.topRows<3>().cast<float>();
    block.object_from_scene = matrix.inverse().topRows<3>().cast<float>();
    block.material = Eigen::Vector4i(materials_.first[material], materials_.shaders[material], 0, 0).cast<float>();
    block.planes =
        Eigen::Vector4i(place.first_layer, place.layers, node_light_.first_texel[k], direct ? 1 : 0).cast<float>();
    block.planes_place = place.place;
    block.points = Eigen::Vector4i(points.first_triangle, points.first_vertex, points.points, 0).cast<float>();
    block.albedo << maps_.colors[mesh], static_cast<float>(maps_.albedo.layers[mesh]);
    block.albedo_place << maps_.albedo.parts[mesh], static_cast<float>(maps_.albedo_levels[mesh]),
        static_cast<float>(maps_.albedo_texels[mesh]);
    block.maps << static_cast<float>(maps_.normals.layers[mesh]), static_cast<float>(maps_.opacity.layers[mesh]),
        maps_.normals.parts[mesh];
    block.opacity_place << maps_.opacity.parts[mesh], 0, 0;
    blocks.push_back(block);
  }
  constexpr std::size_t most_nodes = 65536;  // in the 16 bits of shading_words.glsl
  if (blocks.size() > most_nodes)
    throw WrongUsage("scene: found " + std::to_string(blocks.size()) + " nodes; expected at most " +
                     std::to_string(most_nodes));
  require_at_most(GL_MAX_TEXTURE_BUFFER_SIZE, node_vector_count * static_cast<int>(blocks.size()),
                  "buffer textures with texels");
  nodes_ = make_buffer(std::span<const NodeBlock>(blocks));
  glTextureBuffer(node_vectors_.name(), GL_RGBA32F, nodes_.name());
}

void ShadedRenderer::upload_lights() {
  const Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  const AssetLight light = light_asset(scene_.lights, 3, {}, std::span(&origin, 1));
  LightsBlock block;
  block.count[0] = static_cast<GLint>(light.direct.size());
  const LightCoefficients rest = scale_light(irradiance(light.rest), 1 / std::numbers::pi);
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t c = 0; c < 3; ++c) block.irradiance[i][c] = rest.channels[c][i];
  std::copy(scene_.background.begin(), scene_.background.end(), block.background.begin());
  const std::vector<Eigen::Vector3d> casters = shadow_casters(scene_, boxes_);
  shadow_views_.clear();
  for (std::size_t k = 0; k < light.direct.size(); ++k) {
    const DirectLight& direct = light.direct[k];
    ShadowView view{Eigen::Matrix4f::Identity(), 1};
    if (!casters.empty()) view = shadow_view(direct, casters);
    block.direct[k].place = {direct.place.x(), direct.place.y(), direct.place.z(), direct.radius};
    block.direct[k].radiance = {direct.radiance[0], direct.radiance[1], direct.radiance[2],
                                view.width / static_cast<float>(shadows_.size())};
    Eigen::Map<Eigen::Matrix4f>(block.shadow_from_scene[k].data()) = lookup_matrix() * view.clip_from_scene;
    shadow_views_.push_back(view);
  }
  refill_buffer(lights_, std::span<const LightsBlock>(&block, 1));
}

ShadedFrame::Extras ShadedRenderer::extras() const {
  const auto& shaders = programs_->glsl().shaders();
  const bool varyings = std::any_of(shaders.begin(), shaders.end(),
                                    [](const SurfaceShader& shader) { return shader.varying_components() > 0; });
  return {varyings, points_.triangles.name() != 0};
}

ShadedFrame ShadedRenderer::make_frame(int width, int height) const {
  return {width, height, extras(), static_cast<int>(programs_->sets().size())};
}

unsigned ShadedRenderer::uniform_evaluations() const {
  GLuint count = 0;
  glGetNamedBufferSubData(evaluations_.name(), 0, sizeof(count), &count);
  return count;
}

void ShadedRenderer::set_view(const View& view) {
  refill_buffer(view_, std::span<const View>(&view, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, view_block, view_.name());
}

void ShadedRenderer::bind_tables(const GlTexture& reflection) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, lights_block, lights_.name());
  glBindTextureUnit(nodes_unit, node_vectors_.name());
  glBindTextureUnit(values_unit, material_values_.name());
  glBindTextureUnit(planes_unit, planes_.planes.name());
  glBindTextureUnit(node_light_unit, node_light_.texture.name());
  glBindTextureUnit(shadow_unit, shadows_.texture().name());
  glBindTextureUnit(reflection_unit, reflection.name());
  glBindTextureUnit(triangle_vertices_unit, points_.triangle_vertices.name());
  glBindTextureUnit(vertex_vectors_unit, points_.vertex_vectors.name());
  glBindTextureUnit(albedo_unit, maps_.albedo.texture.name());
  glBindTextureUnit(normals_unit, maps_.normals.texture.name());
  glBindTextureUnit(opacity_unit, maps_.opacity.texture.name());
  for (std::size_t k = 0; k < pictures_.size(); ++k)
    glBindTextureUnit(first_picture_unit + static_cast<GLuint>(k), pictures_[k].name());
}

void ShadedRenderer::compute_uniforms() {
  const ShaderGlsl& glsl = programs_->glsl();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, values_binding, materials_.values.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, counts_binding, evaluations_.name());
  for (int k = 0; k < glsl.count(); ++k) {
    const int count = materials_.materials_of_shader[static_cast<std::size_t>(k)];
    if (!glsl.has_uniforms(k) || count == 0) continue;
    const GlProgram& used = programs_->uniforms(k);
    glProgramUniform1i(used.name(), 0, materials_.first_of_shader[static_cast<std::size_t>(k)]);
    glProgramUniform1i(used.name(), 1, glsl.value_count(k));
    glUseProgram(used.name());
    glDispatchCompute(static_cast<GLuint>(count), 1, 1);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ShadedRenderer::draw_shadows() {
  if (shadow_views_.empty()) return;
  const GlProgram& used = programs_->depth();
  glUseProgram(used.name());
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 4);  // steep surfaces span several depths a texel
  for (std::size_t light = 0; light < shadow_views_.size(); ++light) {
    shadows_.begin(static_cast<int>(light));
    glProgramUniformMatrix4fv(used.name(), 1, 1, GL_FALSE, shadow_views_[light].clip_from_scene.data());
    for (std::size_t k = 0; k < scene_.nodes.size(); ++k) {
      if (!scene_.nodes[k].casts_shadow) continue;
      const UploadedMesh& mesh = shapes_[static_cast<std::size_t>(scene_.nodes[k].mesh)].mesh;
      glProgramUniform1i(used.name(), 0, static_cast<GLint>(k));
      glBindVertexArray(mesh.vertices.name());
      glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
    }
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void ShadedRenderer::draw_nodes(bool forward, int skipped_node) {
  // One shader after the other, so that programs change seldom.
  for (int shader = 0; shader < programs_->glsl().count(); ++shader) {
    const GlProgram* used = nullptr;
    for (std::size_t k = 0; k < scene_.nodes.size(); ++k) {
      const ShadedNode& node = scene_.nodes[k];
      if (materials_.shaders[static_cast<std::size_t>(node.material)] != shader) continue;
      if (static_cast<int>(k) == skipped_node) continue;
      if (used == nullptr) {
        used = forward ? &programs_->forward(shader) : &programs_->raster(shader);
        glUseProgram(used->name());
      }
      const UploadedMesh& mesh = shapes_[static_cast<std::size_t>(node.mesh)].mesh;
      glProgramUniform1i(used->name(), 0, static_cast<GLint>(k));
      glBindVertexArray(mesh.vertices.name());
      glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
    }
  }
}

void ShadedRenderer::shade_tiles(const ShadedFrame& frame, bool adds, PartTimes* times) {
  const bool factored = settings_.way == ShadingWay::factored;
  begin_part(times, "tiles");
  frame.clear_tiles();
  glBindTextureUnit(words_unit, frame.words().name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, masks_binding, frame.masks().name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, commands_binding, frame.commands().name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, lists_binding, frame.listed().name());
  const GlProgram &masks = programs_->masks(), &lists = programs_->lists();
  glProgramUniform2i(masks.name(), 0, frame.columns(), frame.rows());
  glUseProgram(masks.name());
  glDispatchCompute(static_cast<GLuint>(frame.columns() + 7) / 8,
                    static_cast<GLuint>(frame.height() + shading_tile_side - 1) / shading_tile_side, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glProgramUniform2i(lists.name(), 0, frame.columns(), frame.rows());
  glProgramUniform1i(lists.name(), 1, factored ? 1 : 0);
  glUseProgram(lists.name());
  glDispatchCompute(static_cast<GLuint>(frame.columns() * frame.rows() + 63) / 64, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);

  begin_part(times, "shading");
  frame.begin_picture(adds);
  glBindTextureUnit(varyings_unit, frame.varyings().name());
  glBindTextureUnit(triangles_unit, frame.triangles().name());
  glBindTextureUnit(depth_unit, frame.depth().name());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, frame.commands().name());
  glBindVertexArray(no_vertices_.name());
  glEnable(GL_PROGRAM_POINT_SIZE);
  glViewport(0, 0, shading_tile_side * frame.columns(), shading_tile_side * frame.rows());
  const std::vector<std::uint32_t> sets = programs_->sets();
  for (std::size_t list = 0; list < sets.size(); ++list) {
    const bool is_single = (sets[list] & (sets[list] - 1)) == 0;
    if (!factored && !is_single) continue;
    const GlProgram& used = programs_->deferred(sets[list]);
    glProgramUniform2i(used.name(), 0, frame.columns(), frame.rows());
    glProgramUniform1i(used.name(), 1, static_cast<GLint>(list));
    glUseProgram(used.name());
    glDrawArraysIndirect(GL_POINTS, reinterpret_cast<const void*>(list * 4 * sizeof(GLuint)));
  }
  glDisable(GL_PROGRAM_POINT_SIZE);
  glDisable(GL_BLEND);
}

void ShadedRenderer::draw_sample(const ShadedFrame& frame, const View& view, bool is_only_sample, int skipped_node,
                                 PartTimes* times) {
  set_view(view);
  set_depth_order(true);
  glViewport(0, 0, frame.width(), frame.height());
  glEnable(GL_DEPTH_TEST);
  const bool forward = settings_.way == ShadingWay::forward;
  begin_part(times, forward ? "forward shading" : "rasterisation");
  if (forward)
    frame.begin_forward(is_only_sample);
  else
    frame.begin_raster();
  draw_nodes(forward, skipped_node);
  if (!forward) return shade_tiles(frame, !is_only_sample, times);
  if (is_only_sample) return;
  begin_part(times, "adding samples");
  frame.begin_picture(true);
  const GlProgram& used = programs_->add();
  glProgramUniform1f(used.name(), 0, view.eye_and_weight.w());
  glUseProgram(used.name());
  glBindTextureUnit(words_unit, frame.sampled().name());
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

void ShadedRenderer::draw_reflection(const Camera& camera, double seconds, int frame_number) {
  const MirrorPlane mirror = in_scene(*scene_.mirror, scene_);
  const Eigen::Matrix4d matrix = mirror_matrix(mirror);
  const Eigen::Matrix4d clip = reversed_depth() * camera.clip_from_object().cast<double>() * matrix;
  const Eigen::Vector3d eye = (matrix * camera.position.cast<double>().homogeneous()).head<3>();
  View view;
  view.clip_from_scene = view.picture_from_scene = clip.cast<float>();
  view.scene_from_clip = clip.inverse().cast<float>();
  view.eye_and_weight << eye.cast<float>(), 1.f;
  view.cut_plane << mirror.normal.cast<float>(), static_cast<float>(-mirror.normal.dot(mirror.point));
  view.picture_size = Eigen::Vector2f(reflection_->width(), reflection_->height());
  view.time = static_cast<float>(seconds);
  view.frame = frame_number;
  view.pixel_angle = 2 * camera.half_height / static_cast<float>(reflection_->height());
  bind_tables(no_reflection_);
  reflection_->clear();
  glEnable(GL_CLIP_DISTANCE0);
  draw_sample(*reflection_, view, true, mirror.node, nullptr);
  glDisable(GL_CLIP_DISTANCE0);
  glGenerateTextureMipmap(reflection_->picture().name());
}

void ShadedRenderer::draw(const Camera& camera, const ShadedFrame& frame, double seconds, int frame_number,
                          PartTimes* times) {
  upload_moment();
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  set_depth_order(false);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glVertexAttrib3f(color_attribute, 1, 1, 1);
  const Eigen::Matrix4d clip = reversed_depth() * camera.clip_from_object().cast<double>();
  View view;
  view.picture_from_scene = clip.cast<float>();
  view.cut_plane.setZero();
  view.eye_and_weight << camera.position, 1.f / static_cast<float>(settings_.samples);
  view.picture_size = Eigen::Vector2f(frame.width(), frame.height());
  view.time = static_cast<float>(seconds);
  view.frame = frame_number;
  view.pixel_angle = 2 * camera.half_height / static_cast<float>(frame.height());

  begin_part(times, "uniforms");
  set_view(view);
  compute_uniforms();
  begin_part(times, "shadow maps");
  bind_tables(no_reflection_);
  draw_shadows();
  if (reflection_) {
    begin_part(times, "reflection map");
    draw_reflection(camera, seconds, frame_number);
    bind_tables(reflection_->picture());
  }
  frame.clear();
  for (const Eigen::Vector2d& place : sample_pattern(settings_.samples)) {
    // Moves the picture so that the sample's place comes to the middle of its pixel.
    Eigen::Matrix4d moved = Eigen::Matrix4d::Identity();
    moved(0, 3) = (1 - 2 * place.x()) / frame.width();
    moved(1, 3) = (1 - 2 * place.y()) / frame.height();
    view.clip_from_scene = (moved * clip).cast<float>();
    view.scene_from_clip = (moved * clip).inverse().cast<float>();
    draw_sample(frame, view, settings_.samples == 1, -1, times);
  }
  if (times != nullptr) times->begin("");
  set_depth_order(false);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  check_gl("drawing shaded surfaces");
}

Image<float> read_back(const ShadedFrame& frame) {
  Image<float> picture(frame.width(), frame.height(), 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(frame.picture().name(), 0, GL_RGBA, GL_FLOAT,
                    static_cast<GLsizei>(picture.values().size() * sizeof(float)), picture.values().data());
  check_gl("reading the shaded picture");
  return picture;
}

Image<float> shaded_picture(ShadedRenderer& renderer, const Camera& camera, int width, int height, double seconds) {
  const ShadedFrame frame = renderer.make_frame(width, height);
  renderer.draw(camera, frame, seconds);
  return read_back(frame);
}

}  // namespace kiln
