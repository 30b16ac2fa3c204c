// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/engines/gather_engine.h"
#include "bake/engines/shadow_settings.h"
#include "gpu/gl_objects.h"

namespace kiln {

/// Layers of a surface along a batch of directions, all of them: bundles of parallel rays. [Hachisuka 2005] peels one
/// layer after the other; here one pass leaves every fragment in a list of its texel [Yang 2010], as [Tokuyoshi 2011]
/// does for bundles. For a closed surface the lists hold only the faces that turn away from the light, whose front a
/// receiver beneath them sees.
class BundleLists {
 public:
  BundleLists(const ReflectingSurface& surface, const ShadowMapSettings& settings);

  /// Draws the first of `directions`, as many as memory has room for, and says how many. Binds the frames (views) to
  /// shader storage binding 0, the first entries of texels' lists to 5, the entries to 6. Throws MachineLacks where
  /// even one has no room.
  std::size_t draw(std::span<const Eigen::Vector3f> directions);

  int size_texels() const { return size_; }

 private:
  std::uint32_t draw_once(std::span<const Eigen::Vector3f> directions);

  int size_;
  bool closed_;
  GLsizei indices_;
  std::size_t batch_;     // directions at a time
  std::size_t capacity_;  // entries
  std::vector<Eigen::Vector3f> hull_;
  GlBuffer positions_, triangles_, views_;
  GlBuffer heads_;    // first entry of each texel's list
  GlBuffer entries_;  // depth, triangle, next
  GlBuffer counter_;
  GlVertexArray surface_;
  GlFramebuffer framebuffer_;
  GlProgram program_;
};

}  // namespace kiln
