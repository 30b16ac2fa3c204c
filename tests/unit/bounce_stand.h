// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "bake/backends.h"
#include "bake/bake.h"
#include "bake/bounce/bounces.h"
#include "base/progress.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

/// Turns a mesh inside out.
inline TriangleMesh inverted(TriangleMesh mesh) {
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
  return mesh;
}

/// A scene with bounces, and receivers in it.
struct BounceStand {
  Occluders occluders;
  std::vector<Eigen::Vector3f> positions, normals;
  BakeBackend backend = BakeBackend::embree;
  BakeSettings settings = [] {
    BakeSettings own;
    own.bands = 1;
    own.gl_device = "software";
    return own;
  }();
  std::vector<Eigen::Vector3f> directions = [] {
    std::vector<Eigen::Vector3f> all = sample_directions(Sampling::fibonacci, 1024, 1);
    order_coherently(all, block_directions);
    return all;
  }();

  Receivers receivers() const { return {positions, normals}; }

  /// Computes what the receivers get from the bounces alone, given the direct transfer `direct` of the surface (one row
  /// for each point of the cache); the report goes to `report`.
  std::vector<TransferVectors> bounced(const SurfaceCache& cache, const TransferVectors& direct,
                                       const BounceTarget& target, BounceReport& report,
                                       const TransferVectors& receivers_direct) const {
    const std::unique_ptr<GatherEngine> engine = make_gather_engine(backend, surface_of(cache, occluders), settings, 2);
    TracedPoints unknown;
    const SentLight light = bounce_light(cache, direct, *engine, {directions, target, settings.bits},
                                         BounceSample(receivers(), receivers_direct), report, no_progress, unknown);
    std::vector<TransferVectors> channels(light.channels, TransferVectors(positions.size(), direct.coefficients));
    add_bounced(*engine, light, receivers(), directions, channels, no_progress);
    return channels;
  }

  /// Bakes the receivers, direct light and bounces.
  BakeResult bake(int seed = 1) const {
    ReceiverSet set{static_cast<int>(positions.size()), 1, {}, positions, normals};
    for (std::uint32_t r = 0; r < positions.size(); ++r) set.slots.push_back(r);
    BakeSettings own = settings;
    own.backend = backend;
    return kiln::bake({set, occluders, own, seed, 2});
  }
};

}  // namespace kiln
