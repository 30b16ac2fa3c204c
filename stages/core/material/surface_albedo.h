// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "material/color_texture.h"
#include "mesh/triangle_mesh.h"
#include "spectrum/spectrum.h"

namespace kiln {

/// Measured reflectance of a surface; the spectrum is null where only an albedo is known.
struct MeasuredSurface {
  std::string name = {};
  std::shared_ptr<const Spectrum> spectrum = {};
};

/// Share of light, as linear red, green and blue, each 0 to 1, that a mesh's diffuse surface reflects. Copies share
/// large data. May be used by several threads at once.
class SurfaceAlbedo {
 public:
  /// Source of the albedo.
  enum class Source { none, constant, vertex_colors, materials, texture };

  /// Material of a textured mesh: its colour times its texture.
  struct Material {
    Eigen::Vector3f color = Eigen::Vector3f::Ones();
    std::shared_ptr<const ColorTexture> texture;  ///< null: none
    /// Transform of the lookup: texture_transform * (u, v, 1).
    Eigen::Matrix<float, 2, 3> texture_transform = Eigen::Matrix<float, 2, 3>::Identity();
    ColorTexture::Wrap wrap_u = ColorTexture::Wrap::repeat, wrap_v = ColorTexture::Wrap::repeat;
    MeasuredSurface measured = {};  ///< its reflectance where that was measured, of which `color` is what RGB has
  };

  /// Triangles with materials, and with the texture coordinates of their corners.
  struct Textured {
    std::vector<Material> materials;
    std::vector<std::uint32_t> material_of;           ///< one per triangle
    std::vector<std::array<Eigen::Vector2f, 3>> uvs;  ///< one per triangle, or none without textures
  };

  /// Makes a white surface of source `none`: no albedo was given or found.
  SurfaceAlbedo() = default;

  static SurfaceAlbedo constant(const Eigen::Vector3f& linear, Source source = Source::constant);

  /// Makes a constant albedo whose reflectance at all wavelengths is known.
  static SurfaceAlbedo measured(const Eigen::Vector3f& linear, Spectrum reflectance);

  /// Returns its materials, which have textures or one colour each; none where it has no materials.
  std::span<const Material> materials() const;

  /// Returns the number of a triangle's material.
  std::size_t material_at(std::uint32_t triangle) const { return textured_->material_of[triangle]; }

  /// Makes an albedo of linear vertex colours, interpolated linearly over `triangles`.
  static SurfaceAlbedo of_vertices(std::vector<Eigen::Vector3f> linear, std::vector<Triangle> triangles);

  static SurfaceAlbedo of_materials(Textured textured, Source source);

  /// Returns the albedo of a mesh whose triangles are pieces of this one's: each lies in its entry of `origins`, whose
  /// corners have `weights` in its own.
  SurfaceAlbedo of_pieces(const std::vector<std::uint32_t>& origins,
                          const std::vector<std::array<std::array<float, 3>, 3>>& weights) const;

  /// Returns the albedo at a point of a triangle: u is the weight of the second corner, v that of the third (as in
  /// SurfacePoint).
  Eigen::Vector3f at(std::uint32_t triangle, float u, float v) const;

  /// Tells whether the albedo is the same everywhere; constant() returns it then.
  bool is_constant() const { return vertices_ == nullptr && textured_ == nullptr; }
  const Eigen::Vector3f& constant_value() const { return constant_; }

  /// Returns the reflectance of a surface that was measured as a whole; null where only its albedo is known, or where
  /// `materials` were measured.
  const Spectrum* reflectance() const { return reflectance_.get(); }

  /// Tells whether red, green and blue are equal everywhere.
  bool is_grey() const { return is_grey_; }

  Source source() const { return source_; }

  /// Returns "none", "constant", "vertex colors", "materials" or "texture".
  std::string source_name() const;

 private:
  struct Vertices {
    std::vector<Eigen::Vector3f> linear;
    std::vector<Triangle> triangles;
  };

  Source source_ = Source::none;
  bool is_grey_ = true;
  Eigen::Vector3f constant_ = Eigen::Vector3f::Ones();
  std::shared_ptr<const Spectrum> reflectance_;
  std::shared_ptr<const Vertices> vertices_;
  std::shared_ptr<const Textured> textured_;
};

}  // namespace kiln
