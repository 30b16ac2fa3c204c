// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numbers>

#include "base/errors.h"
#include "base/json.h"
#include "gpu/egl_context.h"
#include "image/image_file.h"
#include "lights/light_command.h"
#include "lights/suns.h"
#include "mesh/camera_record.h"
#include "render/output/contact_sheet.h"
#include "render/output/frame_name.h"
#include "render/output/picture.h"
#include "render/render_metrics.h"
#include "render/texture_space.h"
#include "runtime/draw/scene_renderer.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Assets of a scene on the GPU, each drawn by a technique of its own.
struct Uploaded {
  std::vector<std::unique_ptr<AssetRenderer>> renderers;
  std::vector<SceneAsset> assets;

  void add(const PrtAsset& asset, const Placement& placement, Technique technique, int incident_samples,
           const ProbeSet* probes = nullptr) {
    renderers.push_back(std::make_unique<AssetRenderer>(asset, incident_samples));
    renderers.back()->prepare(technique);
    assets.push_back({renderers.back().get(), placement, technique, probes});
  }
};

/// Returns the vertices of some assets' own meshes in the scene, which cameras frame.
std::vector<Eigen::Vector3f> framed_shape(const RenderScene& scene, std::size_t first, std::size_t last) {
  std::vector<Eigen::Vector3f> shape;
  for (std::size_t k = first; k < last; ++k)
    for (const Eigen::Vector3f& vertex : scene.shapes[k])
      shape.emplace_back(scene.placements[k].to_scene(vertex.cast<double>()).cast<float>());
  return shape;
}

/// One picture of a sheet.
struct Cell {
  const PrtAsset* asset = nullptr;
  std::size_t index = 0;  ///< of the asset in the scene
  Placement placement;
  Technique technique = Technique::textured_prt;
  std::string caption;
};

/// Lists the pictures of a sheet: the asset by every technique that it, or its compressed form, can be drawn by; or
/// each asset by itself.
std::vector<Cell> cells_of(const RenderScene& scene, const RenderSettings& settings) {
  std::vector<Cell> cells;
  if (settings.technique != TechniqueChoice::all) {
    for (std::size_t k = 0; k < scene.assets.size(); ++k) {
      const PrtAsset& asset = scene.assets[k];
      const Technique technique = technique_of(settings, asset);
      require_technique(technique, asset);
      cells.push_back(
          {&asset, k, scene.placements[k], technique, scene.names[k] + ": " + technique_caption(technique, asset)});
    }
    return cells;
  }
  for (const Technique technique : all_techniques) {
    const bool other_form = technique == Technique::compressed && scene.compressed;
    const PrtAsset& asset = other_form ? *scene.compressed : scene.assets.front();
    try {
      require_technique(technique, asset);
    } catch (const WrongUsage&) {
      continue;  // a sheet shows the techniques that there are data for
    }
    cells.push_back({&asset, 0, scene.placements.front(), technique, technique_caption(technique, asset)});
  }
  return cells;
}

Json write_sheet(OutputSet& outputs, const std::string& name, const RenderScene& scene, const RenderSettings& settings,
                 const EglContext& context) {
  const int samples = incident_samples_of(settings, scene.lights.is_local());
  const PictureSettings picture = picture_of(settings);
  std::vector<SheetCell> pictures;
  Json drawn = Json::array(), metrics;
  for (const Cell& cell : cells_of(scene, settings)) {
    Uploaded uploaded;
    uploaded.add(*cell.asset, cell.placement, cell.technique, samples);
    const SceneView view = views_of(settings, framed_shape(scene, cell.index, cell.index + 1)).front();
    const Image<float> radiance = render_scene(uploaded.assets, scene.lights, view);
    const GpuMemory memory = uploaded.renderers.front()->memory(cell.technique);
    pictures.push_back({picture_from_radiance(radiance, picture),
                        {cell.caption, fmt::format("{:.2f} MB a mesh, {} bytes a vertex",
                                                   static_cast<double>(memory.per_mesh) / 1e6, memory.per_vertex)}});
    metrics = render_metrics(uploaded.assets, scene.specs, radiance, context);
    drawn.push_back(metrics["assets"][0]);
    drawn.back()["mean_radiance"] = metrics["mean_radiance"];
    drawn.back()["camera"] = to_json(view.camera);
  }
  write_png(outputs.add(name), contact_sheet(pictures));
  metrics["assets"] = drawn;
  return metrics;
}

