// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/gather.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <vector>

#include "raycast/packet_workers.h"
#include "raycast/vector_width.h"

namespace kiln {

namespace {

static_assert(RayScene::PacketHits::lanes == beam_lanes);

/// Computes sum[i] += a[i] * wa + b[i] * wb + c[i] * wc.
KILN_ANY_VECTOR_WIDTH void add_weighted(const float* a, const float* b, const float* c, float wa, float wb, float wc,
                                        float* __restrict sum, std::size_t width) {
  for (std::size_t i = 0; i < width; ++i) sum[i] += a[i] * wa + b[i] * wb + c[i] * wc;
}

/// Moves a block's sums to the totals.
KILN_ANY_VECTOR_WIDTH void move_block(float* __restrict sums, std::int64_t* __restrict totals, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    totals[k] += to_fixed_point(sums[k]);
    sums[k] = 0;
  }
}

/// One thread's packet: sums of the block and of all blocks, receiver after receiver.
struct Worker {
  std::vector<BeamTracer> tracer;  // one tracer, or none
  bool has_begun = false;          // whether the packet's beams have begun
  FirstHits::Packet block, packet;
  std::vector<float> sums;
  std::vector<std::int64_t> totals;
};

/// Computes max(0, n.s) of a packet's receivers; returns the bits of those above 0.
KILN_ANY_VECTOR_WIDTH std::uint32_t face(const BeamPacket& packet, const Eigen::Vector3f& direction,
                                         float (&cosines)[beam_lanes]) {
  const float x = direction.x(), y = direction.y(), z = direction.z();
  for (int lane = 0; lane < beam_lanes; ++lane)
    cosines[lane] = packet.normal[0][lane] * x + packet.normal[1][lane] * y + packet.normal[2][lane] * z;
  std::uint32_t facing = 0;
  for (int lane = 0; lane < beam_lanes; ++lane) facing |= (cosines[lane] > 0 ? 1u : 0u) << lane;
  return facing;
}

/// Arguments of one call to add_gathered; the same for all threads.
class Gathering {
 public:
  Gathering(const RayScene& scene, const BeamScene* beams, const BeamReceivers& receivers,
            std::span<const Eigen::Vector3f> directions, const SurfaceRadiance& radiance, const KnownRays& known)
      : scene_(scene),
        beams_(beams),
        receivers_(receivers),
        directions_(directions),
        radiance_(radiance),
        known_(known) {
    for (std::size_t d = 0; d < directions.size(); d += block_directions)
      blocks_.emplace_back(directions.subspan(d, std::min<std::size_t>(block_directions, directions.size() - d)));
  }

  Worker worker() const {
    const std::size_t sums = beam_lanes * radiance_.width;
    return {{}, false, {}, {}, std::vector<float>(sums, 0.f), std::vector<std::int64_t>(sums)};
  }

  /// Sums the light that a packet receives, in worker.totals.
  void gather(std::size_t packet, Worker& worker) const;

 private:
  /// Finds the rays of a block that may hit something.
  BlockLanes candidates(std::size_t packet, std::size_t block, Worker& worker) const;
  /// Casts the rays of a block; worker.block holds the hits.
  void find(std::size_t packet, std::size_t block, Worker& worker) const;
  /// Adds the light from the hits of a block. `hit` is the first of them, and becomes the one after the last.
  void sum(std::size_t packet, std::span<const FirstHits::Rays> rays, const FirstHits::Hit*& hit, Worker& worker) const;

