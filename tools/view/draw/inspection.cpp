// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/draw/inspection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "gpu/program.h"
#include "mesh/mesh_components.h"

namespace kiln {

namespace {

// Locations of shaders/view_*.vert and .frag.
constexpr GLint clip_from_object_location = 0, eye_location = 1, half_width_location = 1;
constexpr GLuint normal_map_unit = 5;

struct Corner {
  Eigen::Vector3f position;
  Eigen::Vector2f uv;
  Eigen::Vector3f normal;
  Eigen::Vector3f chart;
};

std::vector<Corner> corners_of(const TriangleMesh& mesh) {
  const Components charts = find_components(mesh);
  std::vector<Corner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      corners.push_back({mesh.positions[v], mesh.uvs.empty() ? Eigen::Vector2f(0, 0) : mesh.uvs[v], mesh.normals[v],
                         chart_color(charts.of_triangle[t])});
  return corners;
}

void add_attribute(GLuint vertices, GLuint location, int components, std::size_t offset) {
  glVertexArrayAttribFormat(vertices, location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(vertices, location, 0);
  glEnableVertexArrayAttrib(vertices, location);
}

}  // namespace

Eigen::Vector3f chart_color(std::size_t chart) {
  // Hues a golden ratio apart, so that neighbouring numbers get distant colours; two levels of lightness.
  const double hue = 6 * std::fmod(0.08 + 0.6180339887498949 * static_cast<double>(chart), 1.0);
  const float lightness = chart % 2 == 0 ? 0.92f : 0.72f, saturation = 0.62f;
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c) {
    const double from_peak = std::abs(std::remainder(hue - 2 * c, 6));
    const auto share = static_cast<float>(std::clamp(2 - from_peak, 0.0, 1.0));
    color[c] = lightness * (1 - saturation + saturation * share);
  }
  return color;
}

Inspection::Inspection(const PrtAsset& asset)
    : vertices_(make_vertex_array()),
      charts_(load_program({"view_surface.vert", "view_charts.frag"})),
      edges_(load_program({"view_surface.vert", "view_edges.frag"})) {
  const std::vector<Corner> corners = corners_of(asset.mesh);
  corner_count_ = static_cast<GLsizei>(corners.size());
  corners_ = make_buffer(std::span<const Corner>(corners));
  glVertexArrayVertexBuffer(vertices_.name(), 0, corners_.name(), 0, sizeof(Corner));
  add_attribute(vertices_.name(), 0, 3, offsetof(Corner, position));
  add_attribute(vertices_.name(), 1, 2, offsetof(Corner, uv));
  add_attribute(vertices_.name(), 2, 3, offsetof(Corner, normal));
  add_attribute(vertices_.name(), 3, 3, offsetof(Corner, chart));
  ShaderDefines defines;
  if (!asset.normals_file.empty()) {
    normal_map_ = upload_normal_map(asset);
    defines.emplace_back("NORMAL_MAP", "1");
  }
  normals_ = load_program({"view_surface.vert", "view_normals.frag"}, defines);
  check_gl("uploading the mesh for inspection");
}

void Inspection::draw(const GlProgram& program, const Eigen::Matrix4f& clip_from_object, const Frame& frame) const {
  frame.begin();
  glProgramUniformMatrix4fv(program.name(), clip_from_object_location, 1, GL_FALSE, clip_from_object.data());
  glUseProgram(program.name());
  glBindVertexArray(vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, corner_count_);
  check_gl("drawing the asset for inspection");
}

void Inspection::draw_normals(const Eigen::Matrix4f& clip_from_object, const Frame& frame) const {
  glBindTextureUnit(normal_map_unit, normal_map_.texture.name());
  draw(normals_, clip_from_object, frame);
}

void Inspection::draw_charts(const Eigen::Matrix4f& clip_from_object, const Eigen::Vector3f& eye_object,
                             const Frame& frame) const {
  glProgramUniform3fv(charts_.name(), eye_location, 1, eye_object.data());
  draw(charts_, clip_from_object, frame);
}

void Inspection::draw_edges(const Eigen::Matrix4f& clip_from_object, float width_samples, const Frame& frame) const {
  glProgramUniform1f(edges_.name(), half_width_location, 0.5f * width_samples);
  draw(edges_, clip_from_object, frame);
}

}  // namespace kiln
