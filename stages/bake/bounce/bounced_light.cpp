// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bounce/bounced_light.h"

#include "bake/backends.h"
#include "base/stopwatch.h"

namespace kiln {

namespace {

constexpr double cache_share = 0.3;  // of the progress

}  // namespace

std::size_t bounce_memory_share(const BakeSettings& settings) {
  return static_cast<std::size_t>(settings.bounce_memory) * 1'000'000 / 2;
}

BouncedLight::BouncedLight(std::unique_ptr<TransferEngine> direct, BakeBackend backend, const Occluders& occluders,
                           std::span<const Eigen::Vector3f> directions, const BakeSettings& settings, int threads,
                           const BounceTarget& target, const BounceSample& sample, const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  const SurfaceCache cache = make_surface_cache(occluders, settings.bounce_edge);
  RayMemory memory(bounce_memory_share(settings));
  TracedPoints traced{{}, &memory};
  const TransferVectors transfer = direct_transfer(
      *direct, cache.receivers(), directions, settings.bands,
      [&](double fraction) { progress(cache_share * fraction); }, &traced);
  direct.reset();
  report_.cache_points = cache.size();
  report_.cache_triangles = cache.triangles.size();
  report_.cache_seconds = stopwatch.seconds();
  engine_ = make_gather_engine(backend, surface_of(cache, occluders), settings, threads);
  light_ = bounce_light(
      cache, transfer, *engine_, directions, target, settings.bits, sample, report_,
      [&](double fraction) { progress(cache_share + (1 - cache_share) * fraction); }, std::move(traced));
  report_.kept_bytes = bounce_memory_share(settings) - memory.left();
}

BounceReport BouncedLight::add_to(std::vector<TransferVectors>& channels, const Receivers& receivers,
                                  std::span<TracedReceivers> traced, std::span<const Eigen::Vector3f> directions,
                                  const ProgressFunction& progress) const {
  const Stopwatch stopwatch;
  add_bounced(*engine_, light_, receivers, traced, directions, channels, progress);
  BounceReport report = report_;
  if (!report.seconds.empty()) report.seconds.back() += stopwatch.seconds();
  return report;
}

}  // namespace kiln
