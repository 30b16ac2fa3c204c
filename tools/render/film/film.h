// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/json_fwd.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "image/image.h"
#include "render/film/film_settings.h"
#include "render/lamps.h"
#include "runtime/draw/scene_renderer.h"
#include "runtime/play/moving_scene.h"

namespace kiln {

/// A scene and its assets in memory.
struct Film {
  SceneDescription description;
  std::vector<PrtAsset> assets;
  std::optional<LampScene> lamps = {};  ///< light and surfaces by spectra (light_by_lamps), of `assets`; nothing: RGB

  /// Returns the assets to draw: those of the lamps, if there are any.
  std::vector<const PrtAsset*> asset_pointers() const;
};

/// Returns a film's nodes and lights as they move. `film` must live on. Throws as MovingScene does.
MovingScene moving_scene(const Film& film, const MovingSceneSettings& settings);

/// Reads a scene and its assets, with the mesh of a level of detail. Throws BadInput, also for nodes without transfer.
Film load_film(const std::filesystem::path& file, int level);

/// Says which words of a scene a picture by transfer does not heed, since they are about shaders of one's own; empty
/// where there are none.
std::string note_of_shaders(const SceneDescription& scene);

/// Assets of a scene on the GPU: each once, however many nodes have it. Needs the GL context in which it was made.
class FilmAssets {
 public:
  /// Uploads the assets, each by its technique. `scene` is the film's, and must live on. Throws as AssetRenderer does.
  FilmAssets(MovingScene& scene, const Film& film, const RenderSettings& settings, int incident_samples);

  /// Returns the scene as it is now, lit, to be drawn.
  std::vector<SceneAsset> now(const SurfaceLook& look);

 private:
  MovingScene& scene_;
  std::vector<std::unique_ptr<AssetRenderer>> renderers_;  ///< by asset
  std::vector<Technique> techniques_;
};

/// Makes what finds shadows by the GPU, in the GL context that is current; null where the settings ask for rays. Throws
/// as VisibilityMaps does.
std::shared_ptr<VisibilityEngine> shadow_engine_of(const FilmSettings& film);

/// Describes how shadows are computed: the method and, of `combined`, the backend, with the renderer of a GPU.
Json shadow_record(const FilmSettings& film, const VisibilityEngine* engine);

/// Returns the vertices of all nodes as they are now.
std::vector<Eigen::Vector3f> shape_now(MovingScene& scene);

/// Returns a camera of one target and one distance, from which all of the scene is seen at all times: those of the
/// settings or, where they leave them open, such that the nodes' boxes fit. Leaves the scene's time as it is.
CameraSettings film_camera(MovingScene& scene, const RenderSettings& settings);

/// Draws a picture at each time and writes them into files of `outputs`: NAME of one, NAME_000 and so on of several, or
/// side by side in one.
void frames_to_files(OutputSet& outputs, const std::string& name, const std::vector<double>& times, bool is_strip,
                     const PictureSettings& picture, const std::function<Image<float>(double)>& draw_at,
                     const ProgressFunction& progress);

/// Draws pictures of a scene, at each of `times`, into files of `outputs`. Returns the metrics of the first, and the
/// times.
Json film_to_files(OutputSet& outputs, const std::string& name, const Film& film, const RenderSettings& settings,
                   const FilmSettings& film_settings, int threads, const ProgressFunction& progress);

/// Returns the tree that a film's shadows go by at a time.
SceneTree film_tree(const Film& film, double time);

/// Describes a tree: nodes with their names, their children, and what they are.
Json tree_record(const SceneTree& tree);

/// Writes the tree as lines, two blanks for each step down.
std::string tree_text(const SceneTree& tree);

}  // namespace kiln
