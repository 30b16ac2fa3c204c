// SPDX-License-Identifier: GPL-3.0-or-later
// Measures shading by shaders of one's own beside [Lastra 1995], figures 8 and 9: bytes of appearance parameters, the
// parts of each shader, the parts of a frame, and forward, deferred and factored shading where surfaces lie behind one
// another. Prints Markdown.
//
//   bench_shading samples/bowling.yaml [--rounds 3] [--clock wall] [--gl-device auto]
//
// --clock cpu counts the time that the program's threads run, for a machine that does other work, too.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/command_line.h"
#include "gpu/egl_context.h"
#include "runtime/shading/shaded_renderer.h"
#include "shade/shade.h"

namespace {

using namespace kiln;
using Times = std::map<std::string, double>;

constexpr int width = 640, height = 512;  // the paper's picture

struct Arguments {
  std::string scene, clock, device = "auto";
  int rounds = 3;
};

/// Returns the median of each part's milliseconds over some frames, after one that does not count.
Times time_parts(ShadedRenderer& renderer, const Camera& camera, int rounds, PartTimes::Clock clock) {
  const ShadedFrame frame = renderer.make_frame(width, height);
  renderer.draw(camera, frame);
  std::map<std::string, std::vector<double>> all;
  for (int k = 0; k < rounds; ++k) {
    PartTimes times(clock);
    renderer.draw(camera, frame, 0, k, &times);
    for (const auto& [part, time] : times.take()) all[part].push_back(time);
  }
  Times medians;
  for (auto& [part, times] : all) {
    std::sort(times.begin(), times.end());
    medians[part] = times[times.size() / 2];
  }
  return medians;
}

/// Adds up the parts that the picture itself takes, without its tables.
double picture_time(const Times& times) {
  double sum = 0;
  for (const auto& [part, time] : times)
    if (part != "shadow maps" && part != "reflection map" && part != "uniforms") sum += time;
  return sum;
}

/// Returns the share of tiles with several shaders among those that show something.
double mixed_share(const ShadedRenderer& renderer, const ShadedFrame& frame) {
  const std::vector<std::uint32_t> sets = renderer.programs().sets();
  std::vector<std::uint32_t> commands(4 * sets.size());
  glGetNamedBufferSubData(frame.commands().name(), 0, static_cast<GLsizeiptr>(4 * commands.size()), commands.data());
  double mixed = 0, all = 0;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    all += commands[4 * k + 1];
    if ((sets[k] & (sets[k] - 1)) != 0) mixed += commands[4 * k + 1];
  }
  return all > 0 ? mixed / all : 0;
}

/// Squares of `patch` pixels in a plane that fills the picture, every third one: a layer of one shader.
TriangleMesh patches(int which, double patch, double pixel) {
  TriangleMesh mesh;
  const int columns = static_cast<int>(std::ceil(1.2 * width / patch)),
            rows = static_cast<int>(std::ceil(1.2 * height / patch));
  const double side = patch * pixel;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      if ((i + j) % 3 != which) continue;
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        const double x = (i + (corner % 2) - 0.5 * columns) * side, y = (j + corner / 2 - 0.5 * rows) * side;
        mesh.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.f);
        mesh.normals.emplace_back(0.f, 0.f, 1.f);
        mesh.uvs.emplace_back(static_cast<float>(0.5 + x), static_cast<float>(0.5 + y));
      }
      mesh.triangles.push_back({first, first + 1, first + 3});
      mesh.triangles.push_back({first, first + 3, first + 2});
    }
  return mesh;
}

/// Makes an asset of 25 planes of noise, which light is computed from as from any other.
PrtAsset noise_asset() {
  PrtAsset asset;
  asset.bands = 5;
  asset.channels = 1;
  asset.width = asset.height = 256;
  std::vector<Image<std::uint8_t>> pictures;
  std::uint32_t state = 1;
  for (int k = 0; k < 25; ++k) {
    asset.planes.push_back({"", 0, k, {-0.1, 0.2}});
    Image<std::uint8_t>& picture = pictures.emplace_back(256, 256, 1);
    for (std::uint8_t& value : picture.values())
      value = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  }
  asset.pictures = std::move(pictures);
  asset.mesh = patches(0, 64, 0.001);
  return asset;
}

