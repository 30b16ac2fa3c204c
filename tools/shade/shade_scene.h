// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "mesh/triangle_mesh.h"
#include "runtime/shading/shaded_scene.h"
#include "runtime/shading/shader_file.h"

namespace kiln {

/// What kiln-shade reads: a scene whose nodes have shaders, with all that it points at.
struct ShadeScene {
  std::deque<TriangleMesh> meshes;  ///< of files without transfer
  std::deque<PrtAsset> assets;      ///< of baked folders
  ShadedScene scene;
  std::filesystem::path shader_folder;
  std::vector<SurfaceShader> shaders;
  std::vector<std::string> lights;                ///< as for parse_light_spec
  std::map<std::string, std::string> picture;     ///< settings of the picture that the file states, by their names
  std::vector<std::filesystem::path> read_files;  ///< besides the scene's own
};

/// Reads a scene's file (docs/shaders.md) and what it names. Throws BadInput, with file and line.
ShadeScene load_shade_scene(const std::filesystem::path& file);

/// Lists the vertices of all nodes, placed.
std::vector<Eigen::Vector3f> placed_shape(const ShadedScene& scene);

}  // namespace kiln
