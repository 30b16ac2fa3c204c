// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "render/film/film.h"
#include "runtime/play/moving_scene.h"
#include "runtime/shading/shaded_scene.h"
#include "runtime/shading/shader_file.h"

namespace kiln {

/// A scene whose nodes have shaders, with all that it points at.
struct ShadeScene {
  std::filesystem::path file;
  Film film;
  std::vector<TriangleMesh> meshes;  ///< of the description's, without transfer
  std::vector<SurfaceShader> shaders;
  ShadedScene scene;       ///< as it is at time 0; points at the assets and the meshes
  std::vector<int> items;  ///< of the description, for each of the scene's nodes

  /// Returns the scene to be moved in time. This one must live on.
  MovingScene moving(const MovingSceneSettings& settings) const;

  /// Reads the files of the shaders again, for the nodes as they are. Throws BadInput as load_shade_scene does; nothing
  /// has changed then.
  std::vector<SurfaceShader> shaders_again() const;

  /// Lists the folders of the shaders and of the pictures that they name.
  std::vector<std::filesystem::path> shader_folders() const;

  /// Lists the files that were read besides the scene's own and those of assets.
  std::vector<std::filesystem::path> read_files() const;
};

/// Reads a scene.yaml (docs/scenes.md, docs/shaders.md) and what it names. Throws BadInput, with file and line.
ShadeScene load_shade_scene(const std::filesystem::path& file);

/// Says which node has an asset whose transfer includes its albedo, so that a shader's colour would be multiplied onto
/// it; empty where there is none.
std::string note_of_albedo(const ShadeScene& scene);

/// Lists the places of the nodes at the time of `moving`.
std::vector<Placement> placements_now(const ShadeScene& scene, MovingScene& moving);

}  // namespace kiln