/// Names an asset by its folder, or by the folder above prt/.
std::string name_of(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder / "x").lexically_normal().parent_path();
  return whole.filename() == "prt" ? (whole.parent_path().filename() / "prt").string() : whole.filename().string();
}

std::string text_of(const Eigen::Vector3d& place) {
  return fmt::format("{:.4g},{:.4g},{:.4g}", place.x(), place.y(), place.z());
}

/// Returns the box of a placed asset along three axes, the rows of `axes`.
Eigen::AlignedBox3d box_along(const PrtAsset& asset, const Placement& placement, const Eigen::Matrix3d& axes) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : asset.mesh.positions)
    box.extend(Eigen::Vector3d(axes * placement.to_scene(vertex.cast<double>())));
  return box;
}

/// Places assets that have no place side by side as the camera sees them: the first at its own origin, each other one
/// to the right of all before it, with a tenth of its width between, on the ground line of the first and at the same
/// distance.
void place_the_rest(RenderScene& scene, double camera_azimuth_degrees) {
  const double azimuth = camera_azimuth_degrees * std::numbers::pi / 180;
  Eigen::Matrix3d axes;  // to the right, up, towards the camera
  axes << std::cos(azimuth), 0, -std::sin(azimuth), 0, 1, 0, std::sin(azimuth), 0, std::cos(azimuth);
  const std::size_t given = scene.placements.size();
  std::string told;
  Eigen::AlignedBox3d first, all;
  for (std::size_t k = 0; k < scene.assets.size(); ++k) {
    if (k >= given) {
      Placement& placement = scene.placements.emplace_back();
      const Eigen::AlignedBox3d own = box_along(scene.assets[k], placement, axes);
      if (k > 0) {
        const Eigen::Vector3d move(all.max().x() + 0.1 * own.sizes().x() - own.min().x(),
                                   first.min().y() - own.min().y(), first.center().z() - own.center().z());
        placement.translation = axes.transpose() * move;
      }
      told += (told.empty() ? "" : "; ") + scene.names[k] + " at " + text_of(placement.translation);
    }
    const Eigen::AlignedBox3d placed = box_along(scene.assets[k], scene.placements[k], axes);
    if (k == 0) first = placed;
    all.extend(placed);
  }
  if (scene.assets.size() > 1 && !told.empty())
    scene.note = "assets without --place stand side by side on one ground line: " + told;
}

/// Loads an asset with its own mesh, or with that of a level of detail, and keeps the vertices of its own.
PrtAsset load_at_level(const fs::path& folder, int level, std::vector<Eigen::Vector3f>& shape) {
  PrtAsset asset = load_prt_asset(folder);
  shape = asset.mesh.positions;
  if (level > 0) asset.mesh = load_level(folder, asset, level);
  return asset;
}

}  // namespace

