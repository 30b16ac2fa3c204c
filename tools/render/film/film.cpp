// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/film/film.h"

#include <algorithm>

#include "base/errors.h"
#include "base/json.h"
#include "gpu/egl_context.h"
#include "mesh/camera_record.h"
#include "render/output/frame_name.h"
#include "render/output/picture.h"
#include "render/render_metrics.h"
#include "runtime/scene_file/scene_file.h"

namespace kiln {

namespace {

constexpr int looks_at_film = 49;  // times at which the camera makes sure that all is in the picture

/// Adds the corners of the boxes of all nodes as they are now.
void add_boxes(MovingScene& scene, const std::vector<BoundingBox>& boxes, std::vector<Eigen::Vector3f>& shape) {
  for (int item = 0; item < scene.item_count(); ++item) {
    if (scene.item(item).asset < 0) continue;
    const BoundingBox& box = boxes[static_cast<std::size_t>(scene.item(item).asset)];
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
  for (const PrtAsset& asset : assets) pointers.push_back(&asset);
  return pointers;
}

Film load_film(const std::filesystem::path& file, int level) {
  Film film{load_scene(file), {}};
  for (const std::filesystem::path& folder : film.description.assets) {
    film.assets.push_back(load_prt_asset(folder));
    if (level > 0) film.assets.back().mesh = load_level(folder, film.assets.back(), level);
  }
  return film;
}

FilmAssets::FilmAssets(MovingScene& scene, const RenderSettings& settings, int incident_samples)
    : scene_(scene), renderers_(scene.description().assets.size()), techniques_(renderers_.size()) {
  for (int item = 0; item < scene.item_count(); ++item) {
    if (scene.item(item).asset < 0) continue;
    const auto k = static_cast<std::size_t>(scene.item(item).asset);
    if (renderers_[k]) continue;
    techniques_[k] = technique_of(settings, scene.asset_of(item));
    renderers_[k] = std::make_unique<AssetRenderer>(scene.asset_of(item), incident_samples);
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

std::vector<Eigen::Vector3f> shape_now(MovingScene& scene) {
  std::vector<Eigen::Vector3f> shape;
  for (int item = 0; item < scene.item_count(); ++item)
    if (scene.item(item).asset >= 0)
      for (const Eigen::Vector3f& vertex : scene.asset_of(item).mesh.positions)
        shape.emplace_back(scene.pose(item).to_scene(vertex.cast<double>()).cast<float>());
  return shape;
}

CameraSettings film_camera(MovingScene& scene, const RenderSettings& settings) {
  CameraSettings camera = camera_settings_of(settings);
  if (camera.target && camera.distance > 0) return camera;
  const double now = scene.time(), duration = duration_of(scene.description());
  std::vector<BoundingBox> boxes(scene.description().assets.size());
  for (int item = 0; item < scene.item_count(); ++item)
    if (scene.item(item).asset >= 0)
      boxes[static_cast<std::size_t>(scene.item(item).asset)] = bounding_box(scene.asset_of(item).mesh);
  std::vector<Eigen::Vector3f> shape;
  for (int k = 0; k < (duration > 0 ? looks_at_film : 1); ++k) {
    if (duration > 0) scene.set_time(duration * k / (looks_at_film - 1));
    add_boxes(scene, boxes, shape);
  }
  scene.set_time(now);
  const Camera fitted = make_camera(shape, camera, settings.width, settings.height);
  if (!camera.target) camera.target = fitted.target;
  camera.distance = (fitted.position.cast<double>() - *camera.target).norm();
  return camera;
}

Json film_to_files(OutputSet& outputs, const std::string& name, const Film& film, const RenderSettings& settings,
                   const FilmSettings& film_settings, int threads, const ProgressFunction& progress) {
  const std::vector<double> times = film_times(film_settings, settings.frames, film.description);
  const int samples = film_samples_of(settings, film_settings, film.description);
  const EglContext context(settings.gl_device, threads);
  MovingScene scene(film.description, film.asset_pointers(), {shadow_settings_of(film_settings, threads), samples});
  scene.set_time(times.front());
  FilmAssets assets(scene, settings, samples);
  const CameraSettings camera = film_camera(scene, settings);
  const PictureSettings picture = picture_of(settings);
  SceneView view;
  view.width = settings.width;
  view.height = settings.height;
  view.supersample = settings.supersample;
  view.look = look_of(settings);
  view.shading = settings.shading;
  Image<float> strip;
  if (film_settings.strip) strip = Image<float>(settings.width * static_cast<int>(times.size()), settings.height, 4);
  Json metrics;
  for (std::size_t k = 0; k < times.size(); ++k) {
    scene.set_time(times[k]);
    view.camera = make_camera(shape_now(scene), camera, settings.width, settings.height);
    const std::vector<SceneAsset> drawn = assets.now(view.look);
    const Image<float> radiance = render_scene(drawn, scene.lights(), view);
    if (film_settings.strip)
      put_beside(strip, radiance, static_cast<int>(k));
    else
      write_picture(outputs.add(times.size() > 1 ? frame_name(name, static_cast<int>(k)) : name), radiance, picture);
    if (k == 0) {
      metrics = render_metrics(drawn, scene.lights().specs, radiance, context);
      metrics["camera"] = to_json(view.camera);
      metrics["frames"] = times.size();
      metrics["times"] = times;
      metrics["tree"] = tree_record(scene.tree());
    }
    progress(static_cast<double>(k + 1) / static_cast<double>(times.size()));
  }
  if (film_settings.strip) write_picture(outputs.add(name), strip, picture);
  metrics["tree_changes"] = scene.tree_changes();
  return metrics;
}

SceneTree film_tree(const Film& film, double time) {
  MovingScene scene(film.description, film.asset_pointers(), {{}, 1});
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
