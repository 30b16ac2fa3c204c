// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/film/film.h"

#include <algorithm>
#include <map>
#include <variant>

#include "base/errors.h"
#include "base/json.h"
#include "gpu/egl_context.h"
#include "mesh/camera_record.h"
#include "render/output/frame_name.h"
#include "render/output/picture.h"
#include "render/render_metrics.h"
#include "runtime/scene_file/scene_file.h"
#include "runtime/shadow_gl/visibility_maps.h"

namespace kiln {

namespace {

constexpr int looks_at_film = 49;  // times at which the camera makes sure that all is in the picture

/// Adds the corners of the boxes of all nodes as they are now; `boxes` are those of their meshes.
void add_boxes(MovingScene& scene, const std::map<const TriangleMesh*, BoundingBox>& boxes,
               std::vector<Eigen::Vector3f>& shape) {
  for (int item = 0; item < scene.item_count(); ++item) {
    if (scene.mesh_of(item) == nullptr) continue;
    const BoundingBox& box = boxes.at(scene.mesh_of(item));
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d at((corner & 1) != 0 ? box.highest[0] : box.lowest[0],
                               (corner & 2) != 0 ? box.highest[1] : box.lowest[1],
                               (corner & 4) != 0 ? box.highest[2] : box.lowest[2]);
      shape.push_back(scene.pose(item).to_scene(at).cast<float>());
    }
  }
}

/// Copies a frame into a strip of them, which is wide enough.
void put_beside(Image<float>& strip, const Image<float>& frame, int place) {
  for (int j = 0; j < frame.height(); ++j)
    for (int i = 0; i < frame.width(); ++i)
      for (int channel = 0; channel < frame.channels(); ++channel)
        strip.at(place * frame.width() + i, j, channel) = frame.at(i, j, channel);
}

void add_lines(const SceneTree& tree, int node, const std::string& indent, std::string& text) {
  const SceneNode& here = tree.nodes[static_cast<std::size_t>(node)];
  text += indent + here.name + (here.is_static ? " (static)" : "") + "\n";
  for (const int child : here.children) add_lines(tree, child, indent + "  ", text);
}

Json record_of(const SceneTree& tree, int node) {
  const SceneNode& here = tree.nodes[static_cast<std::size_t>(node)];
  Json record = {{"name", here.name}};
  if (here.asset >= 0) record["static"] = here.is_static;
  if (here.asset >= 0) return record;
  record["nodes"] = Json::array();
  for (const int child : here.children) record["nodes"].push_back(record_of(tree, child));
  return record;
}

}  // namespace

std::vector<const PrtAsset*> Film::asset_pointers() const {
  std::vector<const PrtAsset*> pointers;
  if (lamps)
    for (const std::shared_ptr<const PrtAsset>& asset : lamps->assets) pointers.push_back(asset.get());
  else
    for (const PrtAsset& asset : assets) pointers.push_back(&asset);
  return pointers;
}

MovingScene moving_scene(const Film& film, const MovingSceneSettings& settings) {
  MovingScene scene(film.description, film.asset_pointers(), settings);
  if (film.lamps) scene.set_light_vectors(film.lamps->lights.vectors);
  return scene;
}

Film load_film(const std::filesystem::path& file, int level) {
  Film film{.description = load_scene(file), .assets = {}};
  require_transfer(film.description);
  for (const std::filesystem::path& folder : film.description.assets) {
    film.assets.push_back(load_prt_asset(folder));
    if (level > 0) film.assets.back().mesh = load_level(folder, film.assets.back(), level);
  }
  return film;
}

std::string note_of_shaders(const SceneDescription& scene) {
  const auto is_told = [](const SceneItem& item) {
    const SceneSurface& surface = item.surface;
    return !surface.shader.empty() || !surface.casts_shadow || surface.is_mirror;
  };
  const auto first = std::find_if(scene.items.begin(), scene.items.end(), is_told);
  if (first == scene.items.end()) return "";
  return first->where +
         ": shaders, 'casts-shadow' and 'mirror' are for kiln-shade and kiln-view; drawn by transfer and albedo";
}

FilmAssets::FilmAssets(MovingScene& scene, const Film& film, const RenderSettings& settings, int incident_samples)
    : scene_(scene), renderers_(scene.description().assets.size()), techniques_(renderers_.size()) {
  for (int item = 0; item < scene.item_count(); ++item) {
    if (scene.item(item).asset < 0) continue;
    const auto k = static_cast<std::size_t>(scene.item(item).asset);
    if (renderers_[k]) continue;
    techniques_[k] = technique_of(settings, scene.asset_of(item));
    renderers_[k] = std::make_unique<AssetRenderer>(scene.asset_of(item), incident_samples);
    if (film.lamps) renderers_[k]->set_colors(film.lamps->colors[k]);
    renderers_[k]->prepare(techniques_[k]);
  }
}

std::vector<SceneAsset> FilmAssets::now(const SurfaceLook& look) {
  std::vector<SceneAsset> assets;
  for (int item = 0; item < scene_.item_count(); ++item) {
    if (scene_.item(item).asset < 0) continue;
    const auto k = static_cast<std::size_t>(scene_.item(item).asset);
    SceneAsset& asset = assets.emplace_back();
    asset.renderer = renderers_[k].get();
    asset.placement = scene_.pose(item);
    asset.technique = techniques_[k];
    asset.light = asset.renderer->upload_asset_light(scene_.light(item), look);
  }
  return assets;
}

std::shared_ptr<VisibilityEngine> shadow_engine_of(const FilmSettings& film) {
  if (film.shadow_backend == ShadowBackend::rays) return nullptr;
  VisibilityMapSettings settings;
  settings.texels = film.shadow_texels;
  return std::make_shared<VisibilityMaps>(settings);
}

