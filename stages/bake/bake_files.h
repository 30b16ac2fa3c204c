#pragma once

#include <filesystem>
#include <vector>

#include "bake/bake.h"
#include "base/command_line.h"

namespace kiln {

struct BakePaths {
  std::filesystem::path atlas;
  std::filesystem::path detail;                  ///< empty: none
  std::vector<std::filesystem::path> occluders;  ///< empty: the atlas' own mesh
  std::filesystem::path output;
};

struct BakeScene {
  TexelReceivers receivers;
  Occluders occluders;
};

/// Loads what a bake needs. Throws WrongUsage where settings and paths do not go together, BadInput for bad files.
BakeScene load_bake_scene(const BakePaths& paths, const BakeSettings& settings);

/// Writes the planes, ranges.json and copies of the mesh and the normal map, so that the folder is all a runtime needs;
/// reads the planes back and measures; verifies if settings ask for it. Gives the metrics of bake.json.
Json save_bake(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeResult& result,
               const BakeSettings& settings, const CommandLine& command);

}  // namespace kiln
