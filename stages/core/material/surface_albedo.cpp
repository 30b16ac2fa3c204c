// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/surface_albedo.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace kiln {

namespace {

bool is_grey_color(const Eigen::Vector3f& color) { return color.x() == color.y() && color.x() == color.z(); }

}  // namespace

SurfaceAlbedo SurfaceAlbedo::constant(const Eigen::Vector3f& linear, Source source) {
  SurfaceAlbedo albedo;
  albedo.source_ = source;
  albedo.constant_ = linear;
  albedo.is_grey_ = is_grey_color(linear);
  return albedo;
}

SurfaceAlbedo SurfaceAlbedo::measured(const Eigen::Vector3f& linear, Spectrum reflectance) {
  SurfaceAlbedo albedo = constant(linear);
  albedo.reflectance_ = std::make_shared<const Spectrum>(std::move(reflectance));
  return albedo;
}

SurfaceAlbedo SurfaceAlbedo::of_vertices(std::vector<Eigen::Vector3f> linear, std::vector<Triangle> triangles) {
  SurfaceAlbedo albedo;
  albedo.source_ = Source::vertex_colors;
  albedo.is_grey_ = std::all_of(linear.begin(), linear.end(), is_grey_color);
  albedo.vertices_ = std::make_shared<const Vertices>(Vertices{std::move(linear), std::move(triangles)});
  return albedo;
}

SurfaceAlbedo SurfaceAlbedo::of_materials(Textured textured, Source source) {
  SurfaceAlbedo albedo;
  albedo.source_ = source;
  bool has_texture = false;
  for (const Material& material : textured.materials) {
    albedo.is_grey_ = albedo.is_grey_ && is_grey_color(material.color) &&
                      (material.texture == nullptr || material.texture->is_grey());
    has_texture = has_texture || material.texture != nullptr;
  }
  if (has_texture && textured.uvs.size() != textured.material_of.size())
    throw std::invalid_argument("of_materials: texture coordinates for every triangle are needed");
  albedo.textured_ = std::make_shared<const Textured>(std::move(textured));
  return albedo;
}

std::span<const SurfaceAlbedo::Material> SurfaceAlbedo::materials() const {
  return textured_ == nullptr ? std::span<const Material>() : std::span<const Material>(textured_->materials);
}

SurfaceAlbedo SurfaceAlbedo::of_pieces(const std::vector<std::uint32_t>& origins,
                                       const std::vector<std::array<std::array<float, 3>, 3>>& weights) const {
  SurfaceAlbedo pieces = *this;
  if (vertices_ != nullptr) {
    Vertices vertices;
    for (std::size_t t = 0; t < origins.size(); ++t) {
      const auto first = static_cast<std::uint32_t>(vertices.linear.size());
      for (const std::array<float, 3>& weight : weights[t])
        vertices.linear.push_back(at(origins[t], weight[1], weight[2]));
      vertices.triangles.push_back({first, first + 1, first + 2});
    }
    pieces.vertices_ = std::make_shared<const Vertices>(std::move(vertices));
  }
  if (textured_ != nullptr) {
    Textured textured;
    textured.materials = textured_->materials;
    for (std::size_t t = 0; t < origins.size(); ++t) {
      textured.material_of.push_back(textured_->material_of[origins[t]]);
      if (textured_->uvs.empty()) continue;
      const auto& uvs = textured_->uvs[origins[t]];
      auto& corners = textured.uvs.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = weights[t][k][0] * uvs[0] + weights[t][k][1] * uvs[1] + weights[t][k][2] * uvs[2];
    }
    pieces.textured_ = std::make_shared<const Textured>(std::move(textured));
  }
  return pieces;
}

Eigen::Vector3f SurfaceAlbedo::at(std::uint32_t triangle, float u, float v) const {
  if (vertices_ != nullptr) {
    const Triangle& t = vertices_->triangles[triangle];
    const std::vector<Eigen::Vector3f>& linear = vertices_->linear;
    return (1 - u - v) * linear[t[0]] + u * linear[t[1]] + v * linear[t[2]];
  }
  if (textured_ == nullptr) return constant_;
  const Material& material = textured_->materials[textured_->material_of[triangle]];
  if (material.texture == nullptr) return material.color;
  const std::array<Eigen::Vector2f, 3>& uvs = textured_->uvs[triangle];
  const Eigen::Vector2f uv = (1 - u - v) * uvs[0] + u * uvs[1] + v * uvs[2];
  return material.color.cwiseProduct(
      material.texture->at(material.texture_transform * uv.homogeneous(), material.wrap_u, material.wrap_v));
}

std::string SurfaceAlbedo::source_name() const {
  switch (source_) {
    case Source::none:
      return "none";
    case Source::constant:
      return "constant";
    case Source::vertex_colors:
      return "vertex colors";
    case Source::materials:
      return "materials";
    case Source::texture:
      return "texture";
  }
  return "";
}

}  // namespace kiln
