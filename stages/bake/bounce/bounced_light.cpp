// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bounce/bounced_light.h"

#include <utility>

#include "bake/backends.h"
#include "base/progress.h"
#include "base/stopwatch.h"

namespace kiln {

namespace {

constexpr double lit_share = 0.3;      // share of the surface's progress that direct light takes
constexpr double surface_share = 0.5;  // share of all progress that the surface takes

/// Surface whose light has bounced, and the engine that gathers it.
struct LitSurface {
  SentLight light;
  std::unique_ptr<GatherEngine> engine;
};

/// Lights the surface of the job's occluders and lets light bounce off it. Of the cut surface only what
/// the engine holds stays in memory.
LitSurface light_surface(const BakeJob& job, BakeBackend backend, std::unique_ptr<TransferEngine> direct,
                         std::span<const Eigen::Vector3f> directions, const BounceSample& sample, BounceReport& report,
                         const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  const BakeSettings& settings = job.settings;
  const SurfaceCache cache = make_surface_cache(job.occluders, settings.bounce_edge);
  RayMemory memory(bounce_memory_share(settings));
  TracedPoints traced{{}, &memory};
  const TransferVectors transfer =
      direct_transfer(*direct, cache.receivers(), directions, settings.bands, part_of(progress, 0, lit_share), &traced);
  direct.reset();
  report.cache_points = cache.size();
  report.cache_triangles = cache.triangles.size();
  report.cache_seconds = stopwatch.seconds();

  LitSurface surface;
  surface.engine = make_gather_engine(backend, surface_of(cache, job.occluders), settings, job.threads);
  surface.light = bounce_light(cache, transfer, *surface.engine, {directions, settings.bounces, settings.bits}, sample,
                               report, part_of(progress, lit_share, 1), std::move(traced));
  report.kept_bytes = bounce_memory_share(settings) - memory.left();
  return surface;
}

}  // namespace

std::size_t bounce_memory_share(const BakeSettings& settings) {
  return static_cast<std::size_t>(settings.bounce_memory) * 1'000'000 / 2;
}

BounceReport add_bounced_light(const BakeJob& job, BakeBackend backend, std::unique_ptr<TransferEngine> direct,
                               const BounceDirections& directions, std::span<TracedReceivers> traced,
                               std::vector<TransferVectors>& channels, const ProgressFunction& progress) {
  BounceReport report;
  const Receivers receivers = job.receivers.view();
  const LitSurface surface =
      light_surface(job, backend, std::move(direct), directions.surface, BounceSample(receivers, channels.front()),
                    report, part_of(progress, 0, surface_share));
  const Stopwatch stopwatch;
  channels.resize(static_cast<std::size_t>(surface.light.channels), channels.front());
  add_bounced(*surface.engine, surface.light, receivers, traced, directions.receivers, channels,
              part_of(progress, surface_share, 1));
  if (!report.seconds.empty()) report.seconds.back() += stopwatch.seconds();
  return report;
}

}  // namespace kiln