RenderScene load_render_scene(const RenderPaths& paths, const LightSettings& light_settings,
                              const RenderSettings& settings) {
  const bool all = settings.technique == TechniqueChoice::all;
  if (paths.assets.size() > 1 && (all || !paths.compressed.empty()))
    throw WrongUsage("technique all and --compressed: found several assets; expected one");
  if (is_sheet(settings) && settings.frames > 1)
    throw WrongUsage("technique all and --side-by-side: found --frames; expected one picture");
  if (paths.places.size() > paths.assets.size())
    throw WrongUsage("place: found " + std::to_string(paths.places.size()) + "; expected at most one for each asset");
  if (!paths.probes.empty() && is_sheet(settings))
    throw WrongUsage("probes: found a sheet of single assets; expected a picture of them together");
  if (!paths.probes.empty() && paths.assets.size() > 1 && !paths.places.empty() &&
      parse_placement("place", paths.places.front()).matrix() != Eigen::Matrix4d::Identity())
    throw WrongUsage("probes: found --place " + paths.places.front() +
                     " of the first asset; expected 0,0,0, where the probes are its own");
  if ((paths.each_light || paths.each_asset) && (is_sheet(settings) || settings.frames > 1))
    throw WrongUsage("each-light and each-asset: found a sheet or --frames; expected one picture");
  if (settings.space == PictureSpace::texture &&
      (paths.assets.size() > 1 || is_sheet(settings) || settings.frames > 1 || paths.each_light || paths.each_asset ||
       !paths.places.empty() || !paths.probes.empty() || settings.technique == TechniqueChoice::phong ||
       settings.technique == TechniqueChoice::normal_map || settings.technique == TechniqueChoice::vertex_prt))
    throw WrongUsage(
        "space: found texture with several pictures or assets, a place, probes, or a technique without "
        "planes; expected one asset, lit where it was baked");
  if (paths.each_asset && (!paths.places.empty() || !paths.probes.empty()))
    throw WrongUsage("each-asset: found --place or --probes; expected assets where they were baked");
  const LightSettings chosen = chosen_lights(light_settings, paths.light_file);
  const bool by_spectra = are_spectral(chosen, paths.lamps);
  const LightSettings given = with_placed_suns(chosen);
  if (by_spectra && (is_sheet(settings) || settings.space == PictureSpace::texture || paths.each_light ||
                     paths.each_asset || !paths.probes.empty() || !paths.compressed.empty()))
    throw WrongUsage(
        "lamp: found a sheet, --space texture, --each-light, --each-asset, --probes or --compressed; expected a "
        "picture "
        "of assets in a camera's view");
  if (by_spectra) require_grey(settings);
  if (paths.each_light && given.lights.empty()) throw WrongUsage("each-light: found no --light; expected at least one");

  RenderScene scene;
  scene.specs = light_specs(given);
  for (const std::string& place : paths.places) scene.placements.push_back(parse_placement("place", place));
  int bands = 0;
  for (const fs::path& folder : paths.assets) {
    scene.assets.push_back(load_at_level(folder, settings.level, scene.shapes.emplace_back()));
    scene.names.push_back(name_of(folder));
    bands = std::max(bands, scene.assets.back().bands);
  }
  scene.each_asset = paths.each_asset;
  if (is_sheet(settings) || paths.each_asset)
    scene.placements.resize(scene.assets.size());
  else
    place_the_rest(scene, camera_settings_of(settings).azimuth_degrees);
  if (!paths.compressed.empty()) {
    scene.compressed = load_other_form(paths.compressed, scene.assets.front());
    if (settings.level > 0) scene.compressed->mesh = load_level(paths.compressed, *scene.compressed, settings.level);
  }
  if (!paths.probes.empty()) scene.probes = load_probes(paths.probes);
  const int light_bands = std::max(bands, scene.probes ? scene.probes->bands : 0);
  scene.lights = scene_lights(given, light_bands);
  if (by_spectra) {
    std::vector<const PrtAsset*> assets;
    for (const PrtAsset& asset : scene.assets) assets.push_back(&asset);
    scene.lamps = SpectralAssets(assets, paths.lamps).under(chosen, paths.lamps.lamps, light_bands);
  }
  for (std::size_t k = 0; paths.each_light && k < given.lights.size(); ++k) {
    LightSettings one = given;
    one.lights = {given.lights[k]};
    scene.each_light.push_back(scene_lights(one, light_bands));
  }
  return scene;
}

namespace {

/// Pictures of a scene's assets together, or of one of them.
class PictureSeries {
 public:
  PictureSeries(OutputSet& outputs, const std::string& name, const RenderScene& scene, const RenderSettings& settings,
                const ProgressFunction& progress)
      : outputs_(outputs), name_(name), scene_(scene), settings_(settings), progress_(progress) {}

