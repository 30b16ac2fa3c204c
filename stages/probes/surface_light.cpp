// SPDX-License-Identifier: GPL-3.0-or-later
#include "probes/surface_light.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "raycast/beam_transfer.h"
#include "raycast/gather.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

constexpr double automatic_share = 1e-3;
constexpr std::size_t kept_bytes = 256'000'000;  // of rays, at most

double norm(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) * value;
  return std::sqrt(sum);
}

}  // namespace

SurfaceLight light_surface(const SceneMesh& scene, const ProbesSettings& settings, int seed,
                           const ProgressFunction& progress) {
  SurfaceLight light;
  const int most = settings.bounces.most();
  if (most == 0 || scene.mesh.triangles.empty()) return light;
  light.channels = scene.is_grey() ? 1 : 3;
  light.coefficients = settings.bands * settings.bands;
  light.cache = make_surface_cache(
      scene.mesh, [&](std::uint32_t t, float u, float v) { return scene.albedo_at(t, u, v); }, scene.is_grey(),
      settings.bounce_edge);
  const SurfaceCache& cache = light.cache;
  std::vector<Eigen::Vector3f> directions =
      sample_directions(settings.sampling, settings.directions, static_cast<std::uint64_t>(seed));
  order_coherently(directions, block_directions);
  const RayScene rays(cache.positions, cache.triangles);
  const BeamScene beams(cache.positions, cache.triangles);
  const BeamReceivers receivers(cache.receivers(), rounding_offset(scene.mesh.positions));
  const auto steps = static_cast<std::size_t>(most) + 1;

  // Step 1: light from far away.
  TransferSums direct(cache.size(), light.coefficients);
  RayMemory memory(kept_bytes);
  BlockedRays blocked(memory);
  add_transfer_by_beams(beams, receivers, directions, direct, step_of(progress, 0, steps), &blocked);
  FirstHits hits(memory, receivers.packets.size());
  const TransferVectors far = direct.transfer();
  std::vector<float> last = reflected(cache, light.channels, light.coefficients,
                                      [&](int, int coefficient) { return far.plane(coefficient); });

  // Step 2: light that the surface sends itself. The probes gather the last one sent.
  for (light.bounces = 1;; ++light.bounces) {
    light.add(last);
    const double all = norm(light.values);
    light.last_share = all > 0 ? norm(last) / all : 0;
    const bool is_enough = settings.bounces.automatic && light.last_share < automatic_share;
    if (light.bounces == most || is_enough) return light;
    TransferSums gathered(cache.size(), light.width());
    add_gathered(rays, &beams, receivers, directions, {cache.points, last, static_cast<std::size_t>(light.width())},
                 gathered, step_of(progress, static_cast<std::size_t>(light.bounces), steps), {&blocked, &hits, 0});
    const TransferVectors received = gathered.transfer();
    last = reflected(cache, light.channels, light.coefficients, [&](int channel, int coefficient) {
      return received.plane(channel * light.coefficients + coefficient);
    });
  }
}

}  // namespace kiln
