// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/json_fwd.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "image/image.h"
#include "maps/normal_space.h"
#include "maps/seam_choice.h"
#include "maps/seams.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"
#include "normals/high_materials.h"
#include "normals/high_parts.h"
#include "normals/map_settings.h"
#include "normals/match_plan.h"
#include "normals/texel_means.h"

namespace kiln {

/// One map: values, and what they mean.
struct SurfaceMap {
  MapKind kind = MapKind::height;
  Image<float> values;             ///< 1 or 3 channels, gutters filled; of materials sRGB-encoded colours of 0 to 1
  double lowest = 0, highest = 1;  ///< values that a PNG stores as 0 and as its largest number
  std::string unit;                ///< "" for shares; "length" or "1/length", in the units of the high mesh's file
};

/// What maps are made of. Positions are in the frame of both meshes.
struct MapInputs {
  const TriangleMesh& high;
  const HighParts& parts;  ///< of `high`
  const MatchPlan& plan;
  const TriangleMesh& atlas;
  const UvRaster& raster;                 ///< of `atlas`
  const Image<float>& position;           ///< points of `high`, at covered texels
  const Image<float>& normal;             ///< its normals there, about unit length, in object space
  const std::vector<std::uint8_t>& seen;  ///< 1 where a texel is covered and its point not inside another part
  const Seams& seams;
  SeamChoice seam_choice = SeamChoice::equalise;
  NormalSpace space = NormalSpace::object;  ///< of the bent normals
  const HighMaterials& materials;
  const TriangleMesh& occluder;                     ///< `high`, without what its opacity cuts away
  const std::vector<std::uint32_t>& occluder_part;  ///< part of each of its triangles; empty where the plan has none
  const TexelMeans* means;                          ///< for maps of shares and emission; null where there are none
};

/// Makes the maps that `settings` name, in their order. Texels whose point lies inside another part get the values of
/// their neighbours. See README.md for what each holds.
std::vector<SurfaceMap> make_maps(const MapInputs& inputs, const MapSettings& settings,
                                  const ProgressFunction& progress = no_progress);

/// Tells whether `settings` name a map that needs means over texels.
bool needs_means(const MapSettings& settings);

/// Writes the maps, and removes those of an earlier run that are not among them. Returns for each its file, range, unit
/// and, of materials, their colours.
Json write_maps(OutputSet& outputs, const std::vector<SurfaceMap>& maps, const MapSettings& settings,
                const MaterialIds& materials);

}  // namespace kiln
