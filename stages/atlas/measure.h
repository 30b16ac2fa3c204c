#pragma once

#include <cstdint>
#include <vector>

#include "atlas/stretch.h"
#include "base/options.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// What can be told of an atlas from its mesh alone.
struct AtlasMeasures {
  int charts = 0;
  int triangles = 0;
  int vertices = 0;
  std::int64_t covered_texels = 0;
  double utilisation = 0;  ///< covered texels over all
  std::int64_t overlapping_texels = 0;
  int smallest_gap_texels =
      0;                      ///< uncovered texels between covered ones of two charts, or of one and the atlas's border
  int flipped_triangles = 0;  ///< mirrored in the atlas
  Stretch stretch;
  double texels_per_unit = 0;  ///< texels per unit of length, the same for all charts
  double seam_length = 0;      ///< of edges whose triangles are not neighbours in the atlas, each once; object units
  double seam_length_relative = 0;  ///< over the square root of the surface's area

  Json to_json() const;
};

AtlasMeasures measure_atlas(const TriangleMesh& atlas, int width, int height);

/// The chart of each triangle, from 0 on: those connected by common vertices. Triangles without uv area have none
/// (no_index).
std::vector<std::uint32_t> charts_of_triangles(const TriangleMesh& atlas);

}  // namespace kiln
