// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/engines/shadow_settings.h"
#include "bake/engines/transfer_engine.h"
#include "gpu/gl_objects.h"
#include "sh/ray_offset.h"

namespace kiln {

/// Side of a region of a depth map, texels.
inline constexpr int region_texels = 16;

/// Depth maps of a batch of directions.
class ShadowMaps {
 public:
  ShadowMaps(const TransferScene& scene, const ShadowMapSettings& settings);

  /// Draws one map for each of at most settings.batch_directions directions. Also binds the batch's frames (views) to
  /// shader storage binding 0.
  void draw(std::span<const Eigen::Vector3f> directions);

  /// Binds the maps to texture units: 0 the depths, 1 the back faces' depths (ShadowFaces::midpoint), 2 the triangles
  /// (settings.triangle_ids); of these also the vertices of each triangle to shader storage binding 6.
  void bind() const;

  /// Draws, with settings.regions, the least and the greatest depth of every region_texels x region_texels texels of
  /// the maps now drawn, to texture unit 3 by bind().
  void draw_regions(int directions) const;

  /// Returns the largest error of a stored depth.
  float depth_rounding() const;

  /// Returns how far a receiver may be off the surface that it stands on: rounding_offset of the occluders, object
  /// units.
  float position_rounding() const { return rounding_offset(hull_); }

  /// Returns, with settings.triangle_ids, the vertices of each triangle; vertices at the same place are one.
  std::span<const std::array<std::uint32_t, 3>> corners() const { return corners_; }

 private:
  /// One kind of depth map: the faces it culls, and its texture.
  struct Pass {
    GLenum culled = GL_NONE;
    GlTexture maps;
    GlFramebuffer framebuffer;
  };

  void add_pass(GLenum culled, int layers);
  void draw_layers(const Pass& pass, int first, int count) const;

  ShadowMapSettings settings_;
  int size_;
  GLsizei indices_;
  bool layered_;
  std::vector<Eigen::Vector3f> hull_;
  GlBuffer positions_;
  GlBuffer triangles_;
  GlBuffer views_;
  GlVertexArray occluders_;
  std::vector<Pass> passes_;
  GlTexture triangle_maps_;
  std::vector<std::array<std::uint32_t, 3>> corners_;
  GlBuffer corner_buffer_;
  GlProgram program_;
  GlTexture region_maps_;  // with settings.regions
  GlProgram region_program_;
};

}  // namespace kiln
