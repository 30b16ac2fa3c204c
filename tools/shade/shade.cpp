// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include <algorithm>

#include "base/errors.h"
#include "base/json.h"
#include "gpu/egl_context.h"
#include "mesh/camera_record.h"
#include "runtime/shading/shaded_renderer.h"

namespace kiln {

namespace {

// Part of the farthest distance that a camera among triangles sees from.
constexpr float nearest_part = 1.f / 2000;

/// Tells how a picture was made, and draws it again for the times: the first frame compiles shaders.
Json shade_metrics(ShadedRenderer& renderer, const Camera& camera, const Image<float>& radiance, double time,
                   const EglContext& context) {
  PartTimes times(context.is_software());
  const ShadedFrame frame = renderer.make_frame(radiance.width(), radiance.height());
  renderer.draw(camera, frame, time, 1, &times);
  Json milliseconds = Json::object();
  for (const auto& [part, spent] : times.take()) milliseconds[part] = spent;
  double coverage = 0;
  for (std::size_t k = 3; k < radiance.values().size(); k += 4) coverage += static_cast<double>(radiance.values()[k]);
  const ShadedScene& scene = renderer.scene();
  std::size_t triangles = 0;
  for (const ShadedNode& node : scene.nodes)
    triangles += scene.meshes[static_cast<std::size_t>(node.mesh)].mesh->triangles.size();
  return {{"renderer", context.renderer()},
          {"width", radiance.width()},
          {"height", radiance.height()},
          {"samples", renderer.settings().samples},
          {"shaders", renderer.programs().glsl().count()},
          {"triangles", triangles},
          {"coverage", coverage / (static_cast<double>(radiance.width()) * radiance.height())},
          {"camera", to_json(camera)},
          {"appearance_bytes", frame.appearance_bytes()},
          {"depth_bytes", ShadedFrame::depth_bytes},
          {"milliseconds", milliseconds}};
}

}  // namespace

Camera shade_camera(MovingScene& scene, const CameraSettings& settings, int width, int height) {
  const std::vector<Eigen::Vector3f> shape = shape_now(scene);
  Camera camera = make_camera(shape, settings, width, height);
  // Triangles that reach behind the camera are nearer than the nearest vertex before it.
  const bool stands_among = std::any_of(shape.begin(), shape.end(), [&](const Eigen::Vector3f& vertex) {
    return (vertex - camera.position).dot(camera.forward) <= 0;
  });
  if (stands_among) camera.near_distance = std::min(camera.near_distance, nearest_part * camera.far_distance);
  return camera;
}

Json shade_to_files(OutputSet& outputs, const std::string& name, const ShadeScene& scene, const ShadeSettings& settings,
                    int threads, const ProgressFunction& progress) {
  const RenderSettings& picture = settings.picture;
  const PictureSettings picture_settings = picture_of(picture);
  const std::vector<double> times = film_times(settings.film, picture.frames, scene.film.description);
  const EglContext context(picture.gl_device, threads);
  MovingScene moving = scene.moving();
  const CameraSettings camera_settings = film_camera(moving, picture);
  Json metrics;
  try {
    ShadedRenderer renderer(scene.scene, scene.shaders, settings.shading);
    const auto draw_at = [&](double time) {
      moving.set_time(time);
      renderer.set_placements(placements_now(scene, moving));
      renderer.set_lights(moving.lights());
      const Camera camera = shade_camera(moving, camera_settings_at(camera_settings, scene.film.description, time),
                                         picture.width, picture.height);
      Image<float> radiance = shaded_picture(renderer, camera, picture.width, picture.height, time);
      if (metrics.is_null()) metrics = shade_metrics(renderer, camera, radiance, time, context);
      return radiance;
    };
    frames_to_files(outputs, name, times, settings.film.strip, picture_settings, draw_at, progress);
  } catch (const WrongUsage& fault) {  // of what the scene says, as the command line has been checked
    throw BadInput(scene.file.string(), fault.what(), "a scene as docs/shaders.md says", "correct it");
  }
  metrics["frames"] = times.size();
  metrics["times"] = times;
  return metrics;
}

}  // namespace kiln
