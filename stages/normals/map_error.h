// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "image/image.h"
#include "maps/normal_space.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"
#include "normals/match_plan.h"

namespace kiln {

/// Angles in degrees between the high mesh's normals and those that the low mesh shows with its map.
struct MapError {
  double mean_degrees = 0;
  double percentile_95_degrees = 0;
  double largest_degrees = 0;
};

/// The two meshes, and which parts of them stand for each other.
struct MatchedMeshes {
  const TriangleMesh& high;
  const TriangleMesh& atlas;
  const MatchPlan& plan;
};

/// Measures the map at `samples` points spread evenly over the area of the high mesh (with normals): at the nearest
/// point of the atlas mesh's part that faces the same side, the map is looked up bilinearly, normalised and compared
/// with the high normal. `map` holds unit vectors in `space`, gutters filled; `atlas` has normals and uvs.
MapError measure_map_error(const MatchedMeshes& meshes, const Image<float>& map, NormalSpace space,
                           int samples = 200'000);

/// Differences between the high mesh's albedo and that which the low mesh shows with its map, linear.
struct AlbedoError {
  double rms = 0;            ///< over points and channels
  double percentile_95 = 0;  ///< percentile of the largest channel's difference
};

/// Measures the albedo at the points of measure_map_error; `map` has three linear channels, gutters filled.
AlbedoError measure_albedo_error(const MatchedMeshes& meshes, const SurfaceAlbedo& albedo, const Image<float>& map,
                                 int samples = 200'000);

}  // namespace kiln
