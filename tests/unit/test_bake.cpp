// SPDX-License-Identifier: GPL-3.0-or-later
// Transfer against closed forms, and the two backends against each other.
#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "bake/bake.h"
#include "bake/egl/egl_engine.h"
#include "bake/egl/shadow_frame.h"
#include "bake/planes/coefficient_planes.h"
#include "bake/rays/beam_engine.h"
#include "bake/rays/embree_engine.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "import/import_mesh.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"
#include "shapes.h"

namespace kiln {
namespace test_bake {

constexpr double t_0 = 0.28209479;

/// Makes a triangulated rectangle spanned by two edges.
void add_rectangle(TriangleMesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& a,
                   const Eigen::Vector3f& b) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Eigen::Vector3f& p :
       {corner, Eigen::Vector3f(corner + a), Eigen::Vector3f(corner + a + b), Eigen::Vector3f(corner + b)})
    mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

struct Stand {
  TriangleMesh occluders;
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, 1024, 1);
  int bands = 5;
  int shadow_size = 512;  // spares the software renderer work

  TransferScene scene() const {
    return {occluders.positions, occluders.triangles, occluders.positions, is_closed(occluders)};
  }
  TransferVectors run(TransferEngine& engine) const {
    engine.set_receivers({positions, normals}, bands);
    engine.add(directions, no_progress);
    return engine.sums().transfer();
  }
  TransferVectors egl(ShadowMapSettings settings = {}) const {
    settings.size_texels = shadow_size;
    EglEngine engine(scene(), "software", 0, settings);
    return run(engine);
  }
  TransferVectors beams() const {
    BeamEngine engine(scene(), rounding_offset(occluders.positions));
    return run(engine);
  }
  TransferVectors embree() const {
    EmbreeEngine engine(scene(), rounding_offset(occluders.positions));
    return run(engine);
  }
};

/// Makes points of the unit sphere, which shadows only itself: the furnace.
Stand furnace() {
  Stand bench;
  bench.occluders = shapes::icosphere(5);
  bench.positions = sample_directions(Sampling::fibonacci, 500, 9);
  bench.normals = bench.positions;
  return bench;
}

/// Takes every `step`-th of the bunny's points, scaled as a whole.
Stand bunny_bench(std::size_t step, float scale = 1) {
  Stand bench;
  bench.occluders = load_mesh("/usr/share/glmark2/models/bunny.obj");
  for (Eigen::Vector3f& position : bench.occluders.positions) position *= scale;
  for (std::size_t v = 0; v < bench.occluders.positions.size(); v += step) {
    bench.positions.push_back(bench.occluders.positions[v]);
    bench.normals.push_back(bench.occluders.normals[v]);
  }
  return bench;
}

class Backends : public testing::TestWithParam<BakeBackend> {
 protected:
  TransferVectors compute(const Stand& bench) const {
    if (GetParam() == BakeBackend::beams) return bench.beams();
    return GetParam() == BakeBackend::egl ? bench.egl() : bench.embree();
  }
};

TEST_P(Backends, FurnaceGivesTheUnoccludedTransfer) {
  const Stand bench = furnace();
  const TransferVectors transfer = compute(bench);
  const ShBasis basis(bench.bands);
  for (std::size_t r = 0; r < transfer.receivers; ++r) {
    const std::vector<float> truth = unoccluded_transfer(basis, bench.normals[r]);
    EXPECT_NEAR(transfer.plane(0)[r], t_0, 1e-3 * t_0);
    // 1,024 Fibonacci directions integrate these smooth products to about 1e-4; 1e-3 of t_0 leaves room for grazing
    // directions at the facets.
    for (int i = 0; i < transfer.coefficients; ++i)
      EXPECT_NEAR(transfer.plane(i)[r], truth[i], 1e-3 * t_0) << "coefficient " << i;
  }
}

