// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/stretch.h"
#include "base/json_fwd.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// Measures of an atlas that follow from its mesh alone.
struct AtlasMeasures {
  int charts = 0;
  int triangles = 0;
  int vertices = 0;
  std::int64_t covered_texels = 0;
  double utilisation = 0;  ///< covered texels over all texels
  std::int64_t overlapping_texels = 0;
  int smallest_gap_texels =
      0;                      ///< fewest uncovered texels between covered ones of two charts, or of one and the border
  int flipped_triangles = 0;  ///< mirrored in the atlas
  int uncovered_triangles =
      0;  ///< triangles that cover no texel's centre: they lie between the centres of their neighbours' texels
  int uncovered_charts = 0;    ///< charts that consist of such triangles alone and have no texel
  Stretch stretch;             ///< with each chart at its own scale
  double texels_per_unit = 0;  ///< texels per unit of length: the square root of texels over area, of the whole atlas
  double density_min = 0;      ///< the same for the chart that has least; and most
  double density_max = 0;
  double seam_length = 0;  ///< length of edges whose triangles are not neighbours in the atlas, each once; object units
  double seam_length_relative = 0;          ///< relative to the square root of the surface's area
  double visible_seam_length_relative = 0;  ///< likewise, each edge weighted by the share of the sky that its ends see

  /// Uncovered triangles, the first 100 of them.
  struct Uncovered {
    std::uint32_t triangle = 0;
    bool without_area = false;  ///< no area in the atlas; else smaller or thinner than a texel
  };
  std::vector<Uncovered> uncovered;

  Json to_json() const;
};

/// Measures an atlas with normals and uvs.
AtlasMeasures measure_atlas(const TriangleMesh& atlas, int width, int height);

/// Numbers the charts, from 0, and returns the chart of each triangle. Triangles of a chart are connected by common
/// vertices, or by vertices of the same position and uv. Triangles without uv area have no chart (no_index).
std::vector<std::uint32_t> charts_of_triangles(const TriangleMesh& atlas);

/// Returns the fewest uncovered texels between covered ones of two charts, or of one and the atlas's border. `chart_of`
/// comes from charts_of_triangles, for the mesh that was rasterised.
int smallest_gap(const UvRaster& raster, const std::vector<std::uint32_t>& chart_of);

}  // namespace kiln
