// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "asset/prt_asset.h"
#include "gpu/gl_objects.h"
#include "runtime/draw/asset_uploads.h"
#include "runtime/draw/frame.h"

namespace kiln {

/// Drawings of an asset that show how it is made, not how it looks, in colours to be shown unchanged. Needs the GL
/// context in which it was made.
class Inspection {
 public:
  /// Uploads the triangles, and the normal map if there is one. Throws BadInput if that is damaged.
  explicit Inspection(const PrtAsset& asset);

  /// Draws normals of the map, or of the mesh if there is none, as n / 2 + 1/2.
  void draw_normals(const Eigen::Matrix4f& clip_from_object, const Frame& frame) const;

  /// Draws each chart of the atlas (a part of the mesh as split at seams) in a colour of its own.
  void draw_charts(const Eigen::Matrix4f& clip_from_object, const Eigen::Vector3f& eye_object,
                   const Frame& frame) const;

  /// Draws the edges of visible triangles, `width_samples` wide: coverage in alpha.
  void draw_edges(const Eigen::Matrix4f& clip_from_object, float width_samples, const Frame& frame) const;

 private:
  void draw(const GlProgram& program, const Eigen::Matrix4f& clip_from_object, const Frame& frame) const;

  GLsizei corner_count_ = 0;
  GlBuffer corners_;
  GlVertexArray vertices_;
  UploadedTexture normal_map_;
  GlProgram normals_, charts_, edges_;
};

/// Returns a chart's colour, 0 to 1 to be shown unchanged, distant from those of charts with neighbouring numbers.
Eigen::Vector3f chart_color(std::size_t chart);

}  // namespace kiln
