// SPDX-License-Identifier: GPL-3.0-or-later
// Measures shadows of things that move by visibility maps on the GPU (runtime/shadow_gl) beside rays, in the scenes of
// bench_moving_shadows: errors of exit radiance against independent rays, how far both ways are apart, filters and
// frames a second. Prints Markdown, with the renderer's name.
//
//   bench_shadow_maps [--gl-device auto] [--stand all] [--seconds 0.5] [--frames 24] [--only speed]
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "../unit/shapes.h"
#include "base/command_line.h"
#include "gpu/egl_context.h"
#include "runtime/shadow_gl/visibility_maps.h"
#include "shadow_stands.h"

namespace {

using namespace kiln;

struct Arguments {
  std::string mesh = "/usr/share/glmark2/models/bunny.obj", device = "auto", stand = "all", only = "all";
  double seconds = 0.5;
  int frames = 24, threads = 0;
};

/// A row of the tables: rays, or maps of this many texels.
constexpr int rays = 0;
constexpr int rows[] = {rays, 32, 64, 128};

std::string caption_of(int texels) { return texels == rays ? "rays" : "maps of " + std::to_string(texels) + " texels"; }

std::shared_ptr<VisibilityMaps> maps_of(int texels) {
  if (texels == rays) return nullptr;
  VisibilityMapSettings settings;
  settings.texels = texels;
  return std::make_shared<VisibilityMaps>(settings);
}

ShadowSettings settings_of(int directions, int threads) {
  ShadowSettings settings;
  settings.directions = directions;
  settings.threads = threads;
  return settings;
}

SceneLights lights_of(const ShadowStand& stand, double half_angle, bool has_sky) {
  SceneLights lights{{stand_light(stand, half_angle)}, std::nullopt, LightWindow::none};
  if (!has_sky) return lights;
  LightSpec sky;
  sky.kind = LightSpec::Kind::hemisphere;
  sky.elevation_degrees = 90;
  lights.specs.push_back(sky);
  return lights;
}

double rms(const FrameRadiance& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double difference(FrameRadiance a, const FrameRadiance& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
  return rms(a);
}

/// Shares over frames, in %.
struct FrameShares {
  double sum = 0, worst = 0;
  int frames = 0;

  void add(double share) {
    sum += share;
    worst = std::max(worst, share);
    ++frames;
  }
  void print() const { std::printf(" %.2f (%.2f) |", 100 * sum / frames, 100 * worst); }
};

void print_errors(const ShadowStand& stand, const Arguments& arguments) {
  constexpr int directions = 1024;
  std::printf("\n### %s: %% of the unshadowed exit radiance, mean (worst frame), %d directions\n\n", stand.name.c_str(),
              directions);
  std::printf("| | error, 12 degrees | from rays | error, 30 degrees | from rays |\n| --- | --- | --- | --- | --- |\n");
  const int frames = stand.receivers.size() > 10 ? std::min(arguments.frames, 8) : arguments.frames;
  std::vector<std::vector<TrueFrame>> truths;
  std::vector<double> unshadowed;
  for (const double half_angle : {12.0, 30.0}) {
    std::vector<TrueFrame>& truth = truths.emplace_back();
    double mean = 0;
    for (int k = 0; k < frames; ++k) {
      const ScenePoses poses = stand.poses((k + 0.5) / frames);
      truth.push_back(true_frame(stand, poses, stand_light(stand, half_angle), static_cast<unsigned>(k) + 1));
      mean += rms(truth.back().unshadowed) / frames;
    }
    unshadowed.push_back(mean);
  }
  std::vector<std::vector<FrameRadiance>> by_rays(2);
  for (const int texels : rows) {
    std::printf("| %s |", caption_of(texels).c_str());
    for (std::size_t light = 0; light < 2; ++light) {
      MovingShadows shadows = shadows_of(stand, settings_of(directions, arguments.threads), maps_of(texels));
      FrameShares error, apart;
      for (int k = 0; k < frames; ++k) {
        shadows.update(stand.poses((k + 0.5) / frames), lights_of(stand, light == 0 ? 12 : 30, false));
        const auto number = static_cast<std::size_t>(k);
        const FrameRadiance frame = frame_of(stand, shadows);
        if (texels == rays) by_rays[light].push_back(frame);
        error.add(difference(frame, truths[light][number].exact) / unshadowed[light]);
        apart.add(difference(frame, by_rays[light][number]) / unshadowed[light]);
      }
      error.print();
      apart.print();
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

/// Goes through the motion, 60 frames long, until the time is over: filters a second, and frames in brackets.
void print_speed(const ShadowStand& stand, int texels, int directions, bool has_sky, const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  MovingShadows shadows = shadows_of(stand, settings_of(directions, arguments.threads), maps_of(texels));
  const SceneLights lights = lights_of(stand, 12, has_sky);
  shadows.update(stand.poses(0), lights);
  std::size_t computed = 0;
  int frames = 0;
  const auto start = Clock::now();
  double passed = 0;
  while (passed < arguments.seconds || frames < 3) {
    shadows.update(stand.poses(std::fmod(++frames / 60.0 + 0.005, 1.0)), lights);
    computed += shadows.statistics().computed;
    passed = std::chrono::duration<double>(Clock::now() - start).count();
  }
  std::printf(" %.0f (%.3g) |", static_cast<double>(computed) / passed, frames / passed);
  std::fflush(stdout);
}

void print_speeds(const ShadowStand& stand, const Arguments& arguments) {
  std::printf("\n### %s: filters a second, frames a second in brackets\n\n", stand.name.c_str());
  std::printf("| | 625 directions | 2,500 | 10,000 | 1,024, and a sky |\n| --- | --- | --- | --- | --- |\n");
  for (const int texels : rows) {
    std::printf("| %s |", caption_of(texels).c_str());
    for (const int directions : {625, 2500, 10000}) print_speed(stand, texels, directions, false, arguments);
    print_speed(stand, texels, 1024, true, arguments);
    std::printf("\n");
  }
}

void run(const Arguments& arguments) {
  const EglContext context(arguments.device, arguments.threads);
  TriangleMesh ground = shapes::plane(16);
  const StandBodies bodies{stand_object(shapes::icosphere(3), true),
                           stand_object(load_body(arguments.mesh, 2000), false), stand_object(ground, true)};
  std::printf("GL renderer: %s\n", context.renderer().c_str());
  for (const ShadowStand& stand : {stand_a(bodies), stand_b(bodies), stand_c(bodies, true), stand_d(bodies, 30)}) {
    if (arguments.stand != "all" && stand.name.substr(0, 1) != arguments.stand) continue;
    if (arguments.only != "speed") print_errors(stand, arguments);
    if (arguments.only != "errors") print_speeds(stand, arguments);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Measures shadows of things that move by visibility maps, beside rays"};
  app.add_option("--mesh", arguments.mesh, "Mesh of the bunny");
  app.add_option("--gl-device", arguments.device, "auto, software, or the number of an EGL device");
  app.add_option("--stand", arguments.stand, "Scene")->check(CLI::IsMember({"all", "A", "B", "C", "D"}));
  app.add_option("--seconds", arguments.seconds, "Seconds of each speed")->check(CLI::Range(0.01, 60.0));
  app.add_option("--frames", arguments.frames, "Frames of a motion, for errors")->check(CLI::Range(2, 1000));
  app.add_option("--threads", arguments.threads, "Threads of rays and of llvmpipe; 0: all")->check(CLI::Range(0, 1024));
  app.add_option("--only", arguments.only, "What is measured")->check(CLI::IsMember({"all", "errors", "speed"}));
  CLI11_PARSE(app, argc, argv);
  run(arguments);
}
