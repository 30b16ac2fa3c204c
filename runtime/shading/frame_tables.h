// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "gpu/gl_objects.h"
#include "runtime/shading/shaded_scene.h"

namespace kiln {

/// View of a light from which its shadow map is drawn.
struct ShadowView {
  Eigen::Matrix4f clip_from_scene;
  /// Width of the map at a depth of 1 for a ball, anywhere for a distant light; scene units.
  float width = 1;
};

/// Fits the view of a light to the points that cast shadows (at least one). Throws WrongUsage for a ball that stands
/// among them: one map cannot see all around.
ShadowView shadow_view(const DirectLight& light, std::span<const Eigen::Vector3d> casters);

/// Lists the corners of the placed boxes of all nodes that cast shadows.
std::vector<Eigen::Vector3d> shadow_casters(const ShadedScene& scene, std::span<const BoundingBox> mesh_boxes);

/// Makes the matrix that mirrors the scene at a plane: column vectors.
Eigen::Matrix4d mirror_matrix(const MirrorPlane& mirror);

/// Depth maps of all lights with a direction, in layers of one texture, with comparing lookup [Reeves 1987].
class ShadowTable {
 public:
  ShadowTable(int size, int layers);
  int size() const { return size_; }
  const GlTexture& texture() const { return texture_; }

  /// Binds and clears a layer, with the state for drawing depths.
  void begin(int layer) const;

 private:
  int size_;
  GlTexture texture_;
  std::vector<GlFramebuffer> layers_;
};

}  // namespace kiln
