// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "mesh/uv_raster.h"
#include "shapes.h"

namespace kiln {
namespace test_uv_raster {

TriangleMesh flat(const std::vector<Eigen::Vector2f>& uvs, const std::vector<Triangle>& triangles) {
  TriangleMesh mesh;
  mesh.uvs = uvs;
  for (const Eigen::Vector2f& uv : uvs) mesh.positions.emplace_back(uv.x(), uv.y(), 0.0f);
  mesh.triangles = triangles;
  return mesh;
}

TEST(UvRaster, SquareCoversEachTexelOnce) {
  const TriangleMesh mesh = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  for (const int size : {1, 7, 16, 64}) {
    const UvRaster raster = rasterise_uvs(mesh, size, size);  // centres lie on the shared diagonal
    EXPECT_EQ(raster.covered_texels, static_cast<std::int64_t>(size) * size);
    EXPECT_EQ(raster.overlapping_texels, 0);
  }
}

TEST(UvRaster, CentresOnTheSquaresBorderBelongToOneSide) {
  // Four squares around the centre of texel (2, 2) of 5 x 5, so that their common sides run through centres.
  const float middle = 0.5f;
  const std::vector<Eigen::Vector2f> uvs = {{0, 0},      {middle, 0}, {1, 0},      {0, middle}, {middle, middle},
                                            {1, middle}, {0, 1},      {middle, 1}, {1, 1}};
  const TriangleMesh mesh =
      flat(uvs, {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {3, 4, 7}, {3, 7, 6}, {4, 5, 8}, {4, 8, 7}});
  const UvRaster raster = rasterise_uvs(mesh, 5, 5);
  EXPECT_EQ(raster.covered_texels, 25);
  EXPECT_EQ(raster.overlapping_texels, 0);
}

TEST(UvRaster, FanOfRandomTrianglesHasNoGapsNorOverlaps) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> jitter(-0.3f, 0.3f);
  constexpr int cells = 12;
  TriangleMesh mesh = shapes::plane(cells, 1, 0, 0);
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i) {
    Eigen::Vector2f& uv = mesh.uvs[i];
    const bool inside = uv.minCoeff() > 0.01f && uv.maxCoeff() < 0.99f;
    if (inside) uv += Eigen::Vector2f(jitter(random), jitter(random)) / cells;
  }
  const UvRaster raster = rasterise_uvs(mesh, 96, 80);
  EXPECT_EQ(raster.covered_texels, 96 * 80);
  EXPECT_EQ(raster.overlapping_texels, 0);
}

TEST(UvRaster, TriangleCoversItsAreaAndItsLowerLeft) {
  const TriangleMesh mesh = flat({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}});
  const UvRaster raster = rasterise_uvs(mesh, 64, 32);
  EXPECT_TRUE(raster.at(0, 0).covered());
  EXPECT_FALSE(raster.at(63, 31).covered());
  EXPECT_NEAR(static_cast<double>(raster.covered_texels), 64 * 32 / 2.0, 32);  // half a texel along the 64-texel slope
}

TEST(UvRaster, WeightsGiveBackTheCentre) {
  // Once as it is and once mirrored, so that the corners' order cannot be lost.
  for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 1}}) {
    const TriangleMesh mesh = flat({{0.1f, 0.2f}, {0.9f, 0.3f}, {0.4f, 0.95f}}, {t});
    const UvRaster raster = rasterise_uvs(mesh, 50, 40);
    ASSERT_GT(raster.covered_texels, 100);
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 50; ++i) {
        if (!raster.at(i, j).covered()) continue;
        const Eigen::Vector2f uv = interpolate(mesh, mesh.uvs, raster.at(i, j));
        // Corners are rounded to 1/4096 texel.
        EXPECT_NEAR(uv.x() * 50, static_cast<float>(i) + 0.5f, 1e-3f);
        EXPECT_NEAR(uv.y() * 40, static_cast<float>(j) + 0.5f, 1e-3f);
      }
  }
}

TEST(UvRaster, OverlapsAreCountedOncePerTexelAndTheFirstStays) {
  const std::vector<Eigen::Vector2f> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const TriangleMesh mesh = flat(uvs, {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}, {0, 1, 2}});
  const UvRaster raster = rasterise_uvs(mesh, 8, 8);
  EXPECT_EQ(raster.covered_texels, 64);
  EXPECT_EQ(raster.overlapping_texels, 64);
  for (const TexelSource& texel : raster.texels) EXPECT_LT(texel.triangle, 2u);
}

TEST(UvRaster, OddInputCoversNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const TriangleMesh mesh = flat({{0, 0}, {1, 1}, {0.5f, 0.5f}, {nan, 0}, {1e30f, 0}, {-3, -3}, {-2, -3}, {-3, -2}},
                                 {{0, 1, 2}, {0, 0, 1}, {0, 1, 3}, {0, 1, 4}, {5, 6, 7}});
  const UvRaster raster = rasterise_uvs(mesh, 16, 16);
  EXPECT_EQ(raster.covered_texels, 0);
  EXPECT_EQ(raster.overlapping_texels, 0);
  EXPECT_EQ(rasterise_uvs(shapes::icosphere(0), 4, 4).covered_texels, 0);  // has no uvs
}

TEST(UvRaster, ClipsAtTheBorder) {
  const TriangleMesh mesh = flat({{-2, -2}, {4, -2}, {-2, 4}}, {{0, 1, 2}});
  EXPECT_EQ(rasterise_uvs(mesh, 32, 32).covered_texels, 32 * 32);
}

}  // namespace test_uv_raster
}  // namespace kiln
