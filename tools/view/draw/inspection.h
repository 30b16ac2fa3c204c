// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "asset/prt_asset.h"
#include "gpu/gl_objects.h"
#include "runtime/draw/asset_uploads.h"
#include "runtime/draw/frame.h"

namespace kiln {

/// Drawings of an asset that say how it is made, not how it looks: colours to be shown as they are. Needs the GL
/// context in which it was made.
class Inspection {
 public:
  /// Uploads the triangles, and the normal map where there is one. Throws BadInput where that is broken.
  explicit Inspection(const PrtAsset& asset);

  /// Normals of the map, or of the mesh where there is none, n / 2 + 1/2.
  void draw_normals(const Eigen::Matrix4f& clip_from_object, const Frame& frame) const;

  /// Each chart of the atlas, that is each part of the mesh as it is split at seams, in a colour of its own.
  void draw_charts(const Eigen::Matrix4f& clip_from_object, const Eigen::Vector3f& eye_object,
                   const Frame& frame) const;

  /// The edges of visible triangles, `width_samples` wide: coverage in alpha.
  void draw_edges(const Eigen::Matrix4f& clip_from_object, float width_samples, const Frame& frame) const;

 private:
  void draw(const GlProgram& program, const Eigen::Matrix4f& clip_from_object, const Frame& frame) const;

  GLsizei corner_count_ = 0;
  GlBuffer corners_;
  GlVertexArray vertices_;
  UploadedTexture normal_map_;
  GlProgram normals_, charts_, edges_;
};

/// A colour for a chart, 0 to 1 as it is to be shown, far from those of the charts numbered next to it.
Eigen::Vector3f chart_colour(std::size_t chart);

}  // namespace kiln
