// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include <algorithm>

#include "base/json.h"
#include "gpu/egl_context.h"
#include "runtime/shading/shaded_renderer.h"

namespace kiln {

namespace {

// Part of the farthest distance that a camera among triangles sees from.
constexpr float nearest_part = 1.f / 2000;

}  // namespace

Camera shade_camera(const ShadeScene& scene, const ShadeSettings& settings) {
  const std::vector<Eigen::Vector3f> shape = placed_shape(scene.scene);
  Camera camera = views_of(settings.picture, shape).front().camera;
  // Triangles that reach behind the camera are nearer than the nearest vertex before it.
  const bool stands_among = std::any_of(shape.begin(), shape.end(), [&](const Eigen::Vector3f& vertex) {
    return (vertex - camera.position).dot(camera.forward) <= 0;
  });
  if (stands_among) camera.near_distance = std::min(camera.near_distance, nearest_part * camera.far_distance);
  return camera;
}

Image<float> draw_shade_scene(const ShadeScene& scene, const ShadeSettings& settings, int threads, Json& metrics) {
  const EglContext context(settings.picture.gl_device, threads);
  ShadedRenderer renderer(scene.scene, scene.shaders, settings.shading);
  const Camera camera = shade_camera(scene, settings);
  const int width = settings.picture.width, height = settings.picture.height;
  Image<float> radiance = shaded_picture(renderer, camera, width, height, settings.time_seconds);
  // Times of a second frame: the first compiles shaders.
  PartTimes times(context.is_software());
  const ShadedFrame frame = renderer.make_frame(width, height);
  renderer.draw(camera, frame, settings.time_seconds, 1, &times);
  Json milliseconds = Json::object();
  for (const auto& [part, time] : times.take()) milliseconds[part] = time;
  double coverage = 0;
  for (std::size_t k = 3; k < radiance.values().size(); k += 4) coverage += static_cast<double>(radiance.values()[k]);
  std::size_t triangles = 0;
  for (const ShadedNode& node : scene.scene.nodes)
    triangles += scene.scene.meshes[static_cast<std::size_t>(node.mesh)].mesh->triangles.size();
  metrics = {{"renderer", context.renderer()},
             {"width", width},
             {"height", height},
             {"samples", settings.shading.samples},
             {"shaders", renderer.programs().glsl().count()},
             {"triangles", triangles},
             {"coverage", coverage / (static_cast<double>(width) * height)},
             {"appearance_bytes", frame.appearance_bytes()},
             {"depth_bytes", ShadedFrame::depth_bytes},
             {"milliseconds", milliseconds}};
  return radiance;
}

}  // namespace kiln
