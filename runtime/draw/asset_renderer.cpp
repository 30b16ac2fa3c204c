// SPDX-License-Identifier: MIT
#include "runtime/draw/asset_renderer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>

#include "gpu/program.h"
#include "runtime/decode/plane_weights.h"

namespace kiln {

namespace {

// Bindings and locations of shaders/common_prt.glsl and shaders/render_*.
constexpr GLuint planes_unit = 0, cluster_ids_unit = 1, light_unit = 2, albedo_unit = 3, vertex_transfer_unit = 4,
                 normal_map_unit = 5, opacity_unit = 9, colors_unit = 10, materials_unit = 11, triangles_unit = 12,
                 measured_unit = 13, phong_binding = 1;
constexpr GLint clip_from_object_location = 0, layers_location = 1, clusters_location = 2, asset_number_location = 3,
                products_location = 8;

bool is_textured(Technique technique) {
  return technique == Technique::textured_prt || technique == Technique::compressed;
}

}  // namespace

AssetRenderer::AssetRenderer(const PrtAsset& asset, int incident_samples)
    : asset_(asset),
      samples_(place_incident_samples(asset.mesh, incident_samples)),
      mesh_(upload_mesh(asset.mesh, samples_)),
      albedo_map_(upload_albedo(asset.albedo.picture, albedo_levels(asset))),
      white_(upload_albedo(Image<std::uint8_t>(1, 1, 3, 255))),
      opacity_map_(upload_opacity(asset.opacity)),
      material_numbers_(upload_material_numbers(asset.albedo.measured_at)) {
  if (samples_.are_vertices() && !asset.is_per_vertex()) corners_ = upload_corners(asset.mesh, mesh_);
}

std::array<float, 3> AssetRenderer::albedo(const SurfaceLook& look) const {
  constexpr float grey = unknown_albedo;
  const bool own = look.own_albedo && (colors_ ? colors_->is_known : asset_.albedo.known);
  std::array<float, 3> albedo = look.albedo.value_or(own ? std::array{1.f, 1.f, 1.f} : std::array{grey, grey, grey});
  for (std::size_t c = 0; own && !colors_ && c < 3; ++c)
    albedo[c] *= asset_.albedo.constant[static_cast<Eigen::Index>(c)];
  return albedo;
}

LightReaders AssetRenderer::readers(const SurfaceLook& look) const {
  const std::array<float, 3> factors = albedo(look);
  if (!colors_) return rgb_readers(asset_, factors);
  if (differs_by_albedo()) return {factors[0] * LightReader::Identity(colors_->functions(), colors_->functions())};
  LightReaders scaled = colors_->readers;
  for (LightReader& reader : scaled)
    for (Eigen::Index c = 0; c < reader.rows(); ++c) reader.row(c) *= factors[static_cast<std::size_t>(c)];
  return scaled;
}

void AssetRenderer::set_colors(std::shared_ptr<const SurfaceColors> colors) {
  if (colors == colors_) return;
  const auto functions = [](const std::shared_ptr<const SurfaceColors>& one) {
    return one ? std::tuple(one->functions(), one->readers.empty(), one->measured.empty()) : std::tuple(0, false, true);
  };
  if (functions(colors) != functions(colors_)) programs_.clear();
  colors_ = std::move(colors);
  color_table_ = colors_ ? upload_color_table(colors_->table) : UploadedTexture();
  measured_colors_ = colors_ ? upload_measured_colors(colors_->measured) : UploadedTexture();
  lit_.reset();
}

std::vector<float> AssetRenderer::phong_buffer(const Eigen::Vector3f& eye) const {
  const SurfaceLook& look = lit_->look;
  const AssetLight& light = lit_->light;
  const std::array<float, 3> factors = albedo(look);
  std::vector<float> values = {factors[0], factors[1], factors[2], look.specular,
                               eye[0],     eye[1],     eye[2],     look.shininess};
  const std::size_t channels = light.rest.channels.size(), padded = (channels + 3) / 4 * 4;
  for (std::size_t k = 0; k < channels; ++k)
    for (Eigen::Index c = 0; c < 4; ++c)
      values.push_back(colors_ && c < 3 ? colors_->highlight(c, static_cast<Eigen::Index>(k)) : 0);
  const LightCoefficients rest = scale_light(irradiance(light.rest), 1 / std::numbers::pi);
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t c = 0; c < padded; ++c) values.push_back(c < channels ? rest.channels[c][i] : 0);
  for (const DirectLight& direct : light.direct) {
    values.insert(values.end(), {direct.place[0], direct.place[1], direct.place[2], direct.radius});
    values.insert(values.end(), direct.radiance.begin(), direct.radiance.end());
    values.insert(values.end(), padded - channels, 0.f);
  }
  return values;
}

