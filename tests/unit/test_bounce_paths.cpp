// SPDX-License-Identifier: GPL-3.0-or-later
// Bounced light against an independent path tracer.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "bounce_stand.h"
#include "import/import_mesh.h"
#include "path_tracer.h"
#include "shapes.h"

namespace kiln {
namespace test_bounce_paths {

/// Radiance of a sky of three bands: bright above and to one side, grey. Band-limited, so that transfer represents all
/// of it.
std::vector<double> sky_light() {
  std::vector<double> light(9, 0.0);
  light[0] = 3;
  light[coefficient_index(1, -1)] = 1.2;
  light[coefficient_index(1, 1)] = 0.9;
  light[coefficient_index(2, 0)] = 0.4;
  light[coefficient_index(2, 2)] = -0.3;
  return light;
}

TEST(BouncePaths, BunnyOnAColoredFloor) {
  constexpr int bounces = 3, paths = 20000;
  const Eigen::Vector3f bunny_albedo(0.7f, 0.8f, 0.9f), floor_albedo(0.8f, 0.3f, 0.1f);
  BounceStand stand;
  const TriangleMesh bunny = load_mesh("/usr/share/glmark2/models/bunny.obj");
  const BoundingBox box = bounding_box(bunny);
  TriangleMesh floor = shapes::plane(1, 2 * box.diagonal(), box.lowest.y());
  for (Eigen::Vector3f& p : floor.positions) p += Eigen::Vector3f(box.centre().x(), 0, box.centre().z());
  stand.occluders =
      join_occluders({bunny, floor}, {SurfaceAlbedo::constant(bunny_albedo), SurfaceAlbedo::constant(floor_albedo)});
  for (std::size_t v = 0; v < bunny.positions.size(); v += 600) {
    stand.positions.push_back(bunny.positions[v]);
    stand.normals.push_back(bunny.normals[v]);
  }
  for (int k = 0; k < 25; ++k) {  // of the floor: under the bunny, beside it and away from it
    const float x = static_cast<float>(k % 5 - 2), z = static_cast<float>(k / 5 - 2);
    stand.positions.push_back(Eigen::Vector3f(box.centre().x(), box.lowest.y(), box.centre().z()) +
                              0.2f * box.diagonal() * Eigen::Vector3f(x + 0.13f, 0, z + 0.07f));
    stand.normals.push_back(Eigen::Vector3f::UnitY());
  }
  stand.settings.bands = 3;
  stand.settings.directions = 512;
  stand.settings.bounce_edge = 0.02;
  stand.settings.bounces = {.count = bounces};
  stand.backend = BakeBackend::beams;
  const BakeResult baked = stand.bake();
  ASSERT_EQ(baked.channels.size(), 3u);

  const std::vector<double> light = sky_light();
  const ShBasis basis(3);
  const auto sky = [&](const Eigen::Vector3f& direction) {
    double values[9], sum = 0;
    basis.evaluate<double>(direction.cast<double>().normalized(), values);
    for (int i = 0; i < 9; ++i) sum += light[i] * values[i];
    return sum;
  };
  std::vector<Eigen::Vector3f> albedos(bunny.triangles.size(), bunny_albedo);
  albedos.resize(stand.occluders.mesh.triangles.size(), floor_albedo);
  const PathTracer tracer(stand.occluders.mesh, albedos);
  const float offset = 1e-4f * bounding_box(stand.occluders.mesh).diagonal();

  const std::size_t receivers = stand.positions.size();
  std::vector<Eigen::Vector3d> truth(receivers), variance(receivers);
  parallel_for(std::size_t{0}, receivers, [&](std::size_t r) {
    std::mt19937 random(static_cast<unsigned>(r) + 1);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
    for (int k = 0; k < paths; ++k) {
      const Eigen::Vector3d sample = tracer.path(stand.positions[r], stand.normals[r], bounces, offset, sky, random);
      sum += sample;
      squares += sample.cwiseProduct(sample);
    }
    truth[r] = sum / paths;
    variance[r] = (squares / paths - truth[r].cwiseProduct(truth[r])) / paths;
  });

  double difference = 0, noise = 0, length = 0;
  Eigen::Vector3d mean_baked = Eigen::Vector3d::Zero(), mean_truth = Eigen::Vector3d::Zero();
  for (std::size_t r = 0; r < receivers; ++r)
    for (int c = 0; c < 3; ++c) {
      double radiance = 0;
      for (int i = 0; i < 9; ++i) radiance += light[i] * baked.channels[c].plane(i)[r];
      difference += std::pow(radiance - truth[r][c], 2);
      noise += variance[r][c];
      length += std::pow(truth[r][c], 2);
      mean_baked[c] += radiance / static_cast<double>(receivers);
      mean_truth[c] += truth[r][c] / static_cast<double>(receivers);
    }
  // 20,000 paths leave a noise of 0.3 %. The bake adds what 512 directions leave of the integral (0.3 % here) and what
  // the cache has in between its points; where the floor meets the bunny that is most.
  EXPECT_LT(std::sqrt(noise / length), 0.004);
  EXPECT_LT(std::sqrt(difference / length), 0.012);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean_baked[c] / mean_truth[c], 1, 0.003);
}

}  // namespace test_bounce_paths
}  // namespace kiln