TEST_P(Backends, TallWallHidesHalfTheSky) {
  // A floor at y = 0 beside a wall in the plane x = 0, tall and long against the distances of the receivers from it:
  // all light from x < 0 is lost.
  Stand bench;
  add_rectangle(bench.occluders, {0, 0, 1000}, {2000, 0, 0}, {0, 0, -2000});
  add_rectangle(bench.occluders, {0, 0, -1000}, {0, 1000, 0}, {0, 0, 2000});
  for (int k = 0; k < 16; ++k) {
    bench.positions.emplace_back(8.f + k, 0.f, static_cast<float>(k) - 8);
    bench.normals.emplace_back(0, 1, 0);
  }
  bench.directions = sample_directions(Sampling::fibonacci, 4096, 1);
  const TransferVectors transfer = compute(bench);
  // t_i = 1/pi times the integral of B_i max(0, y) over the quarter sphere x > 0, y > 0. Bands 0 and 1 in closed form:
  // the integral of y is pi/2, of xy is 2/3, of y^2 is pi/3, of yz is 0.
  const double y_1 = 0.48860251;
  for (std::size_t r = 0; r < transfer.receivers; ++r) {
    // The top edge lies 1.3 degrees over the horizon at most (24 of 1,000), in directions whose cosine is up to 1: it
    // lets in less than 1.5 %.
    EXPECT_NEAR(transfer.plane(0)[r], t_0 / 2, 0.02 * t_0);
    EXPECT_NEAR(transfer.plane(coefficient_index(1, -1))[r], y_1 / 3, 0.02 * t_0);
    EXPECT_NEAR(transfer.plane(coefficient_index(1, 1))[r], y_1 * 2 / (3 * std::numbers::pi), 0.02 * t_0);
    EXPECT_NEAR(transfer.plane(coefficient_index(1, 0))[r], 0, 0.01 * t_0);
  }
}

TEST_P(Backends, ClosedCavityIsDark) {
  Stand bench;
  bench.occluders = shapes::icosphere(4);
  for (const Eigen::Vector3f& point : sample_directions(Sampling::fibonacci, 200, 4)) {
    bench.positions.push_back(0.98f * point);
    bench.normals.push_back(-point);
  }
  const TransferVectors transfer = compute(bench);
  for (float value : transfer.values) EXPECT_EQ(value, 0.f);
}