  /// Draws assets `first` to `last` - 1 under all lights or each; returns the metrics of the first picture.
  Json draw(std::size_t first, std::size_t last, const EglContext& context) {
    Uploaded uploaded;
    for (std::size_t k = first; k < last; ++k) {
      const bool probed = scene_.probes && (k > 0 || scene_.assets.size() == 1);
      const int samples = incident_samples_of(settings_, probed || scene_.lights.is_local());
      const bool other_form = settings_.technique == TechniqueChoice::compressed && scene_.compressed;
      const PrtAsset& asset = other_form     ? *scene_.compressed
                              : scene_.lamps ? *scene_.lamps->assets[k]
                                             : scene_.assets[k];
      uploaded.add(asset, scene_.placements[k], technique_of(settings_, asset), samples,
                   probed ? &*scene_.probes : nullptr);
      if (scene_.lamps) uploaded.renderers.back()->set_colors(scene_.lamps->colors[k]);
    }
    const PictureSettings picture = picture_of(settings_);
    const std::vector<SceneView> views = views_of(settings_, framed_shape(scene_, first, last));
    const std::size_t pictures = std::max(views.size(), scene_.each_light.size());
    const std::size_t all = pictures * (scene_.each_asset ? scene_.assets.size() : 1);
    const bool is_numbered = views.size() > 1 || scene_.each_asset || !scene_.each_light.empty();
    Json metrics;
    for (std::size_t k = 0; k < pictures; ++k, ++drawn_) {
      const SceneView& view = views[std::min(k, views.size() - 1)];
      const SceneLights& lights = scene_.lamps                ? scene_.lamps->lights
                                  : scene_.each_light.empty() ? scene_.lights
                                                              : scene_.each_light[k];
      const Image<float> radiance = render_scene(uploaded.assets, lights, view);
      write_picture(outputs_.add(is_numbered ? frame_name(name_, drawn_) : name_), radiance, picture);
      if (k == 0) {
        metrics = render_metrics(uploaded.assets, scene_.specs, radiance, context);
        metrics["camera"] = to_json(view.camera);
        metrics["frames"] = views.size();
        if (scene_.lamps) metrics["lamps"] = scene_.lamps->names;
      }
      progress_(static_cast<double>(drawn_ + 1) / static_cast<double>(all));
    }
    return metrics;
  }

 private:
  OutputSet& outputs_;
  const std::string& name_;
  const RenderScene& scene_;
  const RenderSettings& settings_;
  const ProgressFunction& progress_;
  int drawn_ = 0;  ///< number of pictures
};

/// Renders the relit atlas of the only asset.
Json render_texture(OutputSet& outputs, const std::string& name, const RenderScene& scene,
                    const RenderSettings& settings) {
  const bool other_form = settings.technique == TechniqueChoice::compressed && scene.compressed;
  const PrtAsset& asset = other_form ? *scene.compressed : scene.assets.front();
  const Image<float> radiance = relit_atlas(asset, scene.lights, look_of(settings));
  write_picture(outputs.add(name), radiance, picture_of(settings));
  return texture_metrics(asset, scene.specs);
}

}  // namespace

Json render_to_files(OutputSet& outputs, const std::string& name, const RenderScene& scene,
                     const RenderSettings& settings, int threads, const ProgressFunction& progress) {
  if (settings.space == PictureSpace::texture) return render_texture(outputs, name, scene, settings);
  const EglContext context(settings.gl_device, threads);
  if (is_sheet(settings)) return write_sheet(outputs, name, scene, settings, context);
  PictureSeries series(outputs, name, scene, settings, progress);
  const std::size_t count = scene.assets.size();
  Json metrics = series.draw(0, scene.each_asset ? 1 : count, context);
  for (std::size_t k = 1; scene.each_asset && k < count; ++k)
    metrics["assets"].push_back(series.draw(k, k + 1, context).at("assets").at(0));
  return metrics;
}

}  // namespace kiln
