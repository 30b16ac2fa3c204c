#include "raycast/gather.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <vector>

#include "raycast/vector_width.h"

namespace kiln {

namespace {

constexpr std::size_t group_packets = 1024;  // between two reports of progress

static_assert(RayScene::PacketHits::lanes == beam_lanes);

/// sum[i] += a[i] * wa + b[i] * wb + c[i] * wc.
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
  std::vector<BeamTracer> tracer;  // none, or one
  std::vector<float> sums;
  std::vector<std::int64_t> totals;
};

/// max(0, n.s) of a packet's receivers; the bits of those above 0.
std::uint32_t face(const BeamPacket& packet, const Eigen::Vector3f& direction, float (&cosines)[beam_lanes]) {
  std::uint32_t facing = 0;
  for (int lane = 0; lane < beam_lanes; ++lane) {
    cosines[lane] = packet.normal[0][lane] * direction.x() + packet.normal[1][lane] * direction.y() +
                    packet.normal[2][lane] * direction.z();
    if (cosines[lane] > 0) facing |= 1u << lane;
  }
  return facing;
}

}  // namespace

void add_gathered(const RayScene& scene, const BeamScene* beams, const BeamReceivers& receivers,
                  std::span<const Eigen::Vector3f> directions, const SurfaceRadiance& radiance, TransferSums& sums,
                  const ProgressFunction& progress) {
  const std::size_t width = radiance.width;
  assert(static_cast<std::size_t>(sums.coefficients) == width);
  std::vector<BeamBlock> blocks;
  for (std::size_t d = 0; d < directions.size(); d += block_directions)
    blocks.emplace_back(directions.subspan(d, std::min<std::size_t>(block_directions, directions.size() - d)));
  tbb::enumerable_thread_specific<Worker> workers([&] {
    Worker worker{{}, std::vector<float>(beam_lanes * width, 0.f), std::vector<std::int64_t>(beam_lanes * width)};
    if (beams != nullptr) worker.tracer.emplace_back(*beams);
    return worker;
  });

  const auto gather = [&](std::size_t packet_index, Worker& worker) {
    const std::size_t first = packet_index * beam_lanes;
    const std::size_t count = std::min<std::size_t>(beam_lanes, receivers.order.size() - first);
    const std::uint32_t own_lanes = (1u << count) - 1;
    const BeamPacket& packet = receivers.packets[packet_index];
    std::fill(worker.totals.begin(), worker.totals.end(), 0);
    if (beams != nullptr) worker.tracer[0].begin(packet);
    for (std::size_t begin = 0; begin < directions.size(); begin += block_directions) {
      const auto block = directions.subspan(begin, std::min<std::size_t>(block_directions, directions.size() - begin));
      // Step 1: which directions may have something in them at all.
      BeamWeights weights;
      std::uint32_t wanted = ~0u;
      if (beams != nullptr) {
        worker.tracer[0].trace(blocks[begin / block_directions], weights);
        wanted = weights.facing & ~weights.lit;
      }
      std::uint32_t hit_lanes = 0;
      for (std::size_t d = 0; d < block.size(); ++d) {
        if ((wanted >> d & 1) == 0) continue;
        float cosines[beam_lanes];
        std::uint32_t rays = face(packet, block[d], cosines) & own_lanes;
        if (beams != nullptr)
          for (int lane = 0; lane < beam_lanes; ++lane)
            if (weights.weight[d][lane] > 0) rays &= ~(1u << lane);
        if (rays == 0) continue;
        // Step 2: what is there, and what it sends.
        RayScene::PacketHits hits;
        scene.first_front_hits(packet.origin, block[d], rays, hits);
        for (std::size_t lane = 0; lane < count; ++lane) {
          if (hits.triangle[lane] == SurfacePoint::none) continue;
          const auto& [a, b, c] = radiance.points[hits.triangle[lane]];
          const float u = hits.u[lane], v = hits.v[lane], cosine = cosines[lane];
          add_weighted(radiance.values.data() + a * width, radiance.values.data() + b * width,
                       radiance.values.data() + c * width, cosine * (1 - u - v), cosine * u, cosine * v,
                       worker.sums.data() + lane * width, width);
          hit_lanes |= 1u << lane;
        }
      }
      for (; hit_lanes != 0; hit_lanes &= hit_lanes - 1) {
        const std::size_t at = static_cast<std::size_t>(std::countr_zero(hit_lanes)) * width;
        move_block(worker.sums.data() + at, worker.totals.data() + at, width);
      }
    }
    for (std::size_t i = 0; i < width; ++i) {
      const auto plane = sums.plane(static_cast<int>(i));
      for (std::size_t lane = 0; lane < count; ++lane)
        plane[receivers.order[first + lane]] += worker.totals[lane * width + i];
    }
  };

  const std::size_t packets = receivers.packets.size();
  for (std::size_t first = 0; first < packets; first += group_packets) {
    const std::size_t last = std::min(first + group_packets, packets);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, 4),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        Worker& worker = workers.local();
                        for (std::size_t packet = range.begin(); packet != range.end(); ++packet)
                          gather(packet, worker);
                      });
    progress(static_cast<double>(last) / static_cast<double>(packets));
  }
  sums.directions += static_cast<std::int64_t>(directions.size());
}

}  // namespace kiln