TEST_P(Backends, ManyBandsGoThroughInChunks) {
  Stand bench = furnace();
  bench.bands = 12;  // 144 coefficients: four chunks of the shader
  bench.directions = sample_directions(Sampling::fibonacci, 2048, 2);
  const TransferVectors transfer = compute(bench);
  const ShBasis basis(bench.bands);
  for (std::size_t r = 0; r < transfer.receivers; r += 50) {
    const std::vector<float> truth = unoccluded_transfer(basis, bench.normals[r]);
    // The products have 12 bands and a kink at the horizon, where facets and texels err as well: 2e-3 of t_0.
    for (int i = 0; i < transfer.coefficients; ++i)
      EXPECT_NEAR(transfer.plane(i)[r], truth[i], 2e-3 * t_0) << "coefficient " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Bake, Backends, testing::Values(BakeBackend::egl, BakeBackend::beams, BakeBackend::embree),
                         [](const auto& backend) { return backend_name(backend.param); });

TEST(BakeEgl, LayersAndBatchesGiveWhatSinglePassesGive) {
  Stand bench = furnace();
  bench.directions.resize(100);  // not a multiple of the batch
  const TransferVectors layers = bench.egl();
  ShadowMapSettings other;
  other.layered_pass = false;
  EXPECT_EQ(layers.values, bench.egl(other).values);
  other.batch_directions = 4;
  EXPECT_EQ(layers.values, bench.egl(other).values);
}

TEST(BakeEgl, AgreesWithRaysOnTheBunny) {
  Stand bench = bunny_bench(4);
  bench.shadow_size = 1024;
  bench.directions = sample_directions(Sampling::fibonacci, 128, 1);
  // At 1,024 directions 3 % is allowed; depth maps of 1,024 texels give about 1.2 %.
  EXPECT_LT(relative_l2(bench.egl(), bench.embree()), 0.02);
}

TEST(BakeRays, ThreadsGiveTheSameBytes) {
  const Stand bench = furnace();
  const TransferVectors streams = bench.embree(), beams = bench.beams();
  const ThreadLimit one(1);
  EXPECT_EQ(streams.values, bench.embree().values);
  EXPECT_EQ(beams.values, bench.beams().values);
}

TEST(BakeBeams, SeeWhatEmbreeSees) {
  // The two round differently, so that rays that pass an edge may differ: a few in a million. A ray's share of a
  // receiver's transfer is about 1/200 here, so one in 10,000 would show as 5e-5.
  for (float scale : {1e-6f, 1.f, 1e6f}) {
    const Stand bench = bunny_bench(7, scale);
    EXPECT_LT(relative_l2(bench.beams(), bench.embree()), 1e-4) << "scaled by " << scale;
  }
  // Receivers inside a closed surface, and an open surface seen from both sides.
  Stand cavity;
  cavity.occluders = shapes::torus(40);
  Stand sheet;
  add_rectangle(sheet.occluders, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
  for (Stand* bench : {&cavity, &sheet}) {
    for (const Eigen::Vector3f& point : sample_directions(Sampling::fibonacci, 1000, 5)) {
      bench->positions.push_back(1.1f * point);
      bench->normals.push_back(-point);
    }
    EXPECT_LT(relative_l2(bench->beams(), bench->embree()), 1e-4);
  }
}

TEST(ShadowFrame, IsTightAndKeepsPoints) {
  // A unit square in the plane z = 0, turned by 30 degrees about z, seen along z: the least rectangle is the square
  // itself.
  const Eigen::Rotation2Df turn(std::numbers::pi_v<float> / 6);
  std::vector<Eigen::Vector3f> hull;
  for (const Eigen::Vector2f& corner :
       {Eigen::Vector2f(0, 0), Eigen::Vector2f(1, 0), Eigen::Vector2f(1, 1), Eigen::Vector2f(0, 1)}) {
    const Eigen::Vector2f turned = turn * corner;
    hull.emplace_back(turned.x(), turned.y(), 0.f);
  }
  const ShadowFrame frame = fit_shadow_frame(hull, Eigen::Vector3f::UnitZ(), 1024, 2);
  EXPECT_NEAR(frame.width * frame.height, std::pow(1024.0 / 1020, 2), 1e-3);
  for (const Eigen::Vector3f& direction : sample_directions(Sampling::fibonacci, 50, 6)) {
    const ShadowFrame any = fit_shadow_frame(hull, direction, 256, 2);
    for (const Eigen::Vector3f& point : hull) {
      const Eigen::Vector4f p = point.homogeneous();
      for (const Eigen::Vector4f& row : {any.row_u, any.row_v, any.row_depth}) {
        EXPECT_GE(row.dot(p), 0);
        EXPECT_LE(row.dot(p), 1);
      }
    }
  }
}

TEST(RangeCompression, RoundTripsWithinHalfAStep) {
  const PlaneRange range{-0.0012f, 0.2821f};
  for (const int bits : {8, 16}) {
    const double step = (static_cast<double>(range.highest) - range.lowest) / ((1 << bits) - 1);
    for (int k = 0; k <= 5000; ++k) {
      const float value =
          static_cast<float>(range.lowest + (static_cast<double>(range.highest) - range.lowest) * k / 5000);
      // The error is half a step, and the rounding of the recovered value to float32.
      EXPECT_LE(std::abs(range.recover(range.store(value, bits), bits) - value), 0.5 * step + 3e-8);
    }
    EXPECT_EQ(range.store(range.lowest, bits), 0u);
    EXPECT_EQ(range.store(range.highest, bits), (1u << bits) - 1);
  }
  const PlaneRange flat{0.25f, 0.25f};
  EXPECT_EQ(flat.store(0.25f, 8), 0u);
  EXPECT_EQ(flat.recover(0, 8), 0.25f);
}

TEST(Occluders, HullHoldsAllAndClosednessIsSeen) {
  const Occluders closed = join_occluders({shapes::icosphere(2)});
  EXPECT_TRUE(closed.closed);
  TriangleMesh floor;
  add_rectangle(floor, {-5, -1, 5}, {10, 0, 0}, {0, 0, -10});
  const Occluders both = join_occluders({shapes::icosphere(2), floor});
  EXPECT_FALSE(both.closed);
  for (const Eigen::Vector3f& direction : sample_directions(Sampling::fibonacci, 100, 8)) {
    const auto support = [&](const std::vector<Eigen::Vector3f>& points) {
      float most = -1e30f;
      for (const Eigen::Vector3f& point : points) most = std::max(most, point.dot(direction));
      return most;
    };
    EXPECT_FLOAT_EQ(support(both.hull), support(both.mesh.positions));
  }
  // A flat occluder has a flat hull.
  EXPECT_EQ(join_occluders({floor}).hull.size(), 4u);
}

}  // namespace test_bake
}  // namespace kiln
