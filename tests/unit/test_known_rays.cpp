// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of kept rays: they equal what a new search finds, and sums have the same bits whatever is kept.
#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "raycast/gather.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"
#include "shapes.h"

namespace kiln {
namespace test_known_rays {

constexpr std::size_t plenty = 1u << 30;

/// A torus, which hides much of itself from its own vertices, and 300 directions: not whole blocks.
struct Stand {
  TriangleMesh mesh = shapes::torus(36);
  std::vector<Eigen::Vector3f> positions = mesh.positions, normals,
                               directions = sample_directions(Sampling::fibonacci, 300, 3);
  float ray_offset = rounding_offset(mesh.positions);
  BeamScene beams{mesh.positions, mesh.triangles};
  RayScene rays{mesh};
  BeamReceivers receivers;
  std::vector<float> radiance;

  Stand() {
    positions.resize(1285);  // the last packet lacks some
    for (const Eigen::Vector3f& p : positions)
      normals.push_back((p - Eigen::Vector3f(p.x(), 0, p.z()).normalized()).normalized());
    order_coherently(directions, block_directions);
    receivers = BeamReceivers({positions, normals}, ray_offset);
    for (std::size_t k = 0; k < 2 * mesh.positions.size(); ++k)
      radiance.push_back(0.5f + 0.4f * static_cast<float>(k % 7));
  }

  std::size_t blocks() const { return (directions.size() + block_directions - 1) / block_directions; }
  std::size_t block_bytes() const { return receivers.packets.size() * sizeof(BlockLanes); }

  /// Runs the direct pass in two calls, and returns what it keeps.
  BlockedRays blocked(RayMemory& memory) const {
    BlockedRays kept(memory);
    TransferSums sums(positions.size(), 4);
    const std::span all(directions);
    add_transfer_by_beams(beams, receivers, all.first(96), sums, no_progress, &kept);
    add_transfer_by_beams(beams, receivers, all.subspan(96), sums, no_progress, &kept);
    return kept;
  }

