// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/film/film_settings.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>
#include <utility>
#include <variant>

#include "base/errors.h"

namespace kiln {

OptionSet film_options(FilmSettings& settings) {
  OptionSet options;
  std::vector<std::pair<std::string, ShadowMethod>> methods;
  for (const std::string_view name : shadow_method_names)
    methods.emplace_back(name, static_cast<ShadowMethod>(methods.size()));
  std::vector<std::pair<std::string, ShadowBackend>> backends;
  for (const std::string_view name : shadow_backend_names)
    backends.emplace_back(name, static_cast<ShadowBackend>(backends.size()));
  options.number("time", settings.time, 0, 1e6, "Of the picture, or of the first of several, seconds")
      .number_or_auto("fps", settings.frames_per_second, 1e-3, 1000,
                      "Pictures per second of --frames; auto: they span the scene from --time to its end")
      .toggle("strip", settings.strip, "The frames side by side in one picture, in place of one picture each")
      .choice("shadows", settings.shadows, methods, "How the nodes' shadows on each other are computed")
      .integer("shadow-directions", settings.shadow_directions, 16, 1000000,
               "In which a point at which light is computed looks for what shadows it")
      .choice("shadow-backend", settings.shadow_backend, backends,
              "How it finds what is there: rays on the CPU, or small maps that the GL device draws at the point")
      .integer("shadow-texels", settings.shadow_texels, 8, 1024, "Side of these maps, texels");
  return options;
}

bool is_scene_file(const std::filesystem::path& input) {
  return input.extension() == ".yaml" || input.extension() == ".yml";
}

std::vector<double> film_times(const FilmSettings& film, int frames, const SceneDescription& scene) {
  std::vector<double> times = {film.time};
  if (frames == 1) return times;
  const double end = duration_of(scene);
  if (!film.frames_per_second && !(end > film.time))
    throw WrongUsage(
        fmt::format("frames: found a scene that ends after {} s, and --time {}; expected a later end "
                    "('duration' of the scene), or --fps",
                    end, film.time));
  const double step = film.frames_per_second ? 1 / *film.frames_per_second : (end - film.time) / (frames - 1);
  for (int k = 1; k < frames; ++k) times.push_back(film.time + k * step);
  return times;
}

void use_scene_look(RenderSettings& settings, SceneDescription& scene,
                    const std::function<bool(const std::string&)>& is_given) {
  bool has_angles = is_given("camera");
  if (const int named = find_camera(scene, has_angles ? settings.camera : ""); named >= 0) {
    std::swap(scene.cameras.front(), scene.cameras[static_cast<std::size_t>(named)]);
    const RenderSettings fresh;
    if (has_angles) settings.camera = fresh.camera;
    has_angles = false;
  } else if (settings.camera.find(',') == std::string::npos) {
    std::vector<std::string> names;
    for (const SceneCamera& camera : scene.cameras)
      if (!camera.name.empty()) names.push_back(camera.name);
    if (!names.empty())
      throw WrongUsage(fmt::format("camera: found '{}'; expected AZIMUTH,ELEVATION, or one of the scene's cameras: {}",
                                   settings.camera, fmt::join(names, ", ")));
  }
  // What the command line says, the camera does not, at any time.
  SceneCamera& camera = scene.cameras.front();
  const auto leave_out = [&](CameraPlace& place) {
    if (has_angles) place.azimuth_degrees.reset(), place.elevation_degrees.reset();
    if (is_given("field-of-view")) place.field_of_view_degrees.reset();
    if (is_given("zoom")) place.zoom.reset();
    if (is_given("target")) place.target.reset();
    if (is_given("distance")) place.distance.reset();
  };
  leave_out(camera);
  if (auto* keyframes = std::get_if<CameraKeyframes>(&camera.motion))
    for (CameraKeyframe& frame : keyframes->frames) leave_out(frame.place);
  if (has_angles && std::holds_alternative<CameraOrbit>(camera.motion)) camera.motion = std::monostate();
  if (!camera.azimuth_degrees && std::holds_alternative<CameraOrbit>(camera.motion))
    camera.azimuth_degrees = camera_settings_of(settings).azimuth_degrees;

  // The settings say where it begins.
  const CameraSettings own = camera_settings_of(settings);
  if (!has_angles)
    settings.camera = fmt::format("{},{}", camera.azimuth_degrees.value_or(own.azimuth_degrees),
                                  camera.elevation_degrees.value_or(own.elevation_degrees));
  settings.field_of_view_degrees = camera.field_of_view_degrees.value_or(settings.field_of_view_degrees);
  settings.framing.zoom = camera.zoom.value_or(settings.framing.zoom);
  if (camera.target)
    settings.framing.target = fmt::format("{},{},{}", camera.target->x(), camera.target->y(), camera.target->z());
  if (camera.distance) settings.framing.distance = fmt::format("{}", *camera.distance);
  if (!is_given("background") && scene.background)
    settings.background = fmt::format("{}", fmt::join(*scene.background, ","));
}

void check_shadow_backend(const FilmSettings& film) {
  if (film.shadow_backend != ShadowBackend::rays && film.shadows != ShadowMethod::combined)
    throw WrongUsage(fmt::format("shadow-backend: found gpu with --shadows {}; expected combined, or backend rays",
                                 shadow_method_names[static_cast<std::size_t>(film.shadows)]));
}

CameraSettings camera_settings_at(const CameraSettings& settings, const SceneDescription& scene, double time) {
  const CameraPlace place = camera_at(scene.cameras.front(), time);
  CameraSettings now = settings;
  now.azimuth_degrees = place.azimuth_degrees.value_or(now.azimuth_degrees);
  now.elevation_degrees = place.elevation_degrees.value_or(now.elevation_degrees);
  now.field_of_view_degrees = place.field_of_view_degrees.value_or(now.field_of_view_degrees);
  now.zoom = place.zoom.value_or(now.zoom);
  now.distance = place.distance.value_or(now.distance);
  if (place.target) now.target = place.target;
  return now;
}

ShadowSettings shadow_settings_of(const FilmSettings& film, int threads) {
  ShadowSettings settings;
  settings.method = film.shadows;
  settings.directions = film.shadow_directions;
  settings.threads = threads;
  return settings;
}

int film_samples_of(const RenderSettings& settings, const FilmSettings& film, const SceneDescription& scene) {
  const bool is_local = std::any_of(scene.lights.begin(), scene.lights.end(),
                                    [](const SceneLight& light) { return light.spec.kind == LightSpec::Kind::sphere; });
  return incident_samples_of(settings, is_local || film.shadows != ShadowMethod::none);
}

}  // namespace kiln
