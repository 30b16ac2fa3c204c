// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the shadows that things cast on each other while they move, by every method, in tests A and B of [Chapter
// 2010], 6.3.1, and C and D (shadow_stands.h): filters and frames a second, the error of exit radiance against
// independent rays, and jumps between frames. Prints Markdown.
//
//   bench_moving_shadows [--mesh /usr/share/glmark2/models/bunny.obj] [--seconds 0.25] [--frames 24] [--only speed]
//                        [--stand B] [--samples 6] [--method "combined, 1,024 directions"]
//   bench_moving_shadows --scene samples/strike.yaml     [--frames 24]   # goes through its film, light at all vertices
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "../unit/shapes.h"
#include "asset/prt_asset.h"
#include "base/command_line.h"
#include "cost.h"
#include "runtime/play/moving_scene.h"
#include "runtime/scene_file/scene_file.h"
#include "shadow_stands.h"

namespace {

using namespace kiln;

struct Arguments {
  std::string mesh = "/usr/share/glmark2/models/bunny.obj", only = "all", stand, method, scene;
  double seconds = 0.25;
  int frames = 24, samples = 6;

  bool takes(const std::string& caption) const { return method.empty() || caption == method; }
};

/// A column of the tables.
struct MethodSetup {
  const char* caption;
  ShadowMethod method;
  int product_bands = 0;
  bool composite_balls = false, has_sky = false;
  int error_directions = 10000;  ///< 0: its error is not measured
  LightWindow window = LightWindow::none;
  bool is_timed = true, is_lamp = false;  ///< a ball of light in place of a cone
};
constexpr MethodSetup setups[] = {
    {"thesis", ShadowMethod::thesis, 0, false, false, 10000, LightWindow::hann},
    {"thesis, composite nodes as balls", ShadowMethod::thesis, 0, true, false, 10000, LightWindow::hann},
    {"thesis, Hann on filters alone", ShadowMethod::thesis, 0, false, false, 10000, LightWindow::none, false},
    {"product", ShadowMethod::product},
    {"product of 9 bands", ShadowMethod::product, 9},
    {"subtraction", ShadowMethod::subtraction},
    {"exponentiation", ShadowMethod::exponentiation},
    {"fields", ShadowMethod::fields},
    {"**combined**", ShadowMethod::combined},
    {"combined, and a sky", ShadowMethod::combined, 0, false, true, 0},
    {"combined, light of a ball", ShadowMethod::combined, 0, false, false, 0, LightWindow::none, true, true},
    {"combined, 1,024 directions", ShadowMethod::combined, 0, false, false, 1024, LightWindow::none, false},
    {"combined, light under Hann", ShadowMethod::combined, 0, false, false, 10000, LightWindow::hann, false},
    {"combined, light deringed", ShadowMethod::combined, 0, false, false, 10000, LightWindow::dering, false},
};

ShadowSettings settings_of(const MethodSetup& setup, int directions, int threads) {
  ShadowSettings settings;
  settings.method = setup.method;
  settings.directions = directions;
  settings.threads = threads;
  settings.product_bands = setup.product_bands;
  settings.composite_balls = setup.composite_balls;
  return settings;
}

SceneLights lights_of(const ShadowStand& stand, double half_angle, const MethodSetup& setup) {
  SceneLights lights{{stand_light(stand, half_angle)}, std::nullopt, setup.window};
  if (setup.is_lamp) {  // as large from the origin as the cone
    LightSpec& lamp = lights.specs[0];
    lamp.kind = LightSpec::Kind::sphere;
    constexpr double distance = 20, degree = 0.017453292519943295;
    Eigen::Map<Eigen::Vector3d>(lamp.position.data()) = distance * stand.towards_light.normalized();
    lamp.radius = distance * std::sin(half_angle * degree);
  }
  if (setup.has_sky) {
    LightSpec sky;
    sky.kind = LightSpec::Kind::hemisphere;
    sky.elevation_degrees = 90;
    lights.specs.push_back(sky);
  }
  return lights;
}

struct Speed {
  double updates = 0, frames = 0;  ///< a second
};

/// Runs through the motion, 60 frames long, until the time is over.
Speed speed_of(const ShadowStand& stand, const MethodSetup& setup, int directions, int threads, double seconds) {
  MovingShadows shadows = shadows_of(stand, settings_of(setup, directions, threads));
  const SceneLights lights = lights_of(stand, 12, setup);
  shadows.update(stand.poses(0), lights);
  std::size_t computed = 0;
  int frames = 0;
  const auto start = std::chrono::steady_clock::now();
  double passed = 0;
  while (passed < seconds || frames < 3) {
    shadows.update(stand.poses(std::fmod(++frames / 60.0 + 0.005, 1.0)), lights);
    computed += shadows.statistics().computed;
    passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return {static_cast<double>(computed) / passed, frames / passed};
}

void print_speeds(const std::vector<ShadowStand>& stands, const Arguments& arguments) {
  for (const ShadowStand& stand : stands) {
    std::printf("\n### %s: filters a second, frames a second in brackets\n\n", stand.name.c_str());
    std::printf("| method | 625, 1 thread | 2,500 | 10,000 | 625, 2 threads | 2,500 | 10,000 |\n");
    std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const MethodSetup& setup : setups) {
      if (!setup.is_timed || !arguments.takes(setup.caption)) continue;
      std::printf("| %s |", setup.caption);
      for (const int threads : {1, 2})
        for (const int directions : {625, 2500, 10000}) {
          const Speed speed = speed_of(stand, setup, directions, threads, arguments.seconds);
          std::printf(" %.0f (%.3g) |", speed.updates, speed.frames);
          std::fflush(stdout);
        }
      std::printf("\n");
    }
  }
}

double rms(const FrameRadiance& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

FrameRadiance less(FrameRadiance a, const FrameRadiance& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
  return a;
}

/// Shares of the unshadowed exit radiance (RMS), over frames.
struct FrameErrors {
  double mean = 0, worst = 0;
  int frames = 0;

  void add(double error) {
    mean = (mean * frames + error) / (frames + 1);
    worst = std::max(worst, error);
    ++frames;
  }
};

/// Frames of a motion, and their truth.
struct Film {
  std::vector<ScenePoses> poses;
  std::vector<TrueFrame> truth;
  double unshadowed = 0;  ///< RMS of all frames

  /// The times are `first` to `last`; `seed` 0: other rays for each frame.
  Film(const ShadowStand& stand, double half_angle, int frames, double first, double last, unsigned seed) {
    for (int k = 0; k < frames; ++k) {
      poses.push_back(stand.poses(first + (last - first) * (k + 0.5) / frames));
      truth.push_back(true_frame(stand, poses.back(), stand_light(stand, half_angle),
                                 seed != 0 ? seed : static_cast<unsigned>(k) + 1));
      unshadowed += rms(truth.back().unshadowed) / frames;
    }
  }

  double share(const FrameRadiance& a, const FrameRadiance& b) const { return rms(less(a, b)) / unshadowed; }
};

/// Prints the largest change between two frames of slow motion through the place where the truth changes most, by every
/// method, and that of its difference from the truth, which is what flickers.
void print_jumps(const ShadowStand& stand, const Film& film, const Arguments& arguments) {
  const auto frames = static_cast<double>(film.truth.size());
  std::size_t most = 1;
  for (std::size_t k = 1; k < film.truth.size(); ++k)
    if (film.share(film.truth[k].exact, film.truth[k - 1].exact) >
        film.share(film.truth[most].exact, film.truth[most - 1].exact))
      most = k;
  const Film slow(stand, 12, 33, (static_cast<double>(most) - 0.5) / frames, (static_cast<double>(most) + 0.5) / frames,
                  1);
  FrameErrors of_truth;
  for (std::size_t k = 1; k < slow.truth.size(); ++k)
    of_truth.add(slow.share(slow.truth[k].exact, slow.truth[k - 1].exact));
  std::printf("\nIn 32 steps where the truth changes most, by at most %.2f %% a step:\n\n", 100 * of_truth.worst);
  std::printf("| method | largest step | largest step of the error |\n| --- | --- | --- |\n");
  for (const MethodSetup& setup : setups) {
    if (setup.error_directions == 0 || !arguments.takes(setup.caption)) continue;
    MovingShadows shadows = shadows_of(stand, settings_of(setup, setup.error_directions, 0));
    FrameErrors step, of_error;
    FrameRadiance before, error_before;
    for (std::size_t k = 0; k < slow.poses.size(); ++k) {
      shadows.update(slow.poses[k], lights_of(stand, 12, setup));
      const FrameRadiance frame = frame_of(stand, shadows), error = less(frame, slow.truth[k].exact);
      if (k > 0) step.add(slow.share(frame, before));
      if (k > 0) of_error.add(slow.share(error, error_before));
      before = frame;
      error_before = error;
    }
    std::printf("| %s | %.2f %% | %.2f %% |\n", setup.caption, 100 * step.worst, 100 * of_error.worst);
  }
}

void print_errors(const ShadowStand& stand, int frames, const Arguments& arguments) {
  for (const double half_angle : {6.0, 12.0, 30.0}) {
    const Film film(stand, half_angle, frames, 0, 1, 0);
    FrameErrors of_bands, shadow;
    for (const TrueFrame& now : film.truth) {
      of_bands.add(film.share(now.bands, now.exact));
      shadow.add(film.share(now.unshadowed, now.exact));
    }
    std::printf("\n### %s, light of %g degrees\n\n", stand.name.c_str(), half_angle);
    std::printf("Shadows change %.1f %% (worst frame %.1f); five bands at each place cost %.1f %% (%.1f).\n\n",
                100 * shadow.mean, 100 * shadow.worst, 100 * of_bands.mean, 100 * of_bands.worst);
    std::printf("| method | error, mean | worst frame | from five bands, mean | worst frame |\n");
    std::printf("| --- | --- | --- | --- | --- |\n");
    for (const MethodSetup& setup : setups) {
      if (setup.error_directions == 0 || !arguments.takes(setup.caption)) continue;
      MovingShadows shadows = shadows_of(stand, settings_of(setup, setup.error_directions, 0));
      FrameErrors error, added;
      for (std::size_t k = 0; k < film.poses.size(); ++k) {
        shadows.update(film.poses[k], lights_of(stand, half_angle, setup));
        const FrameRadiance frame = frame_of(stand, shadows);
        error.add(film.share(frame, film.truth[k].exact));
        added.add(film.share(frame, film.truth[k].bands));
      }
      std::printf("| %s | %.1f %% | %.1f %% | %.1f %% | %.1f %% |\n", setup.caption, 100 * error.mean,
                  100 * error.worst, 100 * added.mean, 100 * added.worst);
      std::fflush(stdout);
    }
    if (half_angle == 12 && stand.receivers.size() < 10) print_jumps(stand, film, arguments);
  }
}

/// Prints the speeds that goals are set for, at their settings, on two threads.
void print_goals(const std::vector<ShadowStand>& stands, const Arguments& arguments) {
  constexpr MethodSetup thesis{"thesis", ShadowMethod::thesis}, combined{"combined", ShadowMethod::combined};
  std::printf("\n### Goals, two threads\n\n| | goal | combined | thesis |\n| --- | --- | --- | --- |\n");
  for (const ShadowStand& stand : stands) {
    const bool by_frame = stand.name == "C";
    if (!by_frame && stand.name != "A" && stand.name != "B") continue;
    const int directions = by_frame ? 1024 : 10000;
    const Speed ours = speed_of(stand, combined, directions, 2, 4 * arguments.seconds),
                theirs = speed_of(stand, thesis, directions, 2, 4 * arguments.seconds);
    std::printf("| %s, %d directions, %s a second | %d | %.0f | %.0f |\n", stand.name.c_str(), directions,
                by_frame ? "frames" : "filters", by_frame ? 20 : 200, by_frame ? ours.frames : ours.updates,
                by_frame ? theirs.frames : theirs.updates);
  }
}

/// Fits the exponent with which the time of a frame of D grows with the number of objects.
void print_growth(const StandBodies& bodies, const Arguments& arguments) {
  const std::vector<int> counts = {5, 10, 20, 30, 60};
  std::printf("\n### D: milliseconds a frame, 1,024 directions, one thread\n\n| method |");
  for (const int count : counts) std::printf(" %d objects |", count);
  std::printf(" grows as n to the power of |\n| --- |");
  for (std::size_t k = 0; k <= counts.size(); ++k) std::printf(" --- |");
  std::printf("\n");
  for (const MethodSetup& setup : setups) {
    if (!setup.is_timed || !arguments.takes(setup.caption)) continue;
    std::printf("| %s |", setup.caption);
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const int count : counts) {
      const double milliseconds = 1000 / speed_of(stand_d(bodies, count), setup, 1024, 1, arguments.seconds).frames;
      std::printf(" %.2f |", milliseconds);
      std::fflush(stdout);
      const double a = std::log(count), b = std::log(milliseconds);
      x += a;
      y += b;
      xx += a * a;
      xy += a * b;
    }
    const auto n = static_cast<double>(counts.size());
    std::printf(" %.2f |\n", (n * xy - x * y) / (n * xx - x * x));
  }
}

/// Goes through a scene file's film in even steps, light at all vertices, and prints what its shadows cost.
void print_scene(const Arguments& arguments) {
  SceneDescription description = load_scene(arguments.scene);
  std::vector<PrtAsset> assets;
  for (const std::filesystem::path& folder : description.assets) assets.push_back(load_prt_asset(folder));
  std::vector<const PrtAsset*> pointers;
  for (const PrtAsset& asset : assets) pointers.push_back(&asset);
  const double end = duration_of(description);
  std::printf(
      "| threads | frames | seconds a frame | CPU seconds a frame | worst frame | filters a frame, computed | kept "
      "|\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const int threads : {1, 2}) {
    MovingScene scene(description, pointers, {{.threads = threads}, samples_at_vertices});
    scene.update();
    const int frames = arguments.frames;
    Cost all{0, 0};
    double worst = 0;
    std::size_t computed = 0, kept = 0;
    for (int frame = 1; frame <= frames; ++frame) {
      scene.set_time(end * frame / frames);
      const Cost cost = cost_of([&] { scene.update(); });
      all = all + cost;
      worst = std::max(worst, cost.wall);
      computed += scene.statistics().computed;
      kept += scene.statistics().kept;
    }
    std::printf("| %d | %d | %.4f | %.4f | %.4f | %.0f | %.0f |\n", threads, frames, all.wall / frames,
                all.cpu / frames, worst, static_cast<double>(computed) / frames, static_cast<double>(kept) / frames);
  }
}

void run(const Arguments& arguments) {
  if (!arguments.scene.empty()) return print_scene(arguments);
  TriangleMesh ground = shapes::plane(16);
  const StandBodies bodies{stand_object(shapes::icosphere(3), true, arguments.samples),
                           stand_object(load_body(arguments.mesh, 2000), false, arguments.samples),
                           stand_object(ground, true)};
  std::printf(
      "Ball: %zu vertices; bunny: %zu; ground: %zu. %d samples of incident light a node (-1: vertices), but one for "
      "each\n"
      "vertex of C's bunny and D's ground.\n",
      bodies.ball.mesh.positions.size(), bodies.bunny.mesh.positions.size(), bodies.ground.mesh.positions.size(),
      arguments.samples);
  std::vector<ShadowStand> stands = {stand_a(bodies), stand_b(bodies), stand_c(bodies, true), stand_c(bodies, false),
                                     stand_d(bodies, 30)};
  if (!arguments.stand.empty())
    std::erase_if(stands, [&](const ShadowStand& stand) { return stand.name != arguments.stand; });
  if (arguments.only != "speed")
    for (const ShadowStand& stand : stands)
      print_errors(stand, stand.receivers.size() > 10 ? std::min(arguments.frames, 8) : arguments.frames, arguments);
  if (arguments.only != "errors") {
    print_goals(stands, arguments);
    print_speeds(stands, arguments);
    print_growth(bodies, arguments);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Measures shadows of things that move"};
  app.add_option("--mesh", arguments.mesh, "Mesh of the bunny");
  app.add_option("--seconds", arguments.seconds, "Seconds of each speed")->check(CLI::Range(0.01, 60.0));
  app.add_option("--frames", arguments.frames, "Frames of a motion, for errors")->check(CLI::Range(2, 1000));
  app.add_option("--only", arguments.only, "What is measured")->check(CLI::IsMember({"all", "errors", "speed"}));
  app.add_option("--stand", arguments.stand, "Only this scene")
      ->check(CLI::IsMember({"A", "B", "C", "C, 6 samples", "D, 30"}));
  app.add_option("--method", arguments.method, "Only this method, by its caption");
  app.add_option("--samples", arguments.samples, "Samples of incident light a node: 1 to 8, or -1 for all vertices")
      ->check(CLI::IsMember({-1, 1, 2, 3, 4, 5, 6, 7, 8}));
  app.add_option("--scene", arguments.scene, "A scene.yaml, played in place of all else")->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  run(arguments);
}
