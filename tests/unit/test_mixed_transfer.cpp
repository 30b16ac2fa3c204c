// SPDX-License-Identifier: GPL-3.0-or-later
// Transfer by beams and rays together: who goes where, and that it makes no difference to what is found.
#include <Eigen/Geometry>
#include <algorithm>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "import/import_mesh.h"
#include "raycast/mixed_transfer.h"
#include "raycast/ray_transfer.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace kiln {
namespace test_mixed_transfer {

constexpr int bands = 3;

std::vector<Eigen::Vector3f> coherent(int count) {
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, count, 1);
  order_coherently(directions, block_directions);
  return directions;
}

/// The bunny with two kinds of receivers: 2,048 that lie a fortieth of an edge apart, and 1,024 all over it.
class MixedTransferTest : public testing::Test {
 protected:
  static constexpr std::size_t near = 2048, apart = 1024;

  MixedTransferTest() {
    const Triangle& triangle = mesh.triangles[20000];
    const Eigen::Vector3f corner = mesh.positions[triangle[0]];
    const Eigen::Vector3f along = mesh.positions[triangle[1]] - corner, across = mesh.positions[triangle[2]] - corner;
    const Eigen::Vector3f normal = along.cross(across).normalized();
    for (std::size_t k = 0; k < near; ++k) {
      const float u = static_cast<float>(k % 64) / 40, v = static_cast<float>(k / 64) / 40;
      positions.push_back(corner + u * along + v * across + 0.1f * along.norm() * normal);
      normals.push_back(normal);
    }
    for (std::size_t k = 0; k < apart; ++k) {
      const std::size_t vertex = k * mesh.positions.size() / apart;
      positions.push_back(mesh.positions[vertex]);
      normals.push_back(mesh.normals[vertex]);
    }
  }

  Receivers receivers() const { return {positions, normals}; }
  float ray_offset() const { return rounding_offset(mesh.positions); }
  MixedTransfer mixed(const std::vector<Eigen::Vector3f>& planned) const {
    MixedTransfer transfer(mesh.positions, mesh.triangles, ray_offset());
    transfer.set_receivers(receivers(), coefficient_count(bands), planned);
    return transfer;
  }

  TriangleMesh mesh = load_mesh("/usr/share/glmark2/models/bunny.obj");
  std::vector<Eigen::Vector3f> positions, normals;
};

TEST_F(MixedTransferTest, ReceiversGoWhereTheyAreCheaper) {
  const BeamSplit split = mixed(coherent(1024)).split();
  const auto near_by_rays = std::count_if(split.rays.begin(), split.rays.end(), [](auto r) { return r < near; });
  const auto apart_by_rays = static_cast<std::ptrdiff_t>(split.rays.size()) - near_by_rays;
  EXPECT_LT(near_by_rays, 0.1 * near);
  EXPECT_GT(apart_by_rays, 0.9 * apart);
  // Each receiver is in one of the two lists.
  std::vector<std::uint32_t> all = split.rays;
  all.insert(all.end(), split.beams.order.begin(), split.beams.order.end());
  std::sort(all.begin(), all.end());
  ASSERT_EQ(all.size(), near + apart);
  for (std::uint32_t r = 0; r < all.size(); ++r) ASSERT_EQ(all[r], r);
  EXPECT_NEAR(split.beam_share(), 1 - static_cast<double>(split.rays.size()) / static_cast<double>(all.size()), 1e-12);
  EXPECT_GT(split.pilot.beam_rays, 1000u);
  EXPECT_GT(split.pilot.rays.rays, 100u);
}

TEST_F(MixedTransferTest, FindsWhatRaysFind) {
  const std::vector<Eigen::Vector3f> directions = coherent(512);
  MixedTransfer transfer = mixed(directions);
  ASSERT_GT(transfer.split().rays.size(), 0u);
  ASSERT_GT(transfer.split().beams.order.size(), 0u);
  double done = 0;
  transfer.add(std::span(directions).first(256), [&](double fraction) {
    EXPECT_GE(fraction, done);
    done = fraction;
  });
  EXPECT_NEAR(done, 1, 1e-12);
  transfer.add(std::span(directions).subspan(256), no_progress);
  const TransferVectors rays =
      transfer_by_rays(RayScene(mesh), receivers(), directions, bands, ray_offset(), no_progress);
  // Rays that pass an edge are rounded another way by beams: one of 512 directions at a few receivers.
  EXPECT_LT(relative_l2(transfer.sums().transfer(), rays), 1e-4);
  EXPECT_EQ(transfer.sums().directions, 512);
}

TEST_F(MixedTransferTest, AnyNumberOfThreadsGivesTheSameBits) {
  const std::vector<Eigen::Vector3f> directions = coherent(256);
  std::vector<std::int64_t> values[2];
  for (std::size_t threads : {1u, 2u}) {
    const ThreadLimit limit(threads);
    MixedTransfer transfer = mixed(directions);
    transfer.add(directions, no_progress);
    values[threads - 1] = transfer.sums().values;
  }
  EXPECT_EQ(values[0], values[1]);
}

TEST_F(MixedTransferTest, BlockedRaysAreKeptWhereAllAreBeams) {
  const std::vector<Eigen::Vector3f> directions = coherent(256);
  RayMemory memory(100'000'000);
  {
    MixedTransfer transfer = mixed(directions);
    BlockedRays blocked(memory);
    transfer.add(directions, no_progress, &blocked);
    EXPECT_EQ(blocked.find(0, 0), nullptr) << "some are cast one by one";
  }
  positions.resize(near);
  normals.resize(near);
  MixedTransfer transfer = mixed(directions);
  ASSERT_TRUE(transfer.split().rays.empty());
  BlockedRays blocked(memory);
  transfer.add(directions, no_progress, &blocked);
  EXPECT_TRUE(blocked.holds(8));
}

TEST_F(MixedTransferTest, NothingIsInTheWayOfNoTriangles) {
  MixedTransfer transfer({}, {}, 0);
  const std::vector<Eigen::Vector3f> directions = coherent(256);
  transfer.set_receivers(receivers(), coefficient_count(bands), directions);
  transfer.add(directions, no_progress);
  const ShBasis basis(bands);
  // 256 directions integrate a cosine to about 1e-3.
  EXPECT_NEAR(transfer.sums().transfer().plane(0)[5], unoccluded_transfer(basis, normals[5])[0], 3e-3);
}

}  // namespace test_mixed_transfer
}  // namespace kiln
