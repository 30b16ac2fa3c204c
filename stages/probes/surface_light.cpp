// SPDX-License-Identifier: GPL-3.0-or-later
#include "probes/surface_light.h"

#include <algorithm>
#include <cmath>

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

/// Returns albedo times transfer, point after point; one channel of transfer may serve for all.
std::vector<float> sent(const SurfaceCache& cache, const TransferVectors& transfer, int channels, int coefficients) {
  std::vector<float> values(cache.size() * static_cast<std::size_t>(channels * coefficients));
  for (int c = 0; c < channels; ++c)
    for (int i = 0; i < coefficients; ++i) {
      const std::span<const float> plane = transfer.plane((c * coefficients + i) % transfer.coefficients);
      for (std::size_t p = 0; p < cache.size(); ++p)
        values[(p * channels + c) * coefficients + i] = cache.point_albedos[p][c] * plane[p];
    }
  return values;
}

}  // namespace

void ProbeScene::add(const TriangleMesh& part, SurfaceAlbedo albedo) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  first_triangles.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
  albedos.push_back(std::move(albedo));
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

bool ProbeScene::grey() const {
  return std::all_of(albedos.begin(), albedos.end(), [](const SurfaceAlbedo& albedo) { return albedo.is_grey(); });
}

Eigen::Vector3f ProbeScene::albedo_at(std::uint32_t triangle, float u, float v) const {
  const auto after = std::upper_bound(first_triangles.begin(), first_triangles.end(), triangle);
  const auto part = static_cast<std::size_t>(after - first_triangles.begin()) - 1;
  return albedos[part].at(triangle - first_triangles[part], u, v);
}

SurfaceLight light_surface(const ProbeScene& scene, const ProbesSettings& settings, int seed,
                           const ProgressFunction& progress) {
  SurfaceLight light;
  const int bounces = settings.bounces.value_or(most_probe_bounces);
  if (bounces == 0 || scene.mesh.triangles.empty()) return light;
  light.channels = scene.grey() ? 1 : 3;
  light.cache = make_surface_cache(
      scene.mesh, [&](std::uint32_t t, float u, float v) { return scene.albedo_at(t, u, v); }, scene.grey(),
      settings.bounce_edge);
  const SurfaceCache& cache = light.cache;
  std::vector<Eigen::Vector3f> directions =
      sample_directions(settings.sampling, settings.directions, static_cast<std::uint64_t>(seed));
  order_coherently(directions, block_directions);
  const RayScene rays(cache.positions, cache.triangles);
  const BeamScene beams(cache.positions, cache.triangles);
  const BeamReceivers receivers(cache.receivers(), rounding_offset(scene.mesh.positions));
  const int coefficients = settings.bands * settings.bands, width = light.channels * coefficients;
  const auto part_done = [&](int part, double fraction) { progress((part + fraction) / (bounces + 1)); };

  // Step 1: light from far away.
  TransferSums direct(cache.size(), coefficients);
  RayMemory memory(kept_bytes);
  BlockedRays blocked(memory);
  add_transfer_by_beams(
      beams, receivers, directions, direct, [&](double fraction) { part_done(0, fraction); }, &blocked);
  FirstHits hits(memory, receivers.packets.size());
  std::vector<float> last = sent(cache, direct.transfer(), light.channels, coefficients);
  light.values.assign(last.size(), 0.f);

  // Step 2: light that the surface sends itself. The probes gather the last one sent.
  for (light.bounces = 1;; ++light.bounces) {
    for (std::size_t k = 0; k < last.size(); ++k) light.values[k] += last[k];
    const double all = norm(light.values);
    light.last_share = all > 0 ? norm(last) / all : 0;
    const bool is_enough = !settings.bounces && light.last_share < automatic_share;
    if (light.bounces == bounces || is_enough) return light;
    TransferSums gathered(cache.size(), width);
    add_gathered(rays, &beams, receivers, directions, {cache.points, last, static_cast<std::size_t>(width)}, gathered,
                 [&](double fraction) { part_done(light.bounces, fraction); }, {&blocked, &hits, 0});
    last = sent(cache, gathered.transfer(), light.channels, coefficients);
  }
}

}  // namespace kiln
