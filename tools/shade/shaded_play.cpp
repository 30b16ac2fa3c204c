// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shaded_play.h"

#include <algorithm>

#include "base/errors.h"
#include "base/json.h"

namespace kiln {

namespace {

// Part of the farthest distance that a camera among triangles sees from.
constexpr float nearest_part = 1.f / 2000;

/// Calls `act`, and turns faults of what a scene says into those of its file; command lines have been checked.
template <class Act>
auto blaming(const ShadeScene& scene, Act act) {
  try {
    return act();
  } catch (const WrongUsage& fault) {
    throw BadInput(scene.file.string(), fault.what(), "a scene as docs/shaders.md says", "correct it");
  }
}

MovingSceneSettings moving_settings(const ShadingSettings& settings, const FilmSettings& film, int threads) {
  MovingSceneSettings moving;
  moving.shadows = shadow_settings_of(film, threads);
  moving.incident_samples = settings.incident_samples;
  moving.engine = shadow_engine_of(film);
  moving.without_direct = settings.direct == DirectLightBy::maps;
  return moving;
}

}  // namespace

ShadedPlay::ShadedPlay(const ShadeScene& scene, const ShadingSettings& settings, const FilmSettings& film, int threads)
    : scene_(scene),
      film_(film),
      has_transfer_(!scene.film.assets.empty()),
      moving_(scene.moving(moving_settings(settings, film, threads))),
      renderer_(blaming(scene, [&] { return ShadedRenderer(scene.scene, scene.shaders, settings); })) {}

void ShadedPlay::update() {
  blaming(scene_, [&] {
    renderer_.set_placements(placements_now(scene_, moving_));
    renderer_.set_lights(moving_.lights());
    if (!has_transfer_) return;
    std::vector<NodeLight> light;
    for (const int item : scene_.items) {
      light.emplace_back();
      if (moving_.item(item).asset >= 0) light.back() = moving_.light(item).samples;
    }
    renderer_.set_node_light(std::move(light));
  });
}

void ShadedPlay::draw(const Camera& camera, const ShadedFrame& frame, int frame_number, PartTimes* times) {
  blaming(scene_, [&] { renderer_.draw(camera, frame, moving_.time(), frame_number, times); });
}

Json ShadedPlay::shadow_record() const { return kiln::shadow_record(film_, moving_.shadow_engine()); }

void ShadedPlay::read_shaders_again() {
  blaming(scene_, [&] { renderer_.set_shaders(scene_.shaders_again()); });
}

void see_among(Camera& camera, const std::vector<Eigen::Vector3f>& shape) {
  const bool stands_among = std::any_of(shape.begin(), shape.end(), [&](const Eigen::Vector3f& vertex) {
    return (vertex - camera.position).dot(camera.forward) <= 0;
  });
  if (stands_among) camera.near_distance = std::min(camera.near_distance, nearest_part * camera.far_distance);
}

}  // namespace kiln
