// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "bake/bake_files.h"

namespace kiln {

/// Loads a scene to bake. Receivers are the texels of `asset`, a folder of `kiln build` (atlas.drc and normals/), or,
/// if that is empty, the vertices of `mesh`, which casts the shadows.
inline BakeScene load_bench_scene(const std::filesystem::path& asset, const std::filesystem::path& mesh) {
  BakePaths paths;
  BakeSettings settings;
  paths.occluders = {mesh};
  if (asset.empty()) {
    paths.atlas = mesh;
    settings.per_vertex = true;
    settings.receiver = BakeReceiver::low;  // receivers at the vertices themselves
  } else {
    paths.atlas = asset / "atlas.drc";
    paths.detail = asset / "normals";
  }
  return load_bake_scene(paths, settings);
}

}  // namespace kiln