void AssetRenderer::bind_surface_maps(const GlProgram& used, bool by_table) const {
  if (opacity_map_.texture.name() != 0) glBindTextureUnit(opacity_unit, opacity_map_.texture.name());
  const bool is_own = (!lit_ || lit_->look.own_albedo) && (!colors_ || by_table);
  if (albedo_map_.texture.name() != 0) glBindTextureUnit(albedo_unit, (is_own ? albedo_map_ : white_).texture.name());
  if (!by_table) return;
  glBindTextureUnit(colors_unit, color_table_.texture.name());
  if (has_measured_materials()) {
    glBindTextureUnit(materials_unit, material_numbers_.texture.name());
    glBindTextureUnit(measured_unit, measured_colors_.texture.name());
  }
  glProgramUniformMatrix3fv(used.name(), products_location, colors_->functions(), GL_FALSE,
                            colors_->table.products.front().data());
}

const GlProgram& AssetRenderer::program(Pass pass) {
  if (const auto found = programs_.find(pass); found != programs_.end()) return found->second;
  ShaderDefines defines = {{"PRT_SAMPLES", std::to_string(samples_.are_vertices() ? 1 : samples_.count())}};
  if (is_clustered()) defines.emplace_back("PRT_CLUSTERED", "1");
  if (albedo_map_.texture.name() != 0) defines.emplace_back("ALBEDO_MAP", "1");
  if (opacity_map_.texture.name() != 0) defines.emplace_back("OPACITY_MAP", "1");
  if (has_measured_materials()) defines.emplace_back("MEASURED_MATERIALS", "1");
  const ShaderDefines in_functions = {{"PRT_FUNCTIONS", std::to_string(colors_ ? colors_->functions() : 3)},
                                      {"COLOR_FUNCTIONS", std::to_string(colors_ ? colors_->functions() : 3)}};
  ShaderDefines phong = defines;
  phong.emplace_back("PHONG", "1");
  if (colors_) phong.push_back(in_functions.back());
  if (differs_by_albedo()) defines.insert(defines.end(), in_functions.begin(), in_functions.end());
  ShaderDefines normal_mapped = phong;
  normal_mapped.emplace_back("NORMAL_MAP", "1");
  ShaderDefines at_vertices = defines;
  at_vertices.emplace_back("PRT_PLACES", "1");
  GlProgram made;
  switch (pass) {
    case Pass::phong:
      made = load_program({"render_surface.vert", "render_phong.frag"}, phong);
      break;
    case Pass::normal_map:
      made = load_program({"render_surface.vert", "render_phong.frag"}, normal_mapped);
      break;
    case Pass::vertex_prt:
      made = load_program({"render_vertex_prt.vert", "render_vertex_prt.frag"},
                          samples_.are_vertices() ? at_vertices : defines);
      break;
    case Pass::prt:
      at_vertices.front().second = "3";  // the vertices around a point
      made = samples_.are_vertices() ? load_program({"render_corners.vert", "render_prt.frag"}, at_vertices)
                                     : load_program({"render_surface.vert", "render_prt.frag"}, defines);
      break;
    case Pass::appearance:
      made = load_program({"render_surface.vert", "render_appearance.frag"}, defines);
      break;
    case Pass::deferred:
      made = load_program({"render_deferred.vert", "render_deferred.frag"}, defines);
      break;
  }
  return programs_.emplace(pass, std::move(made)).first->second;
}

void AssetRenderer::prepare(Technique technique) {
  require_technique(technique, asset_);
  if (is_textured(technique) && planes_.texture.name() == 0) {
    planes_ = upload_planes(asset_);
    cluster_ids_ = upload_cluster_ids(asset_);
  }
  if (technique == Technique::normal_map && normal_map_.texture.name() == 0) normal_map_ = upload_normal_map(asset_);
  if (technique == Technique::vertex_prt && vertex_transfer_.texture.name() == 0)
    vertex_transfer_ = upload_vertex_transfer(asset_);
}

std::shared_ptr<const UploadedLight> AssetRenderer::upload_asset_light(const AssetLight& light,
                                                                       const SurfaceLook& look) const {
  if (light.samples.size() != samples_.points.size())
    throw std::invalid_argument("AssetRenderer: the light must have one sample for each of the asset's points");
  auto lit = std::make_shared<UploadedLight>();
  lit->light = light;
  lit->look = look;
  const LightReaders read = readers(look);
  std::vector<std::vector<PlaneWeights>> plane_weights, vertex_weights;
  for (const LightCoefficients& sample : light.samples) {
    if (!asset_.is_per_vertex()) plane_weights.push_back(cluster_weights(asset_, sample, read));
    vertex_weights.push_back({vector_weights(asset_, sample, read)});
  }
  if (!plane_weights.empty()) lit->planes = upload_light(plane_weights);
  lit->vertices = upload_light(vertex_weights);
  return lit;
}

void AssetRenderer::bind_prt(const GlProgram& used, const UploadedTexture& light, int layers, int clusters) const {
  glBindTextureUnit(light_unit, light.texture.name());
  glProgramUniform1i(used.name(), layers_location, layers);
  glProgramUniform1i(used.name(), clusters_location, clusters);
}

