#pragma once

#include <cstdint>
#include <vector>

#include "atlas/stretch.h"
#include "base/options.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// What can be told of an atlas from its mesh alone.
struct AtlasMeasures {
  int charts = 0;
  int triangles = 0;
  int vertices = 0;
  std::int64_t covered_texels = 0;
  double utilisation = 0;  ///< covered texels over all
  std::int64_t overlapping_texels = 0;
  int smallest_gap_texels = 0;  ///< uncovered texels between covered ones of two charts, or of one and the border
  int flipped_triangles = 0;    ///< mirrored in the atlas
  int uncovered_triangles = 0;  ///< cover no texel's centre: they lie between those of their neighbours
  int uncovered_charts = 0;     ///< consist of such triangles alone: no texel is theirs
  Stretch stretch;              ///< each chart by its own scale
  double texels_per_unit = 0;   ///< of length: the square root of texels over area, of the whole atlas
  double density_min = 0;       ///< the same of the chart that has least; and most
  double density_max = 0;
  double seam_length = 0;  ///< of edges whose triangles are not neighbours in the atlas, each once; object units
  double seam_length_relative = 0;          ///< over the square root of the surface's area
  double visible_seam_length_relative = 0;  ///< the same, each edge times the share of the sky that its ends see

  /// The uncovered triangles, the first 100 of them.
  struct Uncovered {
    std::uint32_t triangle = 0;
    bool without_area = false;  ///< in the atlas; else it is smaller or thinner than a texel
  };
  std::vector<Uncovered> uncovered;

  Json to_json() const;
};

/// `atlas` has normals and uvs.
AtlasMeasures measure_atlas(const TriangleMesh& atlas, int width, int height);

/// The chart of each triangle, from 0 on: those connected by common vertices, or by ones of the same place and uv.
/// Triangles without uv area have none (no_index).
std::vector<std::uint32_t> charts_of_triangles(const TriangleMesh& atlas);

/// Uncovered texels between covered ones of two charts, or of one and the atlas's border, at the closest. `chart_of` as
/// above, for the mesh that was rasterised.
int smallest_gap(const UvRaster& raster, const std::vector<std::uint32_t>& chart_of);

}  // namespace kiln