Json shadow_record(const FilmSettings& film, const VisibilityEngine* engine) {
  Json record = {{"method", shadow_method_names[static_cast<std::size_t>(film.shadows)]}};
  if (film.shadows != ShadowMethod::combined) return record;
  record["backend"] = shadow_backend_names[static_cast<std::size_t>(film.shadow_backend)];
  record["directions"] = film.shadow_directions;
  if (engine == nullptr) return record;
  record["renderer"] = engine->renderer();
  record["texels"] = film.shadow_texels;
  return record;
}

std::vector<Eigen::Vector3f> shape_now(MovingScene& scene) {
  std::vector<Eigen::Vector3f> shape;
  for (int item = 0; item < scene.item_count(); ++item)
    if (const TriangleMesh* mesh = scene.mesh_of(item))
      for (const Eigen::Vector3f& vertex : mesh->positions)
        shape.emplace_back(scene.pose(item).to_scene(vertex.cast<double>()).cast<float>());
  return shape;
}

CameraSettings film_camera(MovingScene& scene, const RenderSettings& settings) {
  CameraSettings camera = camera_settings_of(settings);
  if (camera.target && camera.distance > 0) return camera;
  const double now = scene.time(), duration = duration_of(scene.description());
  std::map<const TriangleMesh*, BoundingBox> boxes;
  for (int item = 0; item < scene.item_count(); ++item)
    if (const TriangleMesh* mesh = scene.mesh_of(item))
      if (!boxes.contains(mesh)) boxes[mesh] = bounding_box(*mesh);
  std::vector<Eigen::Vector3f> shape;
  for (int k = 0; k < (duration > 0 ? looks_at_film : 1); ++k) {
    if (duration > 0) scene.set_time(duration * k / (looks_at_film - 1));
    add_boxes(scene, boxes, shape);
  }
  scene.set_time(now);
  // As far away as the farthest of the ways from which it looks.
  const bool moves = !std::holds_alternative<std::monostate>(scene.description().cameras.front().motion);
  double distance = 0;
  for (int k = 0; k < (moves ? looks_at_film : 1); ++k) {
    CameraSettings look =
        moves ? camera_settings_at(camera, scene.description(), duration * k / (looks_at_film - 1)) : camera;
    const Camera fitted = make_camera(shape, look, settings.width, settings.height);
    if (!look.target) look.target = camera.target = fitted.target;
    distance = std::max(distance, (fitted.position.cast<double>() - *look.target).norm());
  }
  if (!(camera.distance > 0)) camera.distance = distance;
  return camera;
}

void frames_to_files(OutputSet& outputs, const std::string& name, const std::vector<double>& times, bool is_strip,
                     const PictureSettings& picture, const std::function<Image<float>(double)>& draw_at,
                     const ProgressFunction& progress) {
  const auto count = static_cast<int>(times.size());
  Image<float> strip;
  for (int k = 0; k < count; ++k) {
    const Image<float> frame = draw_at(times[static_cast<std::size_t>(k)]);
    if (is_strip) {
      if (k == 0) strip = Image<float>(frame.width() * count, frame.height(), frame.channels());
      put_beside(strip, frame, k);
    } else {
      write_picture(outputs.add(count > 1 ? frame_name(name, k) : name), frame, picture);
    }
    progress(static_cast<double>(k + 1) / count);
  }
  if (is_strip) write_picture(outputs.add(name), strip, picture);
}

Json film_to_files(OutputSet& outputs, const std::string& name, const Film& film, const RenderSettings& settings,
                   const FilmSettings& film_settings, int threads, const ProgressFunction& progress) {
  const std::vector<double> times = film_times(film_settings, settings.frames, film.description);
  const int samples = film_samples_of(settings, film_settings, film.description);
  const EglContext context(settings.gl_device, threads);
  const std::shared_ptr<VisibilityEngine> engine = shadow_engine_of(film_settings);
  MovingScene scene = moving_scene(film, {shadow_settings_of(film_settings, threads), samples, engine});
  scene.set_time(times.front());
  FilmAssets assets(scene, film, settings, samples);
  const CameraSettings camera = film_camera(scene, settings);
  SceneView view;
  view.width = settings.width;
  view.height = settings.height;
  view.supersample = settings.supersample;
  view.look = look_of(settings);
  view.shading = settings.shading;
  Json metrics;
  const auto draw_at = [&](double time) {
    scene.set_time(time);
    view.camera = make_camera(shape_now(scene), camera_settings_at(camera, film.description, time), settings.width,
                              settings.height);
    const std::vector<SceneAsset> drawn = assets.now(view.look);
    Image<float> radiance = render_scene(drawn, scene.lights(), view);
    if (metrics.is_null()) {
      metrics = render_metrics(drawn, scene.lights().specs, radiance, context);
      metrics["camera"] = to_json(view.camera);
      metrics["frames"] = times.size();
      metrics["times"] = times;
      metrics["tree"] = tree_record(scene.tree());
      metrics["shadows"] = shadow_record(film_settings, engine.get());
      if (film.lamps) metrics["lamps"] = film.lamps->names;
    }
    return radiance;
  };
  frames_to_files(outputs, name, times, film_settings.strip, picture_of(settings), draw_at, progress);
  metrics["tree_changes"] = scene.tree_changes();
  return metrics;
}

SceneTree film_tree(const Film& film, double time) {
  MovingScene scene(film.description, film.asset_pointers(), {{}, 1, nullptr});
  scene.set_time(time);
  return scene.tree();
}

Json tree_record(const SceneTree& tree) { return record_of(tree, 0); }

std::string tree_text(const SceneTree& tree) {
  std::string text;
  add_lines(tree, 0, "", text);
  return text;
}

}  // namespace kiln