void AssetRenderer::draw_triangles(const GlProgram& used, const Eigen::Matrix4f& clip_from_object) const {
  glProgramUniformMatrix4fv(used.name(), clip_from_object_location, 1, GL_FALSE, clip_from_object.data());
  glUseProgram(used.name());
  glBindVertexArray(mesh_.vertices.name());
  glDrawElements(GL_TRIANGLES, mesh_.index_count, GL_UNSIGNED_INT, nullptr);
}

void AssetRenderer::draw_corners(const GlProgram& used, const Eigen::Matrix4f& clip_from_object) const {
  glProgramUniformMatrix4fv(used.name(), clip_from_object_location, 1, GL_FALSE, clip_from_object.data());
  glUseProgram(used.name());
  glBindTextureUnit(triangles_unit, corners_.triangles.name());
  glBindVertexArray(corners_.vertices.name());
  glDrawArrays(GL_TRIANGLES, 0, corners_.count);
}

void AssetRenderer::draw(Technique technique, const Eigen::Matrix4f& clip_from_object,
                         const Eigen::Vector3f& eye_object) {
  prepare(technique);
  if (!lit_) throw std::logic_error("AssetRenderer: no light was set");
  if (technique == Technique::phong || technique == Technique::normal_map) {
    const GlProgram& used = program(technique == Technique::phong ? Pass::phong : Pass::normal_map);
    bind_surface_maps(used, colors_ != nullptr);
    const std::vector<float> values = phong_buffer(eye_object);
    phong_lights_ = make_buffer(std::span<const float>(values));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, phong_binding, phong_lights_.name());
    glBindTextureUnit(normal_map_unit, normal_map_.texture.name());
    draw_triangles(used, clip_from_object);
  } else if (technique == Technique::vertex_prt) {
    const GlProgram& used = program(Pass::vertex_prt);
    bind_surface_maps(used, differs_by_albedo());
    bind_prt(used, lit_->vertices, layer_count(asset_.vector_length()), 1);
    glBindTextureUnit(vertex_transfer_unit, vertex_transfer_.texture.name());
    draw_triangles(used, clip_from_object);
  } else {
    const GlProgram& used = program(Pass::prt);
    bind_surface_maps(used, differs_by_albedo());
    bind_planes(used);
    if (samples_.are_vertices())
      draw_corners(used, clip_from_object);
    else
      draw_triangles(used, clip_from_object);
  }
  check_gl("drawing the asset");
}

void AssetRenderer::bind_planes(const GlProgram& used) const {
  bind_prt(used, lit_->planes, layer_count(asset_.planes.size()), asset_.clusters ? asset_.clusters->count : 1);
  glBindTextureUnit(planes_unit, planes_.texture.name());
  if (is_clustered()) glBindTextureUnit(cluster_ids_unit, cluster_ids_.texture.name());
}

void AssetRenderer::draw_appearance(const Eigen::Matrix4f& clip_from_object, int number) {
  const GlProgram& used = program(Pass::appearance);
  glProgramUniform1f(used.name(), asset_number_location, static_cast<float>(number));
  bind_surface_maps(used, false);
  draw_triangles(used, clip_from_object);
}

void AssetRenderer::shade_appearance(int number) {
  prepare(natural_technique(asset_));
  if (!lit_) throw std::logic_error("AssetRenderer: no light was set");
  const GlProgram& used = program(Pass::deferred);
  bind_planes(used);
  bind_surface_maps(used, differs_by_albedo());
  glProgramUniform1f(used.name(), asset_number_location, static_cast<float>(number));
  glUseProgram(used.name());
  glBindVertexArray(mesh_.vertices.name());  // the core profile requires one, although the shader reads nothing from it
  glDrawArrays(GL_TRIANGLES, 0, 3);
  check_gl("shading the asset");
}

GpuMemory AssetRenderer::memory(Technique technique) const {
  constexpr std::uint64_t number = sizeof(float);
  GpuMemory memory;
  memory.indices = static_cast<std::uint64_t>(mesh_.index_count) * sizeof(std::uint32_t);
  memory.per_vertex = 3 * number;
  const bool phong = technique == Technique::phong || technique == Technique::normal_map;
  if (phong) memory.per_vertex += 3 * number;
  if (technique != Technique::phong && technique != Technique::vertex_prt) memory.per_vertex += 2 * number;
  if (!phong && samples_.count() > 1 && !samples_.are_vertices()) memory.per_vertex += most_incident_samples * number;
  if (technique == Technique::normal_map) memory.per_mesh += normal_map_.bytes;
  if (technique == Technique::vertex_prt) {
    memory.per_mesh += lit_ ? lit_->vertices.bytes : 0;
    memory.per_vertex += vertex_transfer_.bytes / std::max<std::size_t>(1, mesh_.vertex_count);
  }
  memory.per_mesh +=
      albedo_map_.bytes + opacity_map_.bytes + color_table_.bytes + material_numbers_.bytes + measured_colors_.bytes;
  if (is_textured(technique))
    memory.per_mesh += planes_.bytes + cluster_ids_.bytes + corners_.bytes + (lit_ ? lit_->planes.bytes : 0);
  return memory;
}

}  // namespace kiln
