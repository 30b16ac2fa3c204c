// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/json_fwd.h"
#include "base/progress.h"
#include "image/image.h"
#include "maps/asset_hints.h"
#include "maps/detail_maps.h"
#include "maps/seams.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"
#include "normals/albedo_map.h"
#include "normals/high_materials.h"
#include "normals/map_error.h"
#include "normals/map_set.h"
#include "normals/match_plan.h"
#include "normals/normals_settings.h"
#include "normals/opacity_map.h"

namespace kiln {

struct NormalsResult {
  Image<std::uint16_t> normal;                     ///< content of normal.png: 3 channels, n * 0.5 + 0.5, gutters filled
  std::optional<Image<std::uint16_t>> own_normal;  ///< the same at the size of its own that the settings ask for
  Image<float> position;                           ///< object-space point of the high mesh, 3 channels, gutters filled
  Image<std::uint8_t> coverage;                    ///< 255 where covered, else 0
  Image<std::uint8_t> match;                       ///< 3 channels: a colour of texel_way_colours for each texel

  SurfaceAlbedo albedo;                 ///< albedo of the high mesh
  std::optional<AlbedoMap> albedo_map;  ///< only where the albedo is not constant

  std::optional<OpacityMap> opacity_map;  ///< only where the high mesh is not opaque everywhere

  std::vector<SurfaceMap> maps;  ///< further maps that the settings name
  double map_seconds = 0;        ///< part of the time spent on these

  NormalSpace space = NormalSpace::object;
  std::int64_t covered_texels = 0;
  double found_by_ray_outwards = 0;  ///< shares of the covered texels, together 1
  double found_by_ray_inwards = 0;
  double found_by_nearest_point = 0;
  double disagreeing = 0;    ///< share of texels whose high point faces the other side; part of found_by_nearest_point
  double cage_distance = 0;  ///< object units; the largest, where parts or places differ
  std::string cage_source;   ///< "option", "simplify.json", "measured" or "cage mesh"
  std::vector<std::string> matched_parts;  ///< names of the parts that were matched by name
  std::size_t buried_texels = 0;           ///< covered texels whose point lies inside another part of the high mesh
  double mean_distance = 0;  ///< mean distance from low to high points, as a fraction of the high mesh's diagonal
  double largest_distance = 0;
  double normal_deviation_degrees_mean = 0;  ///< between the low mesh's normal and the map's
  double normal_deviation_degrees_largest = 0;
  double quantisation_degrees_largest = 0;  ///< largest angle between the map's normals and those read back
  std::size_t seam_edges = 0;
  double seam_change_degrees_rms = 0;  ///< rms angle by which equalising turned the covered texels that seams see
  SeamMismatch seam_before;            ///< degrees; before seams are equalised
  SeamMismatch seam_after;             ///< degrees; of the map as written
  MapError map_error;                  ///< of the map as written, over the high mesh
  double seconds = 0;
  double measuring_seconds = 0;  ///< time spent on the metrics

  Json to_json() const;
};

/// Finds, for every texel of the atlas, the point of the high mesh that it stands for (match_surface), and the high
/// mesh's normal there. `high` has normals; `atlas` is atlas.drc decoded, with normals and uvs (throws
/// std::invalid_argument otherwise). Progress reaches 1 when the maps are made, before they are measured. `hints`
/// replace settings that are left automatic. `materials` are those of `high`; `plan` is that of load_match_plan. Throws
/// WrongUsage where the texture is too small for the atlas to cover a texel, BadInput where opacity cuts all of `high`
/// away.
NormalsResult make_normals(const TriangleMesh& high, const TriangleMesh& atlas, const NormalsSettings& settings,
                           const AssetHints& hints = {}, const ProgressFunction& progress = no_progress,
                           const HighMaterials& materials = {}, const MatchPlan& plan = {});

}  // namespace kiln
