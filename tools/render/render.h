// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/json_fwd.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "lights/light_settings.h"
#include "mesh/placement.h"
#include "render/lamps.h"
#include "render/render_settings.h"
#include "runtime/light/scene_lights.h"

namespace kiln {

/// Paths and choices of what kiln-render draws.
struct RenderPaths {
  std::vector<std::filesystem::path> assets;
  std::filesystem::path compressed;  ///< compressed form of the only asset; empty: none
  std::vector<std::string> places;   ///< places of the assets, in their order; those without one stand side by side
  std::filesystem::path light_file;  ///< empty: none
  bool each_light = false;           ///< one picture for each light, instead of one under all
  bool each_asset = false;           ///< one picture for each asset, instead of one of all
  std::filesystem::path probes;      ///< probes of the first asset; empty: none
  LampSettings lamps;                ///< spectra of the lights; none: RGB
};

struct RenderScene {
  std::vector<PrtAsset> assets;
  std::vector<std::string> names;  ///< names of the assets' folders
  std::vector<Placement> placements;
  std::vector<std::vector<Eigen::Vector3f>> shapes;  ///< vertices of the assets' own meshes, whatever level is drawn
  std::string note;                                  ///< where assets without a place were put; empty: all have one
  std::optional<PrtAsset> compressed;                ///< another form of the only asset
  std::optional<ProbeSet> probes;                    ///< probes of the first asset, for the others, or for the only one
  std::vector<LightSpec> specs;
  SceneLights lights;
  std::vector<SceneLights> each_light;  ///< lights of each picture, if there is one for each light
  bool each_asset = false;              ///< whether there is a picture for each asset
  std::optional<LampScene> lamps;       ///< the same scene by spectra, if there are lamps
};

/// Loads assets and lights. Throws WrongUsage for options that exclude each other, BadInput for bad files.
RenderScene load_render_scene(const RenderPaths& paths, const LightSettings& lights, const RenderSettings& settings);

/// Draws into files of `outputs`: a picture called `name`, one for each light or asset, a turntable, or a sheet of
/// techniques. Returns the metrics of the first picture; in texture space those of relit_atlas. `threads` is for a
/// software GL renderer. Throws MachineLacks without OpenGL.
Json render_to_files(OutputSet& outputs, const std::string& name, const RenderScene& scene,
                     const RenderSettings& settings, int threads, const ProgressFunction& progress);

}  // namespace kiln