/// Layers behind one another, the last first: the worst order for forward shading. Each has patches of three shaders.
struct Layers {
  std::deque<TriangleMesh> meshes;
  ShadedScene scene;
  Camera camera;

  Layers(int depth, double patch, const std::vector<std::string>& shaders, const PrtAsset* asset) {
    CameraSettings settings;
    settings.azimuth_degrees = settings.elevation_degrees = 0;
    settings.target = Eigen::Vector3d(0, 0.15, 0);
    settings.distance = 1;
    const std::vector<Eigen::Vector3f> box = {{-0.3f, -0.3f, -0.2f}, {0.3f, 0.6f, 0.1f}};
    camera = make_camera(box, settings, width, height);
    const double pixel = 2.0 * static_cast<double>(camera.half_height) / height;
    for (int which = 0; which < 3; ++which) {
      meshes.push_back(patches(which, patch, pixel));
      scene.meshes.push_back({&meshes.back(), asset});
    }
    for (const std::string& shader : shaders) scene.materials.push_back({shader});
    for (int k = depth - 1; k >= 0; --k)
      for (int which = 0; which < 3; ++which) {
        ShadedNode node{which, (which + k) % static_cast<int>(shaders.size()), {}, k == 0};
        // The alley's shader shades planes; a little turn lets lights graze none of them.
        node.placement.translation = Eigen::Vector3d(0.003 * k, 0.15, -0.01 * k);
        scene.nodes.push_back(node);
      }
    scene.lights.specs = {parse_light_spec("sphere:0.5,1,2,0.1"),
                          parse_light_spec("hemisphere:0,90,0.5,0.5,0.5,0.2,0.2,0.2")};
  }
};

class Bench {
 public:
  Bench(const Arguments& arguments, const ShadeScene& scene, PartTimes::Clock clock)
      : arguments_(arguments), scene_(scene), clock_(clock) {}

  void appearance() const {
    std::printf("\n| appearance parameters | PixelFlow, bytes | here, bytes |\n| --- | --- | --- |\n");
    std::printf(
        "| shader, node, footprint |  | 4 |\n| normal |  | 4 |\n| uv |  | 8 |\n| all | 34 | 16 |\n| depth | beside "
        "them | 4 |\n"
        "| varying parameters, where a shader declares some | in the 34 | 8 |\n");
  }

  /// Times each shader over the whole picture, with more and more of its parts.
  void shaders() const {
    std::printf(
        "\n| shader, ms for all pixels, one sample | reading the surface | before the light | the light | after the "
        "light |\n| --- | --- | --- | --- | --- |\n");
    for (const SurfaceShader& shader : scene_.shaders) {
      const Layers layers(1, 64, {shader.name}, nullptr);
      double at[4];
      for (int steps = 0; steps < 4; ++steps) {
        ShadingSettings settings{.samples = 1, .steps = steps};
        ShadedRenderer renderer(layers.scene, scene_.shaders, settings);
        at[steps] = time_parts(renderer, layers.camera, arguments_.rounds, clock_)["shading"];
      }
      std::printf("| %s | %.1f | %.1f | %.1f | %.1f |\n", shader.name.c_str(), at[0], at[1] - at[0], at[2] - at[1],
                  at[3] - at[2]);
      std::fflush(stdout);
    }
  }

  /// Times the parts of a frame of the scene.
  void frame() const {
    const ShadeSettings settings = settings_of_scene();
    MovingScene moving = scene_.moving({.incident_samples = 1});
    const Camera camera = shade_camera(moving, film_camera(moving, settings.picture), width, height);
    std::vector<Times> ways;
    std::map<std::string, int> parts;
    double mixed = 0;
    for (const ShadingWay way : {ShadingWay::forward, ShadingWay::deferred, ShadingWay::factored}) {
      ShadingSettings shading = settings.shading;
      shading.way = way;
      shading.shadow_size = shading.reflection_size = 512;  // the paper's
      ShadedRenderer renderer(scene_.scene, scene_.shaders, shading);
      ways.push_back(time_parts(renderer, camera, arguments_.rounds, clock_));
      for (const auto& [part, time] : ways.back()) ++parts[part];
      if (way != ShadingWay::factored) continue;
      const ShadedFrame frame = renderer.make_frame(width, height);
      renderer.draw(camera, frame);
      mixed = mixed_share(renderer, frame);
    }
    std::printf(
        "\n| a frame of five samples a pixel, ms | forward | deferred | factored |\n| --- | --- | --- | --- |\n");
    for (const auto& [part, count] : parts) {
      std::printf("| %s |", part.c_str());
      for (const Times& times : ways)
        if (const auto found = times.find(part); found != times.end())
          std::printf(" %.1f |", found->second);
        else
          std::printf("  |");
      std::printf("\n");
    }
    std::printf("| the picture without its tables |");
    for (const Times& times : ways) std::printf(" %.1f |", picture_time(times));
    std::printf("\n\nTiles with several shaders: %.0f %%.\n", 100 * mixed);
    std::fflush(stdout);
  }

