// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bounce/bounced_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/backends.h"
#include "base/progress.h"
#include "base/stopwatch.h"

namespace kiln {

namespace {

constexpr double lit_share = 0.3;      // share of the surface's progress that direct light takes
constexpr double surface_share = 0.5;  // share of all progress that the surface takes
constexpr std::size_t at_a_time = 3;   // wavelengths, as many as the engines have colours

/// Surface that direct light has reached, and the engine that gathers what it reflects.
class LitSurface {
 public:
  LitSurface(const BakeJob& job, BakeBackend backend, std::unique_ptr<TransferEngine> direct,
             std::span<const Eigen::Vector3f> directions, BounceReport& report, const ProgressFunction& progress)
      : job_(job),
        directions_(directions),
        cache_(make_surface_cache(job.occluders, job.settings.bounce_edge)),
        memory_(bounce_memory_share(job.settings)),
        traced_{{}, &memory_} {
    transfer_ = direct_transfer(*direct, cache_.receivers(), directions, job.settings.bands, progress, &traced_);
    direct.reset();
    report.cache_points = cache_.size();
    report.cache_triangles = cache_.triangles.size();
    report.cache_seconds = stopwatch_.seconds();
    engine_ = make_gather_engine(backend, surface_of(cache_, job.occluders), job.settings, job.threads);
  }

  GatherEngine& engine() { return *engine_; }

  /// Lets light bounce, as red, green and blue, or as one channel where all is grey.
  SentLight bounce(const BounceSample& sample, BounceReport& report, const ProgressFunction& progress) {
    const BakeSettings& settings = job_.settings;
    SentLight light = bounce_light(cache_, transfer_, *engine_, {directions_, settings.bounces, settings.bits}, sample,
                                   report, progress, traced_);
    report.kept_bytes = bounce_memory_share(settings) - memory_.left();
    return light;
  }

  /// Lets light bounce at three wavelengths from `first` on.
  SentLight bounce_at(std::size_t first, const BounceSample& sample, BounceReport& report,
                      const ProgressFunction& progress) {
    cache_.point_albedos = point_reflectances(job_.occluders, job_.settings.bounce_edge, first);
    cache_.grey = false;
    return bounce(sample, report, progress);
  }

  /// Keeps no more of the cut surface than the engine holds.
  void forget() {
    cache_ = {};
    traced_ = {};
    transfer_ = TransferVectors(0, transfer_.coefficients);
  }

 private:
  const Stopwatch stopwatch_;
  const BakeJob& job_;
  std::span<const Eigen::Vector3f> directions_;
  SurfaceCache cache_;
  RayMemory memory_;
  TracedPoints traced_;
  TransferVectors transfer_{0, 0};  ///< direct, of the cache's points
  std::unique_ptr<GatherEngine> engine_;
};

/// Adds what three wavelengths report to what all do: `before` of them were added.
void add_to(BounceReport& all, const BounceReport& some, std::size_t before) {
  const std::size_t bounces = std::max(all.energy.size(), some.energy.size());
  all.energy.resize(bounces, 0);
  all.seconds.resize(bounces, 0);
  const auto count = static_cast<double>(before);
  for (std::size_t b = 0; b < bounces; ++b) {
    const double own = b < some.energy.size() ? some.energy[b] : 0;
    all.energy[b] = std::sqrt((all.energy[b] * all.energy[b] * count + own * own) / (count + 1));
    all.seconds[b] += b < some.seconds.size() ? some.seconds[b] : 0;
  }
  all.floor = std::max(all.floor, some.floor);
  all.reached = all.reached && some.reached;
  all.renderer = some.renderer;
  all.kept_bytes = some.kept_bytes;
}

/// Adds bounced light at each wavelength of the occluders' reflectance to the direct transfer; one channel becomes as
/// many as wavelengths.
void add_wavelengths(const BakeJob& job, LitSurface& surface, const BounceDirections& directions,
                     std::span<TracedReceivers> traced, std::vector<TransferVectors>& channels, BounceReport& report,
                     const ProgressFunction& progress) {
  const Receivers receivers = job.receivers.view();
  const std::size_t wavelengths = job.occluders.reflectance->wavelengths();
  const std::size_t rounds = (wavelengths + at_a_time - 1) / at_a_time;
  const TransferVectors direct = std::move(channels.front());
  const BounceSample sample(receivers, direct);
  channels.clear();
  for (std::size_t round = 0; round < rounds; ++round) {
    const ProgressFunction part = step_of(progress, round, rounds);
    BounceReport own;
    const SentLight light = surface.bounce_at(at_a_time * round, sample, own, part_of(part, 0, surface_share));
    const Stopwatch stopwatch;
    std::vector<TransferVectors> three(at_a_time, direct);
    add_bounced(surface.engine(), light, receivers, traced, directions.receivers, three,
                part_of(part, surface_share, 1));
    if (!own.seconds.empty()) own.seconds.back() += stopwatch.seconds();
    add_to(report, own, round);
    for (TransferVectors& channel : three)
      if (channels.size() < wavelengths) channels.push_back(std::move(channel));
  }
}

}  // namespace

std::size_t bounce_memory_share(const BakeSettings& settings) {
  return static_cast<std::size_t>(settings.bounce_memory) * 1'000'000 / 2;
}

BounceReport add_bounced_light(const BakeJob& job, BakeBackend backend, std::unique_ptr<TransferEngine> direct,
                               const BounceDirections& directions, std::span<TracedReceivers> traced,
                               std::vector<TransferVectors>& channels, const ProgressFunction& progress) {
  BounceReport report;
  LitSurface surface(job, backend, std::move(direct), directions.surface, report,
                     part_of(progress, 0, lit_share * surface_share));
  if (job.occluders.reflectance) {
    add_wavelengths(job, surface, directions, traced, channels, report,
                    part_of(progress, lit_share * surface_share, 1));
    return report;
  }
  const Receivers receivers = job.receivers.view();
  const SentLight light = surface.bounce(BounceSample(receivers, channels.front()), report,
                                         part_of(progress, lit_share * surface_share, surface_share));
  surface.forget();
  const Stopwatch stopwatch;
  channels.resize(static_cast<std::size_t>(light.channels), channels.front());
  add_bounced(surface.engine(), light, receivers, traced, directions.receivers, channels,
              part_of(progress, surface_share, 1));
  if (!report.seconds.empty()) report.seconds.back() += stopwatch.seconds();
  return report;
}

}  // namespace kiln
