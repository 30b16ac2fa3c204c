// SPDX-License-Identifier: GPL-3.0-or-later
// Transfer bounces as radiance does, because it is linear in the light ([Sloan 2002], section 5). It is
// gathered at points of the surface bounce after bounce, and at the receivers once: a final gather, as for radiosity
// [Lischinski 1993].
#include "bake/bounce/bounces.h"

#include <algorithm>
#include <cmath>

#include "bake/planes/quantisation_floor.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "raycast/beam_transfer.h"
#include "sh/basis.h"

namespace kiln {

namespace {

constexpr std::size_t sample_receivers = 4096;
constexpr std::size_t slab_receivers = 1u << 17;

/// Calls visit(first, part, fraction of progress) for parts of the receivers.
template <class Visit>
void for_each_slab(const Receivers& receivers, const ProgressFunction& progress, const Visit& visit) {
  const auto all = static_cast<double>(receivers.size());
  for (std::size_t first = 0; first < receivers.size(); first += slab_receivers) {
    const std::size_t count = std::min(slab_receivers, receivers.size() - first);
    visit(first, Receivers{receivers.positions.subspan(first, count), receivers.normals.subspan(first, count)},
          part_of(progress, static_cast<double>(first) / all, static_cast<double>(first + count) / all));
  }
}

/// Returns the receivers of a slab that starts at `first`, in packets.
TracedReceivers slab_of(std::size_t first, const Receivers& part) {
  TracedReceivers slab;
  slab.order = packet_order(part);
  for (std::uint32_t& receiver : slab.order) receiver += static_cast<std::uint32_t>(first);
  return slab;
}

/// Adds what some of the receivers gather to channel after channel: whole packets from order[first] on.
void add_part(GatherEngine& engine, const Receivers& receivers, TracedReceivers& traced, std::size_t first,
              std::size_t count, std::span<const Eigen::Vector3f> directions, std::vector<TransferVectors>& channels,
              const ProgressFunction& progress) {
  std::vector<Eigen::Vector3f> positions(count), normals(count);
  for (std::size_t k = 0; k < count; ++k) {
    positions[k] = receivers.positions[traced.order[first + k]];
    normals[k] = receivers.normals[traced.order[first + k]];
  }
  const KnownRays known{&traced.blocked, &traced.hits, first / beam_lanes};
  const TransferVectors planes = engine.gather_known({positions, normals}, directions, known, progress).transfer();
  const int coefficients = channels.front().coefficients;
  for (int i = 0; i < planes.coefficients; ++i) {
    const std::span<const float> from = planes.plane(i);
    const std::span<float> to = channels[i / coefficients].plane(i % coefficients);
    for (std::size_t k = 0; k < count; ++k) to[traced.order[first + k]] += from[k];
  }
}

/// Adds what receivers gather to channel after channel.
void add_gathered(GatherEngine& engine, const Receivers& receivers, std::span<TracedReceivers> traced,
                  std::span<const Eigen::Vector3f> directions, std::vector<TransferVectors>& channels,
                  const ProgressFunction& progress) {
  std::size_t done = 0;
  double all = 0;
  for (const TracedReceivers& slab : traced) all += static_cast<double>(slab.order.size());
  const std::size_t most = engine.most_receivers() / beam_lanes * beam_lanes;
  for (TracedReceivers& slab : traced)
    for (std::size_t first = 0; first < slab.order.size(); first += most) {
      const std::size_t count = std::min(most, slab.order.size() - first);
      add_part(engine, receivers, slab, first, count, directions, channels,
               part_of(progress, static_cast<double>(done) / all, static_cast<double>(done + count) / all));
      done += count;
    }
}

/// Returns what all receivers gather, channel after channel.
std::vector<TransferVectors> gathered(GatherEngine& engine, int channels, int coefficients, const Receivers& receivers,
                                      std::span<TracedReceivers> traced, std::span<const Eigen::Vector3f> directions,
                                      const ProgressFunction& progress) {
  std::vector<TransferVectors> result(channels, TransferVectors(receivers.size(), coefficients));
  add_gathered(engine, receivers, traced, directions, result, progress);
  return result;
}

/// Returns what the points of `cache` send out of channel after channel; one channel may serve for all.
std::vector<float> reflected(const SurfaceCache& cache, const std::vector<TransferVectors>& transfer, int channels) {
  return reflected(cache, channels, transfer.front().coefficients, [&](int channel, int coefficient) {
    return transfer[std::min(static_cast<std::size_t>(channel), transfer.size() - 1)].plane(coefficient);
  });
}

/// Makes the engine keep first hits from the next pass on.
void keep_hits(std::span<TracedReceivers> traced, RayMemory* memory) {
  if (memory == nullptr) return;
  for (TracedReceivers& slab : traced) slab.hits = FirstHits(*memory, slab.packets());
}

double squared_norm(const std::vector<TransferVectors>& channels) {
  double sum = 0;
  for (const TransferVectors& channel : channels)
    for (float value : channel.values) sum += static_cast<double>(value) * value;
  return sum;
}

void add(std::vector<TransferVectors>& sums, const std::vector<TransferVectors>& more) {
  for (std::size_t c = 0; c < sums.size(); ++c)
    for (std::size_t k = 0; k < sums[c].values.size(); ++k) sums[c].values[k] += more[c].values[k];
}

}  // namespace

SurfaceCache make_surface_cache(const Occluders& occluders, double longest_edge) {
  const auto albedo_at = [&](std::uint32_t triangle, float u, float v) { return occluders.albedo_at(triangle, u, v); };
  return make_surface_cache(occluders.mesh, albedo_at, occluders.is_grey(), longest_edge);
}

std::vector<Eigen::Vector3f> point_reflectances(const Occluders& occluders, double longest_edge, std::size_t first) {
  const auto at = [&](std::uint32_t triangle, float u, float v) {
    return occluders.reflectance->at(occluders, triangle, u, v, first);
  };
  return make_surface_cache(occluders.mesh, at, false, longest_edge).point_albedos;
}

ReflectingSurface surface_of(const SurfaceCache& cache, const Occluders& occluders) {
  return {cache.positions,          cache.triangles, cache.points,    occluders.mesh.positions,
          occluders.mesh.triangles, occluders.hull,  occluders.closed};
}

std::vector<TracedReceivers> untraced(const Receivers& receivers) {
  std::vector<TracedReceivers> all;
  for_each_slab(receivers, no_progress, [&](std::size_t first, const Receivers& part, const ProgressFunction&) {
    all.push_back(slab_of(first, part));
  });
  return all;
}

BounceSample::BounceSample(const Receivers& receivers, const TransferVectors& transfer)
    : direct(std::min(sample_receivers, receivers.size()), transfer.coefficients) {
  for (std::size_t k = 0; k < direct.receivers; ++k) {
    const std::size_t r = k * receivers.size() / direct.receivers;
    positions.push_back(receivers.positions[r]);
    normals.push_back(receivers.normals[r]);
    for (int i = 0; i < transfer.coefficients; ++i) direct.plane(i)[k] = transfer.plane(i)[r];
  }
}

TransferVectors direct_transfer(TransferEngine& engine, const Receivers& receivers,
                                std::span<const Eigen::Vector3f> directions, int bands,
                                const ProgressFunction& progress, TracedPoints* traced) {
  TransferVectors result(receivers.size(), coefficient_count(bands));
  engine.keep_blocked(traced != nullptr ? traced->memory : nullptr);
  for_each_slab(receivers, progress, [&](std::size_t first, const Receivers& part, const ProgressFunction& partly) {
    engine.set_receivers(part, bands);
    engine.add(directions, partly);
    const TransferVectors own = engine.sums().transfer();
    for (int i = 0; i < own.coefficients; ++i)
      std::copy(own.plane(i).begin(), own.plane(i).end(), result.plane(i).begin() + static_cast<std::ptrdiff_t>(first));
    if (traced == nullptr) return;
    traced->points.push_back(slab_of(first, part));
    traced->points.back().blocked = engine.take_blocked();
  });
  engine.keep_blocked(nullptr);
  return result;
}

SentLight bounce_light(const SurfaceCache& cache, const TransferVectors& direct, GatherEngine& engine,
                       const BouncePlan& plan, const BounceSample& sample, BounceReport& report,
                       const ProgressFunction& progress, TracedPoints& traced) {
  SentLight light{cache.grey ? 1 : 3, direct.coefficients, {}};
  const auto& [directions, target, bits] = plan;
  const int most = target.most();
  const double direct_norm = std::sqrt(light.channels * squared_norm({sample.direct}));
  std::vector<TransferVectors> sample_total(light.channels, sample.direct);
  std::vector<float> bounced = reflected(cache, {direct}, light.channels);
  report.reached = !target.automatic;
  if (traced.points.empty()) traced.points = untraced(cache.receivers());
  std::vector<TracedReceivers> traced_sample = untraced(sample.receivers());
  if (most > 1) keep_hits(traced_sample, traced.memory);
  if (most > 2 && !traced.has_hits) keep_hits(traced.points, traced.memory);
  traced.has_hits = most > 2;
  for (int bounce = 1; bounce <= most; ++bounce) {
    const Stopwatch stopwatch;
    engine.set_radiance(bounced, light.width());
    // Step 1: add this bounce's light.
    const std::vector<TransferVectors> added = gathered(engine, light.channels, light.coefficients, sample.receivers(),
                                                        traced_sample, directions, no_progress);
    const double norm = std::sqrt(squared_norm(added));
    if (target.automatic) {
      report.floor = quantisation_floor(sample_total, bits);
      report.reached = norm <= report.floor * std::sqrt(squared_norm(sample_total));
      if (report.reached) break;
    }
    add(sample_total, added);
    report.energy.push_back(direct_norm > 0 ? norm / direct_norm : 0);
    light.add(bounced);
    // Step 2: gather the next bounce. The last of a fixed count is gathered by the receivers.
    if (bounce < most)
      bounced =
          reflected(cache,
                    gathered(engine, light.channels, light.coefficients, cache.receivers(), traced.points, directions,
                             step_of(progress, static_cast<std::size_t>(bounce - 1), static_cast<std::size_t>(most))),
                    light.channels);
    report.seconds.push_back(stopwatch.seconds());
  }
  report.renderer = engine.renderer();
  return light;
}

void add_bounced(GatherEngine& engine, const SentLight& light, const Receivers& receivers,
                 std::span<TracedReceivers> traced, std::span<const Eigen::Vector3f> directions,
                 std::vector<TransferVectors>& channels, const ProgressFunction& progress) {
  if (light.values.empty()) return;
  engine.set_radiance(light.values, light.width());
  add_gathered(engine, receivers, traced, directions, channels, progress);
}

void add_bounced(GatherEngine& engine, const SentLight& light, const Receivers& receivers,
                 std::span<const Eigen::Vector3f> directions, std::vector<TransferVectors>& channels,
                 const ProgressFunction& progress) {
  std::vector<TracedReceivers> traced = untraced(receivers);
  add_bounced(engine, light, receivers, traced, directions, channels, progress);
}

}  // namespace kiln
