// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "asset/prt_asset.h"
#include "bake/bake.h"
#include "bake/scene/buried_receivers.h"
#include "base/command_line.h"

namespace kiln {

struct BakePaths {
  std::filesystem::path atlas;                   ///< per vertex: any mesh
  std::filesystem::path detail;                  ///< empty: none
  std::vector<std::filesystem::path> occluders;  ///< empty: the atlas' own mesh
  std::filesystem::path output;
};

struct BakeScene {
  TriangleMesh atlas;  ///< empty in a bake per vertex
  TexelReceivers receivers;
  Occluders occluders;
  std::vector<std::filesystem::path> further_files;  ///< that were read: neighbours, and what holds meshes' albedo
  std::vector<std::string> neighbours;               ///< as --neighbour has them
  std::vector<std::string> warnings;
  std::vector<std::string> said_warnings;  ///< those of an earlier stage
  void add_warnings(const std::vector<std::string>& further);

  NormalSpace normal_space = NormalSpace::object;  ///< of the normal map
  PrtAlbedo albedo;                                ///< of the receivers, as ranges.json is to have it
  BuriedReport buried;                             ///< what is not among the receivers
  double high_area = 0;  ///< of the mesh that receivers on the high mesh stand on, square object units; else 0

  // Of a bake per vertex alone.
  TriangleMesh vertex_mesh;  ///< as it is to be written, normals those of the receivers
  Json vertex_metrics;
};

/// What is wrong with the number of directions: fewer than the bands need (directions_for_bands), or none.
std::vector<std::string> direction_warnings(const BakeSettings& settings);

/// Loads what a bake needs. Throws WrongUsage where settings and paths do not go together, BadInput for bad files.
BakeScene load_bake_scene(const BakePaths& paths, const BakeSettings& settings);

/// Metrics of bake.json that do not depend on what was written.
Json describe_bake(const BakeScene& scene, const BakeResult& result);

/// Writes the planes, ranges.json and copies of the mesh and the normal map (per vertex: ranges.json and the mesh that
/// holds the coefficients), so that the folder is all a runtime needs; reads the planes back and measures; verifies if
/// settings ask for it. Gives the metrics of bake.json.
Json save_bake(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeResult& result,
               const BakeSettings& settings, const CommandLine& command);

}  // namespace kiln