  void depth(const char* light, const PrtAsset* asset) const {
    std::printf(
        "\n| surfaces behind one another, %s | forward, ms | deferred, ms | factored, ms | forward / factored | "
        "deferred / factored |\n"
        "| --- | --- | --- | --- | --- | --- |\n",
        light);
    for (const int depth : {1, 2, 4, 8, 16}) row(std::to_string(depth), depth, 71, asset, false);
  }

  void patch_sizes() const {
    std::printf(
        "\n| side of a patch, pixels | forward, ms | deferred, ms | factored, ms | forward / factored | deferred / "
        "factored | tiles of several shaders |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const int patch : {320, 71, 37, 19, 9}) row(std::to_string(patch), 1, patch, nullptr, true);
  }

 private:
  ShadeSettings settings_of_scene() const {
    ShadeSettings settings;
    SceneDescription description = scene_.film.description;  // as the camera is chosen in it
    use_scene_look(settings.picture, description, [](const std::string&) { return false; });
    return settings;
  }

  void row(const std::string& label, int depth, double patch, const PrtAsset* asset, bool says_mixed) const {
    std::vector<std::string> names;
    for (const SurfaceShader& shader : scene_.shaders) names.push_back(shader.name);
    const Layers layers(depth, patch, names, asset);
    std::vector<double> ways;
    double mixed = 0;
    for (const ShadingWay way : {ShadingWay::forward, ShadingWay::deferred, ShadingWay::factored}) {
      ShadedRenderer renderer(layers.scene, scene_.shaders, {.way = way, .samples = 1});
      ways.push_back(picture_time(time_parts(renderer, layers.camera, arguments_.rounds, clock_)));
      if (way != ShadingWay::factored) continue;
      const ShadedFrame frame = renderer.make_frame(width, height);
      renderer.draw(layers.camera, frame);
      mixed = mixed_share(renderer, frame);
    }
    std::printf("| %s | %.1f | %.1f | %.1f | %.2f | %.2f |", label.c_str(), ways[0], ways[1], ways[2],
                ways[0] / ways[2], ways[1] / ways[2]);
    if (says_mixed) std::printf(" %.0f %% |", 100 * mixed);
    std::printf("\n");
    std::fflush(stdout);
  }

  const Arguments& arguments_;
  const ShadeScene& scene_;
  PartTimes::Clock clock_;
};

}  // namespace

int main(int argc, char** argv) {
  return run_program("bench_shading", [&] {
    Arguments arguments;
    CLI::App app("Forward, deferred and factored shading");
    app.add_option("SCENE", arguments.scene)->required();
    app.add_option("--rounds", arguments.rounds);
    app.add_option("--clock", arguments.clock);
    app.add_option("--gl-device", arguments.device);
    app.parse(argc, argv);
    const ShadeScene scene = load_shade_scene(arguments.scene);
    const EglContext context(arguments.device);
    const PartTimes::Clock clock = arguments.clock == "cpu" ? PartTimes::Clock::cpu
                                   : context.is_software()  ? PartTimes::Clock::wall
                                                            : PartTimes::Clock::gpu;
    std::printf("%s, %d x %d pixels\n", context.renderer().c_str(), width, height);
    const Bench bench(arguments, scene, clock);
    bench.appearance();
    bench.shaders();
    bench.frame();
    bench.depth("light: a ball with a shadow map, and irradiance", nullptr);
    const PrtAsset asset = noise_asset();
    bench.depth("the same, and transfer of 25 planes in place of irradiance", &asset);
    bench.patch_sizes();
  });
}
