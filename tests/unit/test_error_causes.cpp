// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

#include "mesh/uv_raster.h"
#include "raycast/ray_transfer.h"
#include "report/error_causes.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_prior.h"
#include "sh/ray_offset.h"

namespace kiln {
namespace {

constexpr int size = 64;
constexpr int bands = 4;

/// A floor of 2 x 2 with uvs, as low and high mesh, under a wall that shadows it, and what a bake makes of them.
struct Floor {
  TriangleMesh low, high;
  SceneMesh scene;
  DetailMaps detail;
  PrtAsset asset;
  std::vector<Eigen::Vector3f> directions;

  /// `depth`: how far the high mesh lies beneath the low one.
  explicit Floor(int direction_count = 1024, int bits = 16, float depth = 0) {
    low.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    low.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    low.normals.assign(4, Eigen::Vector3f::UnitY());
    low.triangles = {{0, 1, 2}, {0, 2, 3}};
    high = low;
    for (Eigen::Vector3f& p : high.positions) p.y() = -depth;
    TriangleMesh wall;
    wall.positions = {{-0.5f, 0.2f, -0.5f}, {0.5f, 0.2f, -0.5f}, {0.5f, 1, -0.5f}, {-0.5f, 1, -0.5f}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
    scene.add(high);
    scene.add(wall);
    const UvRaster raster = rasterise_uvs(low, size, size);
    detail.width = detail.height = size;
    detail.covered = coverage_of(raster);
    detail.position = detail.normal_object = Image<float>(size, size, 3);
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const Eigen::Vector3f position = interpolate(low, low.positions, raster.at(i, j));
        for (int c = 0; c < 3; ++c) {
          detail.position.at(i, j, c) = c == 1 ? -depth : position[c];
          detail.normal_object.at(i, j, c) = c == 1 ? 1.f : 0.f;
        }
      }
    directions = sample_directions(Sampling::fibonacci, direction_count, 5);
    store(directions, bits);
  }

  /// Bakes the planes over some directions.
  void store(const std::vector<Eigen::Vector3f>& over, int bits) {
    std::vector<Eigen::Vector3f> positions, normals(std::size_t{size} * size, Eigen::Vector3f::UnitY());
    for (int k = 0; k < size * size; ++k) {
      const auto p = detail.position.pixel(k % size, k / size);
      positions.emplace_back(p[0], p[1], p[2]);
    }
    const RayScene rays(scene.mesh);
    const TransferVectors transfer =
        transfer_by_rays(rays, {positions, normals}, over, bands, rounding_offset(scene.mesh.positions));
    asset.bands = bands;
    asset.channels = 1;
    asset.bits = bits;
    asset.width = asset.height = size;
    asset.planes.clear();
    std::vector<Image<std::uint16_t>> wide;
    std::vector<Image<std::uint8_t>> narrow;
    for (int i = 0; i < transfer.coefficients; ++i) {
      const auto [least, most] = std::ranges::minmax(transfer.plane(i));
      PrtPlane plane;
      plane.coefficient = i;
      plane.bits = bits;
      plane.range = {least, most};
      Image<std::uint16_t> picture(size, size, 1);
      for (int k = 0; k < size * size; ++k)
        picture.values()[k] = static_cast<std::uint16_t>(plane.range.store(transfer.plane(i)[k], bits));
      asset.planes.push_back(plane);
      Image<std::uint8_t>& bytes = narrow.emplace_back(size, size, 1);
      std::ranges::transform(picture.values(), bytes.values().begin(),
                             [](std::uint16_t value) { return static_cast<std::uint8_t>(value); });
      wide.push_back(std::move(picture));
    }
    if (bits == 16)
      asset.pictures = std::move(wide);
    else
      asset.pictures = std::move(narrow);
  }

