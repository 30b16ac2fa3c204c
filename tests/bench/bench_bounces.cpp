// SPDX-License-Identifier: GPL-3.0-or-later
// Times bounces beside the direct bake of the same backend, over the same directions: CPU seconds, and ratios.
//
//   bench_bounces ASSET HIGH [--backend beams embree egl] [--directions N] [--bands N] [--shadow-size N]
//                            [--bounce-memory MB]
//
// ASSET is a folder of `kiln build`. HIGH reflects with a coloured albedo: three channels.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bake/backends.h"
#include "bake/bounce/bounced_light.h"
#include "base/progress.h"
#include "bench_scene.h"
#include "cost.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {
namespace {

void measure(const BakeScene& scene, const BakeSettings& settings, BakeBackend backend) {
  std::vector<Eigen::Vector3f> directions = sample_directions(settings.sampling, settings.directions, 1);
  order_coherently(directions, block_directions);
  const Receivers texels = scene.receivers.view();

  // Step 1: direct transfer of the texels and of the points that light bounces off; what it finds of rays is kept.
  const std::size_t share = bounce_memory_share(settings);
  RayMemory texel_memory(share), point_memory(share);
  TracedPoints of_texels{{}, &texel_memory}, of_points{{}, &point_memory};
  TransferVectors transfer, at_points;
  SurfaceCache cache;
  Cost direct, points;
  {
    const std::unique_ptr<TransferEngine> engine = make_engine(backend, scene.occluders, settings, 0);
    direct = cost_of(
        [&] { transfer = direct_transfer(*engine, texels, directions, settings.bands, no_progress, &of_texels); });
    points = cost_of([&] {
      cache = make_surface_cache(scene.occluders, settings.bounce_edge);
      at_points = direct_transfer(*engine, cache.receivers(), directions, settings.bands, no_progress, &of_points);
    });
  }

  // Step 2: one bounce at the texels, and two among the points, each at the cost of a further bounce: the first finds
  // what rays hit, the second reuses it.
  const std::unique_ptr<GatherEngine> engine =
      make_gather_engine(backend, surface_of(cache, scene.occluders), settings, 0);
  SentLight light{3, at_points.coefficients, std::vector<float>(cache.size() * 3 * at_points.coefficients)};
  for (std::size_t p = 0; p < cache.size(); ++p)
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < light.coefficients; ++i)
        light.values[(p * 3 + c) * light.coefficients + i] = cache.point_albedos[p][c] * at_points.plane(i)[p];
  std::vector<TransferVectors> channels(3, transfer), of_surface(3, at_points);
  const Cost gather =
      cost_of([&] { add_bounced(*engine, light, texels, of_texels.points, directions, channels, no_progress); });
  for (TracedReceivers& slab : of_points.points) slab.hits = FirstHits(point_memory, slab.packets());
  Cost more[2];
  for (Cost& one : more)
    one = cost_of(
        [&] { add_bounced(*engine, light, cache.receivers(), of_points.points, directions, of_surface, no_progress); });

  const std::size_t kept[2] = {share - texel_memory.left(), share - point_memory.left()};
  std::printf("| %s | %.2f | %.2f | %.2f | **%.2f** | %.2f | %.2f | **%.2f** | %.0f, %.0f |\n",
              backend_name(backend).c_str(), direct.cpu, points.cpu, gather.cpu, (points.cpu + gather.cpu) / direct.cpu,
              more[0].cpu, more[1].cpu, more[1].cpu / direct.cpu, 1e-6 * static_cast<double>(kept[0]),
              1e-6 * static_cast<double>(kept[1]));
  std::fflush(stdout);
}

}  // namespace
}  // namespace kiln

int main(int argc, char** argv) {
  CLI::App app("What a bounce costs");
  std::filesystem::path asset, high;
  std::vector<std::string> backends = {"beams", "embree", "egl"};
  kiln::BakeSettings settings;
  app.add_option("ASSET", asset)->required();
  app.add_option("HIGH", high)->required();
  app.add_option("--backend", backends);
  app.add_option("--directions", settings.directions);
  app.add_option("--bands", settings.bands);
  app.add_option("--shadow-size", settings.shadow_size);
  app.add_option("--bounce-memory", settings.bounce_memory);
  CLI11_PARSE(app, argc, argv);

  kiln::BakeScene scene = kiln::load_bench_scene(asset, high);
  scene.occluders.albedos = {kiln::SurfaceAlbedo::constant({0.8f, 0.6f, 0.4f})};
  std::printf("%zu texels, %d directions, %d coefficients, 3 channels; CPU seconds\n\n", scene.receivers.slots.size(),
              settings.directions, kiln::coefficient_count(settings.bands));
  std::printf(
      "| backend | direct | the points' direct | gather at texels | bounce 1 / direct | first gather at points | next "
      "| "
      "each bounce more / direct | MB kept: texels, points |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- "
      "|\n");
  for (const std::string& name : backends) {
    kiln::BakeSettings own = settings;
    kiln::bake_options(own).find("backend")->set(name);
    kiln::measure(scene, own, own.backend);
  }
}