  std::vector<std::int64_t> gathered(const RayScene& scene, const BeamScene* own_beams, const KnownRays& known) const {
    TransferSums sums(positions.size(), 2);
    add_gathered(scene, own_beams, receivers, directions, {mesh.triangles, radiance, 2}, sums, no_progress, known);
    return sums.values;
  }
};

TEST(KnownRays, BlockedAreThoseThatASearchFinds) {
  const Stand stand;
  RayMemory memory(plenty);
  const BlockedRays kept = stand.blocked(memory);
  EXPECT_TRUE(kept.holds(stand.blocks()));
  EXPECT_FALSE(kept.holds(stand.blocks() + 1));
  EXPECT_EQ(plenty - memory.left(), stand.blocks() * stand.block_bytes());
  // Results equal those of beams bit for bit, and those of Embree but for rays that pass an edge.
  BeamTracer tracer(stand.beams);
  std::size_t rays = 0, hidden = 0, otherwise = 0;
  for (std::size_t p = 0; p < stand.receivers.packets.size(); ++p) {
    const BeamPacket& packet = stand.receivers.packets[p];
    tracer.begin(packet);
    for (std::size_t b = 0; b < stand.blocks(); ++b) {
      const std::size_t first = b * block_directions;
      const auto block = std::span(stand.directions)
                             .subspan(first, std::min<std::size_t>(block_directions, stand.directions.size() - first));
      BeamWeights weights;
      tracer.trace(BeamBlock(block), weights);
      const BlockLanes* lanes = kept.find(p, b);
      ASSERT_NE(lanes, nullptr);
      EXPECT_EQ(*lanes, blocked_lanes(weights));
      for (std::size_t d = 0; d < block.size(); ++d)
        for (int lane = 0; lane < beam_lanes; ++lane) {
          const Eigen::Vector3f origin(packet.origin[0][lane], packet.origin[1][lane], packet.origin[2][lane]);
          const Eigen::Vector3f normal(packet.normal[0][lane], packet.normal[1][lane], packet.normal[2][lane]);
          if (!(normal.dot(block[d]) > 1e-5f)) continue;
          std::uint8_t is_blocked = 0;
          stand.rays.occluded(std::span(&origin, 1), block[d], 0, std::span(&is_blocked, 1));
          ++rays;
          hidden += is_blocked;
          otherwise += ((*lanes)[d] >> lane & 1u) != is_blocked ? 1 : 0;
        }
    }
  }
  EXPECT_GT(hidden, rays / 20);
  EXPECT_LT(otherwise, rays / 10000);
}

TEST(KnownRays, SumsHaveTheSameBitsWhateverIsKept) {
  const Stand stand;
  const std::vector<std::int64_t> searched = stand.gathered(stand.rays, &stand.beams, {});
  EXPECT_TRUE(std::any_of(searched.begin(), searched.end(), [](std::int64_t sum) { return sum != 0; }));

  // All of what is blocked: no beams are needed. Some of it, and from the middle on, as after an interruption: with.
  RayMemory memory(plenty), less(3 * stand.block_bytes() + 1);
  const BlockedRays all = stand.blocked(memory), some = stand.blocked(less);
  EXPECT_FALSE(some.holds(4));
  EXPECT_NE(some.find(0, 2), nullptr);
  EXPECT_EQ(some.find(0, 3), nullptr);
  EXPECT_EQ(stand.gathered(stand.rays, nullptr, {&all, nullptr, 0}), searched);
  EXPECT_EQ(stand.gathered(stand.rays, &stand.beams, {&some, nullptr, 0}), searched);
  BlockedRays late(memory);
  late.start_at(5);
  TransferSums sums(stand.positions.size(), 4);
  add_transfer_by_beams(stand.beams, stand.receivers, std::span(stand.directions).subspan(5 * block_directions), sums,
                        no_progress, &late);
  EXPECT_FALSE(late.holds(stand.blocks()));
  EXPECT_EQ(late.find(0, 4), nullptr);
  EXPECT_EQ(stand.gathered(stand.rays, &stand.beams, {&late, nullptr, 0}), searched);
}

TEST(KnownRays, FirstHitsAreFoundOnce) {
  const Stand stand;
  const std::vector<std::int64_t> searched = stand.gathered(stand.rays, &stand.beams, {});
  const RayScene nothing(std::span<const Eigen::Vector3f>{}, std::span<const Triangle>{});
  RayMemory memory(plenty);
  FirstHits hits(memory, stand.receivers.packets.size());
  EXPECT_EQ(stand.gathered(stand.rays, &stand.beams, {nullptr, &hits, 0}), searched);
  const std::size_t left = memory.left();
  EXPECT_EQ(stand.gathered(nothing, nullptr, {nullptr, &hits, 0}), searched);  // nothing is cast
  EXPECT_EQ(memory.left(), left);

  // Rays that memory had no room for are found again.
  RayMemory half((plenty - left) / 2), none(0);
  FirstHits some(half, stand.receivers.packets.size()), no_hits(none, stand.receivers.packets.size());
  EXPECT_FALSE(no_hits.keeps());
  for (int pass = 0; pass < 2; ++pass) {
    EXPECT_EQ(stand.gathered(stand.rays, &stand.beams, {nullptr, &some, 0}), searched);
    EXPECT_EQ(stand.gathered(stand.rays, &stand.beams, {nullptr, &no_hits, 0}), searched);
  }
  EXPECT_NE(stand.gathered(nothing, nullptr, {nullptr, &some, 0}), searched);
  EXPECT_LT(half.left(), (plenty - left) / 10);
}

TEST(KnownRays, MemoryIsNeverMoreThanThereIs) {
  RayMemory memory(1000);
  std::atomic<int> taken = 0;
  parallel_for(0, 500, [&](int) { taken += memory.take(7) ? 1 : 0; });
  EXPECT_EQ(taken, 142);
  EXPECT_EQ(memory.left(), 6u);
  EXPECT_TRUE(memory.take(6));
  EXPECT_FALSE(memory.take(1));
}

}  // namespace test_known_rays
}  // namespace kiln
