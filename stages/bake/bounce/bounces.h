// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/bake_settings.h"
#include "bake/engines/gather_engine.h"
#include "bake/engines/transfer_engine.h"
#include "bake/scene/occluders.h"
#include "raycast/known_rays.h"
#include "raycast/surface_cache.h"

namespace kiln {

/// The surface of the occluders, and the same as what gathers light sees of it.
SurfaceCache make_surface_cache(const Occluders& occluders, double longest_edge);
ReflectingSurface surface_of(const SurfaceCache& cache, const Occluders& occluders);

/// What came of bouncing, for the record.
struct BounceReport {
  std::size_t cache_points = 0;
  std::size_t cache_triangles = 0;
  double cache_seconds = 0;     ///< cutting the surface, and the direct transfer of its points
  std::vector<double> energy;   ///< of each bounce: ||t^b|| / ||t^0||, all channels, over a sample of receivers
  std::vector<double> seconds;  ///< of each bounce; the last is that of the receivers themselves
  double floor = 0;             ///< with an automatic count: what storing costs, as a share of all transfer
  bool reached = true;          ///< whether an automatic count came under the floor
  std::string renderer;         ///< what gathered
  std::size_t kept_bytes = 0;   ///< of rays, by receivers and points together
};

/// What the points of a surface send out, one row of channels * coefficients each: their albedo times the transfer of
/// all bounces but a receiver's last.
struct SentLight {
  int channels = 1;
  int coefficients = 0;
  std::vector<float> values;

  int width() const { return channels * coefficients; }
};

/// Some of the receivers, evenly spread, with their direct transfer: the energy of bounces is measured on them.
struct BounceSample {
  std::vector<Eigen::Vector3f> positions, normals;
  TransferVectors direct;

  BounceSample(const Receivers& receivers, const TransferVectors& transfer);
  Receivers receivers() const { return {positions, normals}; }
};

/// What is known of the rays of a surface's points.
struct TracedPoints {
  std::vector<TracedReceivers> points;  ///< empty: nothing is
  RayMemory* memory = nullptr;          ///< for first hits that later bounces find again; null: none are kept
};

/// All of `receivers`, some 100,000 together; nothing is known of their rays.
std::vector<TracedReceivers> untraced(const Receivers& receivers);

/// Bounces light about the surface, so that a single gather at any receiver has all bounces: with t^0 the points'
/// direct transfer, t^b = (1 / pi) integral of max(0, n.s) rho(q) t^(b-1)(q) ds, q what the point sees along s from its
/// front, and the light sent is rho times the sum of t^0 to t^(n-1). `direct` are the points' t^0, bands^2
/// coefficients; `engine` is of the cache's surface. Every bounce casts the same rays: with `traced`, those after the
/// first find theirs as far as they were kept. The report's energy has as many bounces as were taken.
SentLight bounce_light(const SurfaceCache& cache, const TransferVectors& direct, GatherEngine& engine,
                       std::span<const Eigen::Vector3f> directions, const BounceTarget& target, int bits,
                       const BounceSample& sample, BounceReport& report, const ProgressFunction& progress,
                       TracedPoints traced = {});

/// The direct transfer of any number of receivers, which are taken a part at a time, to bound memory. With `traced`,
/// what the engine finds of their rays is kept there.
TransferVectors direct_transfer(TransferEngine& engine, const Receivers& receivers,
                                std::span<const Eigen::Vector3f> directions, int bands,
                                const ProgressFunction& progress, TracedPoints* traced = nullptr);

/// Adds what receivers gather of `light` to `channels`, which are light.channels and have all `receivers`: those of
/// `traced`, by what is known of their rays. They are taken a part at a time.
void add_bounced(GatherEngine& engine, const SentLight& light, const Receivers& receivers,
                 std::span<TracedReceivers> traced, std::span<const Eigen::Vector3f> directions,
                 std::vector<TransferVectors>& channels, const ProgressFunction& progress);

/// The same of all receivers.
void add_bounced(GatherEngine& engine, const SentLight& light, const Receivers& receivers,
                 std::span<const Eigen::Vector3f> directions, std::vector<TransferVectors>& channels,
                 const ProgressFunction& progress);

}  // namespace kiln
