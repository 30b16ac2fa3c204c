// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "shapes.h"
#include "simplify/simplify.h"
#include "simplify/transfer_weights.h"

namespace kiln {
namespace test_transfer_weights {

/// Makes a cube of side 1 on a floor of side 6, with a gap that no ray offset closes.
TriangleMesh cube_on_floor() {
  const TriangleMesh floor = shapes::plane(48, 6);
  return shapes::joined(floor, shapes::cube(12), {0, 0.52f, 0});
}

TEST(TransferWeights, AreOneWhereNothingVaries) {
  const TriangleMesh plane = shapes::plane(6);
  EXPECT_EQ(transfer_weights(plane), std::vector<double>(plane.positions.size(), 1));
}

TEST(TransferWeights, AreLargestAtTheFootOfAWall) {
  const TriangleMesh mesh = cube_on_floor();
  const std::vector<double> weights = transfer_weights(mesh);
  double near = 0, far = 0;
  int near_count = 0, far_count = 0;
  for (std::size_t v = 0; v < shapes::plane(48, 6).positions.size(); ++v) {
    const double distance = std::max(std::abs(mesh.positions[v].x()), std::abs(mesh.positions[v].z())) - 0.5;
    if (distance > 0 && distance < 0.3) {
      near += weights[v];
      ++near_count;
    } else if (distance > 1.5 && distance < 2.2) {
      far += weights[v];
      ++far_count;
    }
  }
  ASSERT_GT(near_count, 20);
  ASSERT_GT(far_count, 20);
  // A form factor's slope falls at least as the square of the distance from what blocks.
  EXPECT_GT(near / near_count, 4 * far / far_count);
}

TEST(TransferWeights, DoNotDependOnTheUnitOfLength) {
  const TriangleMesh mesh = cube_on_floor();
  TriangleMesh large = mesh;
  for (Eigen::Vector3f& position : large.positions) position *= 1024;  // exact in float32
  const std::vector<double> small_weights = transfer_weights(mesh), large_weights = transfer_weights(large);
  ASSERT_EQ(small_weights.size(), mesh.positions.size());
  ASSERT_EQ(large_weights.size(), mesh.positions.size());
  EXPECT_GT(*std::max_element(small_weights.begin(), small_weights.end()), 2) << "all weights are 1, or nearly so";
  for (std::size_t v = 0; v < small_weights.size(); ++v) EXPECT_NEAR(large_weights[v], small_weights[v], 1e-3);
}

/// Makes a sheet with a cube close above one half of it: transfer varies at the cube's rim and beneath it. The sheet is
/// nearly flat, or its own slopes would vary transfer everywhere.
TEST(TransferWeights, PutTrianglesWhereTransferVaries) {
  TriangleMesh flat = shapes::wavy_sheet(40);
  for (Eigen::Vector3f& position : flat.positions) position.y() *= 0.25f;
  const TriangleMesh mesh = shapes::joined(flat, shapes::cube(4), {0.5f, 0.62f, 0});
  const auto share_near_cube = [&](SimplifyAwareness aware) {
    SimplifySettings settings;
    settings.faces = 400;
    settings.aware = aware;
    const TriangleMesh low = simplify(mesh, settings).mesh;
    int sheet = 0, near_cube = 0;
    for (const Triangle& t : low.triangles) {
      const Eigen::Vector3f middle = (low.positions[t[0]] + low.positions[t[1]] + low.positions[t[2]]) / 3;
      if (middle.y() > 0.1f) continue;  // the cube's
      ++sheet;
      near_cube += middle.x() > -0.1f ? 1 : 0;
    }
    return static_cast<double>(near_cube) / sheet;
  };
  const double blind = share_near_cube(SimplifyAwareness::none), aware = share_near_cube(SimplifyAwareness::transfer);
  // 400 triangles are not spread quite evenly; the gain, 0.059 as measured, is well above that.
  EXPECT_NEAR(blind, 0.6, 0.035) << "of the area";
  EXPECT_GT(aware, blind + 0.05);
}

}  // namespace test_transfer_weights
}  // namespace kiln
