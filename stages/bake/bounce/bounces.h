// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/bake_reports.h"
#include "bake/bake_settings.h"
#include "bake/engines/gather_engine.h"
#include "bake/engines/transfer_engine.h"
#include "bake/scene/occluders.h"
#include "base/progress.h"
#include "raycast/known_rays.h"
#include "raycast/sent_light.h"
#include "raycast/surface_cache.h"

namespace kiln {

/// Returns the surface of the occluders, cut and with points.
SurfaceCache make_surface_cache(const Occluders& occluders, double longest_edge);

/// Returns the reflectances of the points of that surface at three wavelengths of the occluders', from `first` on.
std::vector<Eigen::Vector3f> point_reflectances(const Occluders& occluders, double longest_edge, std::size_t first);

/// Returns the same surface for an engine that gathers.
ReflectingSurface surface_of(const SurfaceCache& cache, const Occluders& occluders);

/// Receivers, some of all and evenly spread, with their direct transfer: the energy of bounces is measured on them.
struct BounceSample {
  std::vector<Eigen::Vector3f> positions, normals;
  TransferVectors direct;

  BounceSample(const Receivers& receivers, const TransferVectors& transfer);
  Receivers receivers() const { return {positions, normals}; }
};

/// Rays of a surface's points that are known.
struct TracedPoints {
  std::vector<TracedReceivers> points;  ///< empty: nothing is known
  RayMemory* memory = nullptr;          ///< room for first hits that later bounces find again; null: none
  bool has_hits = false;                ///< whether first hits of earlier bounces are among what is known
};

/// Returns all of `receivers` in slabs of some 100,000, with nothing known of their rays.
std::vector<TracedReceivers> untraced(const Receivers& receivers);

/// How light bounces: along which directions, how often, and the bits whose quantisation error ends automatic bounces.
struct BouncePlan {
  std::span<const Eigen::Vector3f> directions;
  BounceTarget target;
  int bits = 8;
};

/// Bounces light about the surface, so that a single gather at any receiver has all bounces: with t^0 the points'
/// direct transfer, t^b = (1 / pi) integral of max(0, n.s) rho(q) t^(b-1)(q) ds, q what the point sees along s from its
/// front, and the light sent is rho times the sum of t^0 to t^(n-1). `direct` are the points' t^0, bands^2
/// coefficients; `engine` is of the cache's surface. Every bounce casts the same rays: with `traced`, those after the
/// first find theirs as far as they were kept, as does further light off the same surface. The report's energy has as
/// many bounces as were taken.
SentLight bounce_light(const SurfaceCache& cache, const TransferVectors& direct, GatherEngine& engine,
                       const BouncePlan& plan, const BounceSample& sample, BounceReport& report,
                       const ProgressFunction& progress, TracedPoints& traced);

/// Returns the direct transfer of any number of receivers, taken a part at a time to bound memory. Keeps in `traced`,
/// if given, the rays that the engine finds blocked.
TransferVectors direct_transfer(TransferEngine& engine, const Receivers& receivers,
                                std::span<const Eigen::Vector3f> directions, int bands,
                                const ProgressFunction& progress, TracedPoints* traced = nullptr);

/// Adds what the receivers of `traced` gather of `light` to `channels`, light.channels of all `receivers`, by what is
/// known of their rays. They are taken a part at a time.
void add_bounced(GatherEngine& engine, const SentLight& light, const Receivers& receivers,
                 std::span<TracedReceivers> traced, std::span<const Eigen::Vector3f> directions,
                 std::vector<TransferVectors>& channels, const ProgressFunction& progress);

/// Adds the same for all receivers.
void add_bounced(GatherEngine& engine, const SentLight& light, const Receivers& receivers,
                 std::span<const Eigen::Vector3f> directions, std::vector<TransferVectors>& channels,
                 const ProgressFunction& progress);

}  // namespace kiln
