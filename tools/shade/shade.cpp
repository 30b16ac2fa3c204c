// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include "base/json.h"
#include "gpu/egl_context.h"
#include "mesh/camera_record.h"
#include "shade/shaded_play.h"

namespace kiln {

namespace {

/// Tells how a picture was made, and draws it again for the times: the first frame compiles shaders.
Json shade_metrics(ShadedPlay& play, const Camera& camera, const ShadedFrame& frame, const Image<float>& radiance,
                   const EglContext& context) {
  PartTimes times(context.is_software());
  play.update();
  play.draw(camera, frame, 1, &times);
  Json milliseconds = Json::object();
  for (const auto& [part, spent] : times.take()) milliseconds[part] = spent;
  double coverage = 0;
  for (std::size_t k = 3; k < radiance.values().size(); k += 4) coverage += static_cast<double>(radiance.values()[k]);
  const ShadedRenderer& renderer = play.renderer();
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
          {"shadows", play.shadow_record()},
          {"appearance_bytes", frame.appearance_bytes()},
          {"depth_bytes", ShadedFrame::depth_bytes},
          {"milliseconds", milliseconds}};
}

}  // namespace

Camera shade_camera(MovingScene& scene, const CameraSettings& settings, int width, int height) {
  const std::vector<Eigen::Vector3f> shape = shape_now(scene);
  Camera camera = make_camera(shape, settings, width, height);
  see_among(camera, shape);
  return camera;
}

Json shade_to_files(OutputSet& outputs, const std::string& name, const ShadeScene& scene, const ShadeSettings& settings,
                    int threads, const ProgressFunction& progress) {
  const RenderSettings& picture = settings.picture;
  const PictureSettings picture_settings = picture_of(picture);
  const std::vector<double> times = film_times(settings.film, picture.frames, scene.film.description);
  const EglContext context(picture.gl_device, threads);
  ShadedPlay play(scene, settings.shading, settings.film, threads);
  const CameraSettings camera_settings = film_camera(play.moving(), picture);
  const ShadedFrame frame = play.renderer().make_frame(picture.width, picture.height);
  Json metrics;
  const auto draw_at = [&](double time) {
    play.moving().set_time(time);
    play.update();
    const Camera camera = shade_camera(play.moving(), camera_settings_at(camera_settings, scene.film.description, time),
                                       picture.width, picture.height);
    play.draw(camera, frame, 0);
    Image<float> radiance = read_back(frame);
    if (metrics.is_null()) metrics = shade_metrics(play, camera, frame, radiance, context);
    return radiance;
  };
  frames_to_files(outputs, name, times, settings.film.strip, picture_settings, draw_at, progress);
  metrics["frames"] = times.size();
  metrics["times"] = times;
  return metrics;
}

}  // namespace kiln