  ErrorSplit split(const PrtAsset* compressed = nullptr) const {
    return error_causes({.high = high,
                         .low = low,
                         .scene = scene,
                         .asset = asset,
                         .compressed = compressed,
                         .detail = detail,
                         .bake_directions = directions});
  }
};

double cause(const ErrorSplit& split, const std::string& name) {
  const auto found = std::ranges::find(split.causes, name, &ErrorCause::name);
  EXPECT_NE(found, split.causes.end()) << name;
  return found == split.causes.end() ? -1 : found->error;
}

TEST(ErrorCauses, AreZeroWhereNothingDiffers) {
  const ErrorSplit split = Floor().split();
  EXPECT_GT(split.samples, 3000u);
  EXPECT_LT(cause(split, "geometry"), 1e-5);    // roundings of two ways to the same point
  EXPECT_LT(cause(split, "bits"), 2e-5);        // 16 bits
  EXPECT_LT(cause(split, "visibility"), 1e-6);  // what is stored was made by the same rays
  EXPECT_LT(cause(split, "seams"), 1e-6);
  EXPECT_GT(cause(split, "bands"), 0.01);
  EXPECT_GT(cause(split, "texels"), 1e-4);
}

TEST(ErrorCauses, AddUpInSquares) {
  const ErrorSplit split = Floor(256, 8, 0.02f).split();
  EXPECT_NEAR(split.root_sum(), split.total, 0.1 * split.total);
}

TEST(ErrorCauses, DirectionsAreThoseOfTheBakeAlone) {
  const double few = cause(Floor(64).split(), "directions"), many = cause(Floor(4096).split(), "directions");
  EXPECT_GT(few, 5 * many);  // quadrature falls faster than the root of 64
}

TEST(ErrorCauses, BitsAreRoundingsOfEvenDistribution) {
  const Floor floor(1024, 8);
  const ErrorSplit split = floor.split();
  // A value rounded to steps has an error of step / sqrt(12), and a bilinear lookup of four keeps 4/9 of its square.
  double expected = 0, norm = 0;
  const std::vector<double> prior = lighting_prior(bands);
  std::vector<std::uint32_t> all(std::size_t{size} * size);
  std::iota(all.begin(), all.end(), 0u);
  std::vector<float> stored(all.size() * floor.asset.planes.size());
  decode_transfer(floor.asset, all, stored);
  for (std::size_t k = 0; k < stored.size(); ++k) {
    const std::size_t i = k % floor.asset.planes.size();
    const double weight = prior[static_cast<std::size_t>(band_of(static_cast<int>(i)))];
    const double step = floor.asset.planes[i].range.step(8);
    expected += weight * step * step / 12 * 4 / 9;
    norm += weight * stored[k] * stored[k];
  }
  EXPECT_NEAR(cause(split, "bits"), std::sqrt(expected / norm), 0.15 * std::sqrt(expected / norm));
}

TEST(ErrorCauses, GeometryIsWhereTheViewerSeesAnotherPoint) {
  const ErrorSplit split = Floor(1024, 16, 0.05f).split();
  EXPECT_GT(cause(split, "geometry"), 0.005);
  EXPECT_LT(cause(split, "visibility"), 1e-6);
}

TEST(ErrorCauses, WhatTheEngineDoesOtherwiseIsVisibility) {
  Floor floor;
  floor.store(sample_directions(Sampling::fibonacci, 1024, 77), 16);  // not the directions that the record names
  const ErrorSplit split = floor.split();
  EXPECT_GT(cause(split, "visibility"), 1e-4);
  EXPECT_LT(cause(split, "seams"), cause(split, "visibility")) << "the floor's border is a small part of it";
}

TEST(ErrorCauses, AreNoNumbersWhereNothingIsSeen) {
  Floor floor;
  for (Triangle& t : floor.high.triangles) std::swap(t[1], t[2]);  // the high mesh shows its back
  for (Eigen::Vector3f& normal : floor.high.normals) normal = -normal;
  const ErrorSplit split = floor.split();
  EXPECT_EQ(split.samples, 0u);
  EXPECT_TRUE(std::isnan(split.total));  // 0 would keep every budget
}

TEST(ErrorCauses, CompressionIsWhatCompressionChanges) {
  const Floor floor;
  PrtAsset changed = floor.asset;
  for (PrtPlane& plane : changed.planes) {
    plane.range.lowest *= 1.02;
    plane.range.highest *= 1.02;
  }
  const ErrorSplit split = floor.split(&changed);
  EXPECT_NEAR(cause(split, "compression"), 0.02, 0.001);  // everything is 2 % too long
}

/// Returns a floor of 2 x 2 under a plate of so many across, with uvs.
TriangleMesh floor_under_plate(float plate) {
  TriangleMesh mesh;
  const float half = plate / 2;
  mesh.positions = {{-1, 0, 1},          {1, 0, 1},          {1, 0, -1},          {-1, 0, -1},
                    {-half, 0.5f, half}, {half, 0.5f, half}, {half, 0.5f, -half}, {-half, 0.5f, -half}};
  mesh.uvs = {{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}, {0.6f, 0.6f}, {1, 0.6f}, {1, 1}, {0.6f, 1}};
  mesh.normals.assign(8, Eigen::Vector3f::UnitY());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return mesh;
}

TEST(ErrorSamples, ShowOutlinesAsOftenAsAViewerSeesThem) {
  const TriangleMesh low = floor_under_plate(0.5f), high = floor_under_plate(0.51f);
  DetailMaps detail;
  detail.width = detail.height = size;
  detail.covered.assign(std::size_t{size} * size, 1);
  const ErrorSamples samples = make_error_samples(high, low, detail, {.pixels = 2000});
  double outline = 0, all = 0;
  int found = 0;
  for (std::size_t k = 0; k < samples.pixels(); ++k) {
    const bool apart = samples.seen_positions[k].y() > 0.25f && samples.stood_positions[k].y() < 0.25f;
    (apart ? outline : all) += samples.pixel_weights[k];
    found += apart ? 1 : 0;
  }
  all += outline;

  // Counts views that leave the floor beside the low plate and meet the high one's rim, among all that meet no plate.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  double rim = 0, seen = 0;
  for (int k = 0; k < 400000; ++k) {
    const bool on_plate = (number(random) + 1) / 2 < 0.25 / 4.25;
    const double reach = on_plate ? 0.25 : 1, x = reach * number(random), z = reach * number(random);
    double across = number(random), along = number(random);
    while (across * across + along * along >= 1) across = number(random), along = number(random);
    const double up = std::sqrt(1 - across * across - along * along);  // a disc's points lifted: by the cosine
    const double px = x + 0.5 * across / up, pz = z + 0.5 * along / up, distance = std::max(std::abs(px), std::abs(pz));
    if (!on_plate && distance < 0.25) continue;
    seen += 1;
    if (!on_plate && distance < 0.255) rim += 1;
  }
  EXPECT_NEAR(outline / all, rim / seen, 0.2 * rim / seen) << "some 60 of them were found";
  EXPECT_GT(found, 5 * 2000 * rim / seen);
}

}  // namespace
}  // namespace kiln
