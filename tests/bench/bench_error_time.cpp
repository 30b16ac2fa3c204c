// SPDX-License-Identifier: GPL-3.0-or-later
// Measures error against time: bakes an asset by each of a list of settings with each of several numbers of directions,
// and compares it with Embree's rays over many more directions from some of the receivers. Prints CSV, one row per
// bake:
//   setting                                as `kiln-bake` takes it
//   directions
//   seconds, cpu_seconds                   of bake(), all receivers, the engine's start included; CPU of all threads
//   relative_l2, expected_relighting_error before quantisation
//   million_texel_directions_per_second
//   baked_share                            of the texels; under 1 with --adaptive
//
//   bench_error_time [--asset FOLDER] [--mesh MESH] [--reference 65536] [--sample 2048] [--threads 2]
//                    [--only TEXT] [--setting "--backend egl --shadow-size 512"]... [--directions N...]
// FOLDER is an asset of `kiln build` (atlas.drc and normals/): the receivers are its texels. With an empty one they are
// the vertices of MESH, whose triangles are the occluders.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bake/backends.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "bench_scene.h"
#include "cost.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace {

using namespace kiln;

constexpr int seed = 1;

struct Series {
  std::string setting;
  std::vector<int> directions;
};

/// Lists the built-in settings. Depth maps on a software renderer get the fewest directions: they are the slowest
/// there.
std::vector<Series> built_in() {
  return {{"--backend beams", {256, 1024, 4096, 16384}},
          {"--backend beams --sampling progressive", {256, 1024, 4096, 16384}},
          {"--backend beams --sampling stratified", {256, 1024, 4096, 16384}},
          {"--backend embree", {256, 1024, 4096}},
          {"--backend egl --shadow-size 512", {256, 1024}},
          {"--backend egl --shadow-size 1024", {256, 1024}},
          {"--backend egl --shadow-size 2048", {256, 1024}},
          {"--backend egl --shadow-size 512 --refine rays", {256, 1024}},
          {"--backend egl --shadow-size 1024 --refine rays", {256, 1024}}};
}

/// Parses "--name value ..." and "--switch ...".
BakeSettings parse(const std::string& text) {
  BakeSettings settings;
  const OptionSet options = bake_options(settings);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const Option* option = word.starts_with("--") ? options.find(word.substr(2)) : nullptr;
    if (option == nullptr) throw std::runtime_error("unknown option " + word + " in setting '" + text + "'");
    std::string value = "true";
    if (!option->is_switch && !(words >> value)) throw std::runtime_error(word + " needs a value");
    option->set(value);
  }
  return settings;
}

/// Every `step`-th receiver, its transfer, and its reference transfer.
class Truth {
 public:
  Truth(const BakeScene& scene, int directions, std::size_t receivers, int threads)
      : step_(std::max<std::size_t>(1, scene.receivers.slots.size() / receivers)) {
    for (std::size_t r = 0; r < scene.receivers.slots.size(); r += step_) {
      positions_.push_back(scene.receivers.positions[r]);
      normals_.push_back(scene.receivers.normals[r]);
    }
    const BakeSettings settings;
    const std::unique_ptr<TransferEngine> rays = make_engine(BakeBackend::embree, scene.occluders, settings, threads);
    rays->set_receivers({positions_, normals_}, settings.bands);
    // Rotates the sphere differently from the bakes, so that no error is shared.
    rays->add(sample_directions(Sampling::fibonacci, directions, seed + 98), no_progress);
    transfer_ = rays->sums().transfer();
  }

  const TransferVectors& transfer() const { return transfer_; }

  TransferVectors sampled(const TransferVectors& all) const {
    TransferVectors some(positions_.size(), all.coefficients);
    for (int i = 0; i < all.coefficients; ++i)
      for (std::size_t r = 0; r < some.receivers; ++r) some.plane(i)[r] = all.plane(i)[r * step_];
    return some;
  }

 private:
  std::size_t step_;
  std::vector<Eigen::Vector3f> positions_, normals_;
  TransferVectors transfer_;
};

void run(const BakeScene& scene, const std::vector<Series>& list, const Truth& truth, int threads) {
  std::printf(
      "setting,directions,seconds,cpu_seconds,relative_l2,expected_relighting_error,"
      "million_texel_directions_per_second,baked_share\n");
  for (const Series& series : list)
    for (int directions : series.directions) {
      BakeSettings settings = parse(series.setting);
      settings.directions = directions;
      BakeResult result;
      const Cost cost = cost_of([&] { result = bake({scene.receivers, scene.occluders, settings, seed, threads}); });
      const TransferVectors some = truth.sampled(result.channels.front());
      const double pairs = static_cast<double>(scene.receivers.slots.size()) * result.directions;
      const double interpolated = result.adaptive ? static_cast<double>(result.adaptive->interpolated) : 0;
      std::printf("%s,%d,%.3f,%.3f,%.6f,%.6f,%.2f,%.3f\n", series.setting.c_str(), result.directions, cost.wall,
                  cost.cpu, relative_l2(some, truth.transfer()), expected_relighting_error(some, truth.transfer()),
                  pairs / cost.wall / 1e6, 1 - interpolated / static_cast<double>(scene.receivers.slots.size()));
      std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
  int reference = 65536, sample = 2048, threads = 2;
  std::string asset = "out/bunny", mesh_file = "/usr/share/glmark2/models/bunny.obj", only;
  std::vector<std::string> settings;
  std::vector<int> directions;
  CLI::App app("Error against time of the bake's settings, as CSV");
  app.add_option("--asset", asset, "folder with atlas.drc and normals/; empty: the mesh's vertices")
      ->capture_default_str();
  app.add_option("--mesh", mesh_file, "occluders")->capture_default_str();
  app.add_option("--reference", reference, "directions of the reference")->capture_default_str();
  app.add_option("--sample", sample, "receivers that errors are measured on, about")->capture_default_str();
  app.add_option("--threads", threads, "of all backends")->capture_default_str();
  app.add_option("--only", only, "just those of the built-in settings that have this text in them");
  app.add_option("--setting", settings, "options of kiln-bake in one text; replaces the built-in ones, repeatable");
  app.add_option("--directions", directions, "replaces the numbers of directions");
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<Series> list;
    for (const std::string& setting : settings) list.push_back({setting, {256, 1024}});
    if (list.empty())
      for (const Series& series : built_in())
        if (series.setting.find(only) != std::string::npos) list.push_back(series);
    if (!directions.empty())
      for (Series& series : list) series.directions = directions;
    for (const Series& series : list) parse(series.setting);  // before the first bake starts

    const ThreadLimit limit(static_cast<std::size_t>(threads));
    const BakeScene scene = load_bench_scene(asset, mesh_file);
    const Truth truth(scene, reference, static_cast<std::size_t>(sample), threads);
    std::fprintf(stderr, "%zu triangles, %zu receivers, reference of %d directions from %zu of them\n",
                 scene.occluders.mesh.triangles.size(), scene.receivers.slots.size(), reference,
                 truth.transfer().receivers);
    run(scene, list, truth, threads);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_error_time: %s\n", error.what());
    return 1;
  }
  return 0;
}
