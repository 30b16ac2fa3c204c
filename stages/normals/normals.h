#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/options.h"
#include "base/progress.h"
#include "detail/asset_hints.h"
#include "detail/detail_maps.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"
#include "normals/normals_settings.h"

namespace kiln {

struct NormalsResult {
  Image<std::uint16_t> normal;   ///< as normal.png holds it: 3 channels, n * 0.5 + 0.5, gutters filled
  Image<float> position;         ///< object-space point of the high mesh, 3 channels, gutters filled
  Image<std::uint8_t> coverage;  ///< 255 where covered, else 0

  NormalSpace space = NormalSpace::object;
  std::int64_t covered_texels = 0;
  double found_by_ray_outwards = 0;  ///< shares of the covered texels, together 1
  double found_by_ray_inwards = 0;
  double found_by_nearest_point = 0;
  double disagreeing = 0;    ///< share of texels whose high point faces the other side; part of found_by_nearest_point
  double cage_distance = 0;  ///< object units
  std::string cage_source;   ///< "option", "simplify.json" or "measured"
  double mean_distance = 0;  ///< low to high points, fractions of the high mesh's diagonal
  double largest_distance = 0;
  double normal_deviation_degrees_mean = 0;  ///< between the low mesh's normal and the map's
  double normal_deviation_degrees_largest = 0;
  double quantisation_degrees_largest = 0;  ///< between the high mesh's normal and the map's, read back
  double seconds = 0;

  Json to_json() const;
};

/// For every texel of the atlas the point of the high mesh that it stands for (match_surface), and the high mesh's
/// normal there. `high` has normals; `atlas` is atlas.drc decoded, with normals and uvs (throws std::invalid_argument
/// otherwise). `hints` replace settings that are left automatic. Throws WrongUsage where the texture is too small for
/// the atlas to cover a texel.
NormalsResult make_normals(const TriangleMesh& high, const TriangleMesh& atlas, const NormalsSettings& settings,
                           const AssetHints& hints = {}, const ProgressFunction& progress = no_progress);

}  // namespace kiln
