// SPDX-License-Identifier: MIT
#include "runtime/shadow_gl/map_passes.h"

#include <algorithm>
#include <string>

#include "gpu/program.h"
#include "sh/basis.h"

namespace kiln {

namespace {

constexpr std::size_t most_instances = 16384;          // of one draw
constexpr std::size_t most_draw_triangles = 1u << 24;  // drivers reset a device that does not come back for seconds
constexpr int group = 64, most_chunk = 32;             // of shaders/shadow_project.comp

static_assert(sizeof(MapInstance) == 64 && sizeof(MapJob) == 112);

/// Makes a buffer that has at least one element, as bindings need.
GlBuffer make_vectors(const std::vector<Eigen::Vector4f>& values) {
  const std::vector<Eigen::Vector4f> none(1, Eigen::Vector4f::Zero());
  return make_buffer(std::span<const Eigen::Vector4f>(values.empty() ? none : values));
}

}  // namespace

MapPasses::MapPasses(int texels, int layers)
    : texels_(texels),
      layers_(layers),
      maps_(make_texture(GL_TEXTURE_2D_ARRAY)),
      framebuffer_(make_framebuffer()),
      depth_program_(load_program({"shadow_depth.vert"})),
      instances_(make_refilled_buffer(most_instances * sizeof(MapInstance))),
      jobs_(make_refilled_buffer(most_jobs * sizeof(MapJob))),
      counts_(make_zero_buffer(most_jobs * sizeof(std::uint32_t))),
      occluders_(make_vertex_array()) {
  glTextureStorage3D(maps_.name(), 1, GL_DEPTH_COMPONENT32F, texels, texels, layers);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(maps_.name(), filter, GL_NEAREST);
  glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0);
  glNamedFramebufferDrawBuffer(framebuffer_.name(), GL_NONE);
  glVertexArrayAttribFormat(occluders_.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
  glEnableVertexArrayAttrib(occluders_.name(), 0);
  check_gl("setting up visibility maps");
}

void MapPasses::set_meshes(std::span<const TriangleMesh* const> meshes) {
  meshes_.clear();
  std::vector<Eigen::Vector3f> positions;
  std::vector<Triangle> triangles;
  for (const TriangleMesh* mesh : meshes) {
    meshes_.push_back({static_cast<GLint>(positions.size()), static_cast<GLsizei>(3 * mesh->triangles.size()),
                       triangles.size() * sizeof(Triangle)});
    positions.insert(positions.end(), mesh->positions.begin(), mesh->positions.end());
    triangles.insert(triangles.end(), mesh->triangles.begin(), mesh->triangles.end());
  }
  if (triangles.empty()) return;
  positions_ = make_buffer(std::span<const Eigen::Vector3f>(positions));
  triangles_ = make_buffer(std::span<const Triangle>(triangles));
  glVertexArrayVertexBuffer(occluders_.name(), 0, positions_.name(), 0, sizeof(Eigen::Vector3f));
  glVertexArrayElementBuffer(occluders_.name(), triangles_.name());
  check_gl("taking the meshes of shadows");
}

void MapPasses::set_lights(const LightSources& sources, const DirectionSet& sky, int bands) {
  std::vector<Eigen::Vector4f> disc, directions;
  for (std::size_t k = 0; k < sources.pattern.share.size(); ++k)
    disc.emplace_back(sources.pattern.share[k], sources.pattern.cosine[k], sources.pattern.sine[k], 0.f);
  std::vector<float> weights(1, 0.f);
  if (sources.has_sky()) {
    weights.clear();
    for (std::uint32_t d = 0; d < sky.count(); ++d) directions.emplace_back(sky.x[d], sky.y[d], sky.z[d], 0.f);
    for (const SkyLight& light : sources.skies)
      for (const std::vector<float>& radiance : light.radiance)
        weights.insert(weights.end(), radiance.begin(), radiance.end());
  }
  disc_ = make_vectors(disc);
  sky_ = make_vectors(directions);
  weights_ = make_buffer(std::span<const float>(weights));
  if (coefficients_ == coefficient_count(bands)) return;
  coefficients_ = coefficient_count(bands);
  sums_ = make_zero_buffer(static_cast<GLsizeiptr>(most_jobs * sizeof(float)) * coefficients_);
  project_program_ =
      load_program({"shadow_project.comp"}, {{"BANDS", std::to_string(bands)},
                                             {"GROUP", std::to_string(group)},
                                             {"CHUNK", std::to_string(std::min(most_chunk, coefficients_))}});
  check_gl("taking the lights of shadows");
}

void MapPasses::draw(std::span<const std::vector<MapInstance>> instances, float depth_unit, int layers) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  const float nothing = 0;
  glClearTexSubImage(maps_.name(), 0, 0, 0, 0, texels_, texels_, layers, GL_DEPTH_COMPONENT, GL_FLOAT, &nothing);
  glUseProgram(depth_program_.name());
  glBindVertexArray(occluders_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, instances_.name());
  glUniform1f(uniform_location(depth_program_, "depth_unit"), depth_unit);
  const GLint first_instance = uniform_location(depth_program_, "first_instance");
  // Fills the buffer with what follows of a mesh, draws it, and goes on in the rest of the buffer while there is some.
  std::size_t filled = 0;
  for (std::size_t m = 0; m < instances.size(); ++m) {
    const MeshRange& mesh = meshes_[m];
    if (mesh.indices == 0) continue;
    const std::size_t triangles = static_cast<std::size_t>(mesh.indices) / 3,
                      together = std::clamp<std::size_t>(most_draw_triangles / triangles, 1, most_instances);
    for (std::size_t first = 0; first < instances[m].size();) {
      if (filled == most_instances) filled = 0;
      const std::size_t count = std::min({together, instances[m].size() - first, most_instances - filled});
      glNamedBufferSubData(instances_.name(), static_cast<GLintptr>(filled * sizeof(MapInstance)),
                           static_cast<GLsizeiptr>(count * sizeof(MapInstance)), instances[m].data() + first);
      glUniform1i(first_instance, static_cast<GLint>(filled));
      glDrawElementsInstancedBaseVertex(GL_TRIANGLES, mesh.indices, GL_UNSIGNED_INT,
                                        reinterpret_cast<const void*>(mesh.first_index), static_cast<GLsizei>(count),
                                        mesh.first_vertex);
      if (count == together) glFlush();
      first += count;
      filled += count;
    }
  }
}

void MapPasses::run(std::span<const std::vector<MapInstance>> instances, std::span<const MapJob> jobs, float depth_unit,
                    int layers, std::vector<std::uint32_t>& counts, std::vector<float>& sums) {
  draw(instances, depth_unit, layers);
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  refill_buffer<MapJob>(jobs_, jobs);
  GLuint binding = 0;
  for (const GlBuffer* buffer : {&jobs_, &disc_, &sky_, &weights_, &counts_, &sums_})
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer->name());
  glBindTextureUnit(0, maps_.name());
  glUseProgram(project_program_.name());
  glUniform1f(uniform_location(project_program_, "depth_unit"), depth_unit);
  glDispatchCompute(static_cast<GLuint>(jobs.size()), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  counts.resize(jobs.size());
  sums.resize(jobs.size() * static_cast<std::size_t>(coefficients_));
  glGetNamedBufferSubData(counts_.name(), 0, static_cast<GLsizeiptr>(counts.size() * sizeof(std::uint32_t)),
                          counts.data());
  glGetNamedBufferSubData(sums_.name(), 0, static_cast<GLsizeiptr>(sums.size() * sizeof(float)), sums.data());
  check_gl("finding shadows by visibility maps");
}

}  // namespace kiln
