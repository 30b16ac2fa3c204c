// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the time of a frame and the GPU memory of every technique, as in [Chapter 2010], tables 6.1 and 6.2, and of
// deferred shading where many surfaces lie behind one another; and the error of a few samples of incident light near a
// mesh; and of light in one to eight functions beside RGB. Prints Markdown.
//
//   bench_techniques PRT [--compressed FOLDER] [--width 1280] [--height 720] [--rounds 20] [--gl-device auto]
//   [--only-functions]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "base/command_line.h"
#include "gpu/egl_context.h"
#include "render/lamps.h"
#include "render/render_settings.h"
#include "runtime/draw/scene_renderer.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/transfer.h"

namespace {

using namespace kiln;

struct Arguments {
  std::string folder, compressed, device = "auto";
  int width = 1280, height = 720, rounds = 20;
  bool only_functions = false;
};

/// Milliseconds per frame, over many frames.
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

SceneView view_of(const Arguments& arguments, const std::vector<Eigen::Vector3f>& shape) {
  RenderSettings settings;
  settings.width = arguments.width;
  settings.height = arguments.height;
  return views_of(settings, shape).front();
}

/// Times textured PRT under one to eight functions of light beside RGB, of a surface whose albedo is a picture.
void compare_functions(const Arguments& arguments, PrtAsset asset) {
  if (asset.albedo.picture.values().empty()) {
    asset.albedo = PrtAlbedo::of_picture("albedo.png");
    asset.albedo.picture = Image<std::uint8_t>(512, 512, 3);
    for (std::size_t k = 0; std::uint8_t & value : asset.albedo.picture.values())
      value = static_cast<std::uint8_t>(k++ * 2654435761u >> 8);
  }
  const Frame frame(arguments.width, arguments.height);
  const char* const lamps[] = {"A", "F11", "D65", "F2", "D50", "F7", "P1900", "D25000"};
  std::printf("\n| light | ms a frame, least | median | to RGB |\n| --- | --- | --- | --- |\n");
  constexpr int most = 8;
  std::vector<std::unique_ptr<AssetRenderer>> renderers;
  for (int functions = 0; functions <= most; ++functions) {
    renderers.push_back(std::make_unique<AssetRenderer>(asset));
    AssetRenderer& renderer = *renderers.back();
    const std::vector<SceneAsset> assets = {{&renderer, {}, Technique::textured_prt}};
    LightSettings lights;
    for (int k = 0; k < std::max(1, functions); ++k) lights.lights.push_back("45,30");
    if (functions == 0) {
      light_scene(assets, scene_lights(lights, asset.bands), {});
      continue;
    }
    const LampScene scene =
        SpectralAssets({&asset}, {}).under(lights, std::vector<std::string>(lamps, lamps + functions), asset.bands);
    renderer.set_colors(scene.colors[0]);
    light_scene(assets, scene.lights, {});
  }
  // Frames of all take turns, so that what else the machine does meets all alike.
  std::vector<std::vector<double>> times(renderers.size());
  for (int round = -2; round < arguments.rounds; ++round)
    for (std::size_t k = 0; k < renderers.size(); ++k) {
      const std::vector<SceneAsset> assets = {{renderers[k].get(), {}, Technique::textured_prt}};
      const SceneView view = view_of(arguments, scene_shape(assets));
      glFinish();
      const auto start = std::chrono::steady_clock::now();
      draw_scene(assets, view.camera.clip_from_object().cast<double>(), view.camera.position.cast<double>(), frame);
      glFinish();
      if (round >= 0)
        times[k].push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
  for (std::vector<double>& some : times) std::sort(some.begin(), some.end());
  for (std::size_t k = 0; k < times.size(); ++k)
    std::printf("| %s | %.2f | %.2f | %.2f |\n", k == 0 ? "RGB" : std::to_string(k).c_str(), times[k].front(),
                times[k][times[k].size() / 2], times[k].front() / times[0].front());
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
      const SceneView view = view_of(arguments, scene_shape(assets));
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

/// Compares forward and deferred shading of a queue of the same asset, each behind the one before, drawn from the last
/// to the first: the worst order.
void compare_shading(const Arguments& arguments, const PrtAsset& asset) {
  const Frame frame(arguments.width, arguments.height);
  const AppearanceFrame appearance(arguments.width, arguments.height, false);
  std::printf(
      "\n| surfaces behind one another | forward, ms | deferred, ms | forward / deferred |\n| --- | --- | --- | --- "
      "|\n");
  const SceneLights lights{{LightSpec{}}, std::nullopt, LightWindow::hann};
  AssetRenderer renderer(asset);
  const BoundingBox box = bounding_box(asset.mesh);
  const SceneView view = view_of(arguments, asset.mesh.positions);
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

/// Computes the error of lighting an unshadowed mesh by `count` samples of incident light, against the light at every
/// vertex: the relative L2 of exit radiance over 18 directions to a ball that stands `distance` half-diagonals from the
/// centre. `inverse_distance`: contributions as intended by [Chapter 2010], 1 / D_s.
double error_of_samples(const TriangleMesh& mesh, int count, double distance, bool inverse_distance) {
  const BoundingBox box = bounding_box(mesh);
  const double unit = 0.5 * static_cast<double>(box.diagonal());
  IncidentSamples samples = place_incident_samples(mesh, count);
  const auto points = static_cast<std::size_t>(samples.count());
  if (inverse_distance)
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      double sum = 0;
      for (std::size_t k = 0; k < points; ++k)
        sum += 1 / std::max(1e-6 * unit, static_cast<double>((mesh.positions[v] - samples.points[k]).norm()));
      for (std::size_t k = 0; k < points; ++k)
        samples.contributions[v * points + k] = static_cast<float>(
            1 / std::max(1e-6 * unit, static_cast<double>((mesh.positions[v] - samples.points[k]).norm())) / sum);
    }
  constexpr int bands = 5;
  const ShBasis basis(bands);
  double difference = 0, whole = 0;
  for (int azimuth = 0; azimuth < 360; azimuth += 60)
    for (const int elevation : {-30, 20, 60}) {
      LightSpec ball{.kind = LightSpec::Kind::sphere, .radius = 0.05 * unit};
      const Eigen::Vector3f towards = direction_from_angles(azimuth, elevation);
      for (int axis = 0; axis < 3; ++axis) ball.position[axis] = box.centre()[axis] + distance * unit * towards[axis];
      const SceneLights lights{{ball}, std::nullopt, LightWindow::hann};
      const AssetLight light = light_asset(lights, bands, {}, samples.points);
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const std::vector<float> transfer = unoccluded_transfer(basis, mesh.normals[v]);
        const double exact =
            dot_product(transfer, lights.incident(bands, mesh.positions[v].cast<double>()).channels[0]);
        double blended = 0;
        for (std::size_t k = 0; k < points; ++k)
          blended += samples.contributions[v * points + k] * dot_product(transfer, light.samples[k].channels[0]);
        difference += (blended - exact) * (blended - exact);
        whole += exact * exact;
      }
    }
  return std::sqrt(difference / whole);
}

void compare_samples(const TriangleMesh& mesh) {
  std::printf("\n| samples | contributions | ball at 1.3 half-diagonals | 2 | 4 |\n| --- | --- | --- | --- | --- |\n");
  for (const auto& [count, inverse] : {std::pair{1, false}, {6, true}, {6, false}, {8, true}, {8, false}}) {
    std::printf("| %d | %s |", count, count == 1 ? "" : inverse ? "1 / distance" : "moving least squares");
    for (const double distance : {1.3, 2.0, 4.0})
      std::printf(" %.1f %% |", 100 * error_of_samples(mesh, count, distance, inverse));
    std::printf("\n");
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
    app.add_flag("--only-functions", arguments.only_functions);
    app.parse(argc, argv);
    const PrtAsset asset = load_prt_asset(arguments.folder);
    std::optional<PrtAsset> compressed;
    if (!arguments.compressed.empty()) compressed = load_prt_asset(arguments.compressed);
    const EglContext context(arguments.device);
    std::printf("%s, %d x %d pixels, %zu triangles\n\n", context.renderer().c_str(), arguments.width, arguments.height,
                asset.mesh.triangles.size());
    if (!arguments.only_functions) {
      compare_techniques(arguments, asset, compressed);
      compare_shading(arguments, asset);
      compare_samples(asset.mesh);
    }
    compare_functions(arguments, asset);
  });
}
