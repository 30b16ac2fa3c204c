// Time of a frame and GPU memory of every technique, as Chapter 2010, tables 6.1 and 6.2, and of deferred shading where
// many surfaces lie behind one another. Prints Markdown.
//
//   bench_techniques PRT [--compressed FOLDER] [--width 1280] [--height 720] [--rounds 20] [--gl-device auto]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "base/command_line.h"
#include "gpu/egl_context.h"
#include "relight/draw/scene_renderer.h"
#include "relight/render_settings.h"

namespace {

using namespace kiln;

struct Arguments {
  std::string folder, compressed, device = "auto";
  int width = 1280, height = 720, rounds = 20;
};

/// Milliseconds of a frame, of many: the least and the median. What a picture shows is lit anew in every frame where
/// `relight` is given, as by a light that moves.
struct FrameTime {
  double least = 0, median = 0;
};

template <class Draw>
FrameTime time_frames(int rounds, Draw draw) {
  for (int k = 0; k < 2; ++k) draw();
  glFinish();
  std::vector<double> times;
  for (int k = 0; k < rounds; ++k) {
    const auto start = std::chrono::steady_clock::now();
    draw();
    glFinish();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return {times.front(), times[times.size() / 2]};
}

SceneView view_of(const Arguments& arguments, const BoundingBox& box) {
  RenderSettings settings;
  settings.width = arguments.width;
  settings.height = arguments.height;
  return views_of(settings, box).front();
}

void compare_techniques(const Arguments& arguments, const PrtAsset& asset, const std::optional<PrtAsset>& compressed) {
  const Frame frame(arguments.width, arguments.height);
  std::printf(
      "| technique | incident samples | ms a frame, least | median | with a moving light | MB a mesh | bytes a vertex "
      "|\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
  const SceneLights distant{{LightSpec{}}, std::nullopt, LightWindow::hann};
  LightSpec ball{.kind = LightSpec::Kind::sphere, .radius = 0.05};
  const BoundingBox box = bounding_box(asset.mesh);
  for (int axis = 0; axis < 3; ++axis) ball.position[axis] = box.centre()[axis] + 0.7 * box.diagonal();
  const SceneLights local{{ball}, std::nullopt, LightWindow::hann};
  for (const int samples : {1, 6, 8})
    for (const Technique technique : all_techniques) {
      const bool phong = technique == Technique::phong || technique == Technique::normal_map;
      if (technique == Technique::compressed && !compressed) continue;
      if (samples > 1 && phong) continue;
      const PrtAsset& source = technique == Technique::compressed ? *compressed : asset;
      AssetRenderer renderer(source, samples);
      const std::vector<SceneAsset> assets = {{&renderer, {}, technique}};
      const SceneView view = view_of(arguments, scene_box(assets));
      const SceneLights& lights = samples > 1 ? local : distant;
      light_scene(assets, lights, view.look);
      const auto draw = [&] {
        draw_scene(assets, view.camera.clip_from_object().cast<double>(), view.camera.position.cast<double>(), frame);
      };
      const FrameTime still = time_frames(arguments.rounds, draw);
      const FrameTime moving = time_frames(arguments.rounds, [&] {
        light_scene(assets, lights, view.look);
        draw();
      });
      const GpuMemory memory = renderer.memory(technique);
      std::printf("| %s | %d | %.2f | %.2f | %.2f | %.2f | %llu |\n", technique_caption(technique, source).c_str(),
                  samples, still.least, still.median, moving.median, static_cast<double>(memory.per_mesh) / 1e6,
                  static_cast<unsigned long long>(memory.per_vertex));
    }
}

/// A queue of the same asset, each behind the one before, drawn from the last to the first: the worst order.
void compare_shading(const Arguments& arguments, const PrtAsset& asset) {
  const Frame frame(arguments.width, arguments.height);
  const AppearanceFrame appearance(frame, false);
  std::printf(
      "\n| surfaces behind one another | forward, ms | deferred, ms | forward / deferred |\n| --- | --- | --- | --- "
      "|\n");
  const SceneLights lights{{LightSpec{}}, std::nullopt, LightWindow::hann};
  AssetRenderer renderer(asset);
  const BoundingBox box = bounding_box(asset.mesh);
  const SceneView view = view_of(arguments, box);
  for (const int depth : {1, 2, 4, 8, 16}) {
    std::vector<SceneAsset> assets;
    for (int k = depth - 1; k >= 0; --k) {
      Placement placement;
      placement.translation = (0.02 * k * box.diagonal() * view.camera.forward).cast<double>();
      assets.push_back({&renderer, placement, natural_technique(asset)});
    }
    light_scene(assets, lights, view.look);
    const Eigen::Matrix4d clip = view.camera.clip_from_object().cast<double>();
    const Eigen::Vector3d eye = view.camera.position.cast<double>();
    const FrameTime forward = time_frames(arguments.rounds, [&] { draw_scene(assets, clip, eye, frame); });
    const FrameTime deferred =
        time_frames(arguments.rounds, [&] { draw_scene(assets, clip, eye, frame, &appearance); });
    std::printf("| %d | %.2f | %.2f | %.2f |\n", depth, forward.median, deferred.median,
                forward.median / deferred.median);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("bench_techniques", [&] {
    Arguments arguments;
    CLI::App app("Time and memory of every technique");
    app.add_option("PRT", arguments.folder)->required();
    app.add_option("--compressed", arguments.compressed);
    app.add_option("--width", arguments.width);
    app.add_option("--height", arguments.height);
    app.add_option("--rounds", arguments.rounds);
    app.add_option("--gl-device", arguments.device);
    app.parse(argc, argv);
    const PrtAsset asset = load_prt_asset(arguments.folder);
    std::optional<PrtAsset> compressed;
    if (!arguments.compressed.empty()) compressed = load_prt_asset(arguments.compressed);
    const EglContext context(arguments.device);
    std::printf("%s, %d x %d pixels, %zu triangles\n\n", context.renderer().c_str(), arguments.width, arguments.height,
                asset.mesh.triangles.size());
    compare_techniques(arguments, asset, compressed);
    compare_shading(arguments, asset);
  });
}