  const RayScene& scene_;
  const BeamScene* beams_;
  const BeamReceivers& receivers_;
  std::span<const Eigen::Vector3f> directions_;
  const SurfaceRadiance& radiance_;
  const KnownRays& known_;
  std::vector<BeamBlock> blocks_;
};

BlockLanes Gathering::candidates(std::size_t packet, std::size_t block, Worker& worker) const {
  if (known_.blocked != nullptr)
    if (const BlockLanes* lanes = known_.blocked->find(known_.first_packet + packet, block)) return *lanes;
  if (beams_ == nullptr) {
    BlockLanes all;
    all.fill(0xffff);
    return all;
  }
  if (worker.tracer.empty()) worker.tracer.emplace_back(*beams_);
  if (!worker.has_begun) worker.tracer[0].begin(receivers_.packets[packet]);
  worker.has_begun = true;
  BeamWeights weights;
  worker.tracer[0].trace(blocks_[block], weights);
  return blocked_lanes(weights);
}

void Gathering::find(std::size_t packet_index, std::size_t block, Worker& worker) const {
  const BeamPacket& packet = receivers_.packets[packet_index];
  const std::size_t count = std::min<std::size_t>(beam_lanes, receivers_.order.size() - packet_index * beam_lanes);
  const std::uint32_t own_lanes = (1u << count) - 1;
  const BlockLanes lanes = candidates(packet_index, block, worker);
  worker.block.clear();
  for (int d = 0; d < blocks_[block].count; ++d) {
    if (lanes[d] == 0) continue;
    const std::size_t direction = block * block_directions + d;
    float cosines[beam_lanes];
    const std::uint32_t rays = lanes[d] & face(packet, directions_[direction], cosines) & own_lanes;
    if (rays == 0) continue;
    RayScene::PacketHits hits;
    std::uint32_t left = scene_.first_front_hits(packet.origin, directions_[direction], rays, hits);
    if (left == 0) continue;
    worker.block.rays.push_back({static_cast<std::uint32_t>(direction), left});
    for (; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      worker.block.hits.push_back({hits.triangle[lane], hits.u[lane], hits.v[lane]});
    }
  }
}

void Gathering::sum(std::size_t packet, std::span<const FirstHits::Rays> rays, const FirstHits::Hit*& hit,
                    Worker& worker) const {
  const std::size_t width = radiance_.width;
  const float* values = radiance_.values.data();
  std::uint32_t hit_lanes = 0;
  for (const FirstHits::Rays& parallel : rays) {
    float cosines[beam_lanes];
    face(receivers_.packets[packet], directions_[parallel.direction], cosines);
    hit_lanes |= parallel.lanes;
    for (std::uint32_t left = parallel.lanes; left != 0; left &= left - 1, ++hit) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const auto& [a, b, c] = radiance_.points[hit->triangle];
      const float u = hit->u, v = hit->v, cosine = cosines[lane];
      add_weighted(values + a * width, values + b * width, values + c * width, cosine * (1 - u - v), cosine * u,
                   cosine * v, worker.sums.data() + lane * width, width);
    }
  }
  for (; hit_lanes != 0; hit_lanes &= hit_lanes - 1) {
    const std::size_t at = static_cast<std::size_t>(std::countr_zero(hit_lanes)) * width;
    move_block(worker.sums.data() + at, worker.totals.data() + at, width);
  }
}

void Gathering::gather(std::size_t packet, Worker& worker) const {
  std::fill(worker.totals.begin(), worker.totals.end(), 0);
  FirstHits* const hits = known_.hits;
  const FirstHits::Packet* const kept = hits != nullptr ? hits->find(known_.first_packet + packet) : nullptr;
  if (kept != nullptr) {
    const FirstHits::Hit* hit = kept->hits.data();
    for (auto first = kept->rays.begin(); first != kept->rays.end();) {
      const std::uint32_t block = first->direction / block_directions;
      const auto last = std::find_if(first, kept->rays.end(),
                                     [&](const auto& rays) { return rays.direction / block_directions != block; });
      sum(packet, {first, last}, hit, worker);
      first = last;
    }
    return;
  }
  worker.has_begun = false;
  worker.packet.clear();
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    find(packet, block, worker);
    const FirstHits::Hit* hit = worker.block.hits.data();
    sum(packet, worker.block.rays, hit, worker);
    if (hits != nullptr && hits->keeps()) worker.packet.append(worker.block);
  }
  if (hits != nullptr && hits->keeps()) hits->keep(known_.first_packet + packet, worker.packet);
}

}  // namespace

void add_gathered(const RayScene& scene, const BeamScene* beams, const BeamReceivers& receivers,
                  std::span<const Eigen::Vector3f> directions, const SurfaceRadiance& radiance, TransferSums& sums,
                  const ProgressFunction& progress, const KnownRays& known) {
  const std::size_t width = radiance.width;
  assert(static_cast<std::size_t>(sums.coefficients) == width);
  const Gathering gathering(scene, beams, receivers, directions, radiance, known);
  const auto gather = [&](std::size_t packet, Worker& worker) {
    gathering.gather(packet, worker);
    const std::size_t first = packet * beam_lanes;
    const std::size_t count = std::min<std::size_t>(beam_lanes, receivers.order.size() - first);
    for (std::size_t i = 0; i < width; ++i) {
      const auto plane = sums.plane(static_cast<int>(i));
      for (std::size_t lane = 0; lane < count; ++lane)
        plane[receivers.order[first + lane]] += worker.totals[lane * width + i];
    }
  };

  for_each_packet(
      receivers.packets.size(), progress, [&] { return gathering.worker(); }, gather);
  sums.directions += static_cast<std::int64_t>(directions.size());
}

}  // namespace kiln
