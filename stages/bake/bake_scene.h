// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "bake/bake_settings.h"
#include "bake/scene/buried_receivers.h"
#include "base/json.h"

namespace kiln {

/// Files of a bake.
struct BakePaths {
  std::filesystem::path atlas;                   ///< per vertex: any mesh
  std::filesystem::path detail;                  ///< empty: none
  std::vector<std::filesystem::path> occluders;  ///< empty: the atlas' own mesh
  std::filesystem::path levels;                  ///< folder of kiln-lod; empty: none
  std::filesystem::path output;
};

/// Loaded inputs of a bake.
struct BakeScene {
  TriangleMesh atlas;  ///< empty in a bake per vertex
  ReceiverSet receivers;
  Occluders occluders;
  std::vector<std::filesystem::path>
      further_files;                    ///< other files that were read: neighbours, and files of meshes' albedo
  std::vector<std::string> neighbours;  ///< neighbours as --neighbour has them
  std::vector<std::string> warnings;
  std::vector<std::string> said_warnings;  ///< warnings that an earlier stage has said
  void add_warnings(const std::vector<std::string>& further);

  NormalSpace normal_space = NormalSpace::object;   ///< space of the normal map
  std::optional<PrtSpectrum> spectrum;              ///< wavelengths of the channels, of a bake by wavelengths
  PrtAlbedo albedo;                                 ///< albedo of the receivers, for ranges.json
  int own_normal_width = 0, own_normal_height = 0;  ///< texels of the normal map that ships, as DetailMaps has them
  bool has_opacity_map = false;                     ///< the detail folder has a map of opacity
  std::vector<PrtLevel> levels;                     ///< levels of detail to ship, of paths.levels
  BuriedReport buried;                              ///< receivers that were set aside
  double high_area = 0;  ///< area of the high mesh that receivers stand on, square object units; else 0

  // A bake per vertex alone has these.
  TriangleMesh vertex_mesh;  ///< mesh to write, with the receivers' normals
  Json vertex_metrics;
};

/// Loads the inputs of a bake. Throws WrongUsage where settings and paths do not go together, BadInput for bad files.
BakeScene load_bake_scene(const BakePaths& paths, const BakeSettings& settings);

}  // namespace kiln
