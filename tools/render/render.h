// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/options.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "lights/light_settings.h"
#include "mesh/placement.h"
#include "render/render_settings.h"
#include "runtime/light/scene_lights.h"

namespace kiln {

/// What kiln-render is given to draw.
struct RenderPaths {
  std::vector<std::filesystem::path> assets;
  std::filesystem::path compressed;  ///< of the only asset; empty: none
  std::vector<std::string> places;   ///< of the assets, in their order; those without one stand side by side
  std::filesystem::path light_file;  ///< empty: none
  bool each_light = false;           ///< a picture for each light, none for all
  bool each_asset = false;           ///< a picture for each asset, none of all
  std::filesystem::path probes;      ///< of the first asset; empty: none
};

struct RenderScene {
  std::vector<PrtAsset> assets;
  std::vector<std::string> names;  ///< of their folders
  std::vector<Placement> placements;
  std::string note;                    ///< where assets without a place were stood; empty: all have one
  std::optional<PrtAsset> compressed;  ///< another form of the only asset
  std::optional<ProbeSet> probes;      ///< of the first asset, for the others, or for the only one
  std::vector<LightSpec> specs;
  SceneLights lights;
  std::vector<SceneLights> each_light;  ///< of each picture, where there is one for each light
  bool each_asset = false;              ///< whether there is one for each asset
};

/// Throws WrongUsage for options that do not go together, BadInput for bad files.
RenderScene load_render_scene(const RenderPaths& paths, const LightSettings& lights, const RenderSettings& settings);

/// Draws a picture, one for each light or asset, a turntable or a sheet of techniques into files of `outputs`, `name`
/// being the picture's, and gives the metrics, those of the first picture; in texture space that of relit_atlas.
/// `threads` is for a software GL renderer. Throws MachineLacks where there is no GL.
Json render_to_files(OutputSet& outputs, const std::string& name, const RenderScene& scene,
                     const RenderSettings& settings, int threads, const ProgressFunction& progress);

}  // namespace kiln
