// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_fwd.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "collapse/level_chain.h"
#include "lod/lod_settings.h"
#include "lod/measure.h"
#include "maps/asset_hints.h"
#include "mesh/draco_file.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Atlas mesh that levels are made of, and what they are measured against.
struct LodInput {
  const TriangleMesh& atlas;
  const TriangleMesh* high = nullptr;  ///< in the frame of the atlas; null: none
  Extent size = 512;                   ///< of the atlas, texels
  double overhang_texels = 0;
  DracoQuantisation quantisation = {};  ///< of the atlas's file
  std::string file;                     ///< the atlas's, for messages
};

/// Returns the input as settings and records beside the atlas say. Throws WrongUsage where the size is known by
/// neither.
LodInput lod_input(const TriangleMesh& atlas, const TriangleMesh* high, const LodSettings& settings,
                   const AssetHints& hints, const std::string& file);

/// Level of detail as it was written, measured on what the file holds. Lengths are in units of the file.
struct WrittenLevel {
  std::string file;
  double goal = 0;  ///< share of triangles, or pixels, that was asked for
  bool reached_goal = true;
  std::size_t triangles = 0, vertices = 0;
  TexelDisplacement texels;
  double hausdorff = 0, rms = 0;            ///< to the atlas mesh
  double high_hausdorff = 0, high_rms = 0;  ///< to the high mesh, where there is one
  double error = 0;     ///< the larger of the Hausdorff distance and the largest displacement of a texel
  double distance = 0;  ///< from the camera to the asset's centre, from which on the level is proposed
};

struct LodResult {
  std::vector<WrittenLevel> levels;
  std::vector<std::string> warnings;
  double radius = 0;  ///< of the sphere about the asset's box
  double collapse_seconds = 0;
  double seconds = 0;

  Json to_json(const LodInput& input) const;
};

/// Makes levels of detail, writes them into `outputs` as lod_1.drc and so on, the finest first, and measures them. A
/// goal that leaves no fewer triangles than the level before makes none, with a warning. Throws BadInput where there is
/// none at all.
LodResult make_levels(OutputSet& outputs, const LodInput& input, const LodSettings& settings,
                      const ProgressFunction& progress = no_progress);

}  // namespace kiln
