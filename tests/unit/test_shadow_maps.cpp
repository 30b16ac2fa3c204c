// SPDX-License-Identifier: GPL-3.0-or-later
// The options of depth maps (shadow_settings.h), each on scenes whose truth is known.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <ostream>

#include "bake/bake_settings.h"
#include "bake/egl/egl_engine.h"
#include "bake/egl/shadow_refine.h"
#include "bake/integrate/shadow_choice.h"
#include "bake/planes/quantisation_floor.h"
#include "bake/rays/embree_engine.h"
#include "bake/rays/embree_shadow_rays.h"
#include "bake/scene/occluders.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/progress.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"
#include "shapes.h"

namespace kiln {
namespace test_shadow_maps {

constexpr double t_0 = 0.28209479;

struct Stand {
  TriangleMesh occluders;
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, 64, 1);
  TransferWork work;

  TransferScene scene() const {
    return {occluders.positions, occluders.triangles, occluders.positions, is_closed(occluders)};
  }
  TransferVectors run(TransferEngine& engine) {
    engine.set_receivers({positions, normals}, 4);
    engine.add(directions, no_progress);
    work = engine.work();
    return engine.sums().transfer();
  }
  TransferVectors egl(const ShadowMapSettings& settings) {
    EglEngine engine(scene(), "software", 0, settings, make_shadow_rays(scene(), rounding_offset(occluders.positions)));
    return run(engine);
  }
  TransferVectors embree() {
    EmbreeEngine engine(scene(), rounding_offset(occluders.positions));
    return run(engine);
  }
  /// Computes the transfer of the same directions with nothing in the way.
  TransferVectors unshadowed() const {
    TransferSums sums(positions.size(), 16);
    const ShBasis basis(4);
    std::vector<double> values(16);
    for (const Eigen::Vector3f& direction : directions) {
      basis.evaluate<double>(direction.cast<double>(), values);
      for (int i = 0; i < 16; ++i)
        for (std::size_t r = 0; r < positions.size(); ++r)
          sums.plane(i)[r] += to_fixed_point(static_cast<float>(values[i]) * std::max(0.f, normals[r].dot(direction)));
    }
    sums.directions = static_cast<std::int64_t>(directions.size());
    return sums.transfer();
  }
};

/// Takes the vertices of a ball, which shadows only itself.
Stand furnace() {
  Stand stand;
  const TriangleMesh ball = shapes::icosphere(4);
  stand.occluders = ball;
  stand.positions = ball.positions;
  stand.normals = ball.normals;
  return stand;
}

/// Takes points of a torus, which shadows parts of itself.
Stand torus() {
  Stand stand;
  stand.occluders = shapes::torus(96);
  for (std::size_t v = 0; v < stand.occluders.positions.size(); v += 9) {
    const Eigen::Vector3f& p = stand.occluders.positions[v];
    stand.positions.push_back(p);
    stand.normals.push_back((p - Eigen::Vector3f(p.x(), 0, p.z()).normalized()).normalized());
  }
  return stand;
}

struct Tested {
  const char* name;
  ShadowMapSettings settings;
};

/// Names the parameters in failed tests.
void PrintTo(const Tested& tested, std::ostream* stream) { *stream << tested.name; }

template <class Change>
Tested option(const char* name, const Change& change) {
  Tested made{name, {}};
  made.settings.size_texels = 256;  // spares the software renderer work
  change(made.settings);
  return made;
}

const Tested options[] = {
    option("default_", [](auto&) {}),
    option("depth_24", [](auto& s) { s.depth = ShadowDepth::fixed_24; }),
    option("depth_16", [](auto& s) { s.depth = ShadowDepth::fixed_16; }),
    option("filter_2x2", [](auto& s) { s.filter = ShadowFilter::two_by_two; }),
    option("filter_3x3", [](auto& s) { s.filter = ShadowFilter::three_by_three; }),
    option("point_angle_bias",
           [](auto& s) {
             s.receiver_plane = false;
             s.angle_bias_texels = 2;
           }),
    option("point_normal_offset",
           [](auto& s) {
             s.receiver_plane = false;
             s.normal_offset_texels = 1;
           }),
    option("back_faces", [](auto& s) { s.faces = ShadowFaces::back; }),
    option("midpoint", [](auto& s) { s.faces = ShadowFaces::midpoint; }),
    option("triangle_ids", [](auto& s) { s.triangle_ids = true; }),
    option("refine", [](auto& s) { s.refine = true; }),
    option("everything",
           [](auto& s) {
             s.filter = ShadowFilter::three_by_three;
             s.faces = ShadowFaces::midpoint;
             s.triangle_ids = s.refine = true;
           }),
};

class ShadowOptions : public testing::TestWithParam<Tested> {};

TEST_P(ShadowOptions, BallIsLit) {
  Stand stand = furnace();
  // Depth errors count near the horizon alone, where the cosine is small: 1 % of the whole.
  EXPECT_LT(relative_l2(stand.egl(GetParam().settings), stand.unshadowed()), 0.01);
}

TEST_P(ShadowOptions, ThinSheetIsLitFromEitherSide) {
  Stand stand;
  stand.occluders = shapes::plane(8);
  for (int k = 0; k < 50; ++k)
    for (const float side : {-1.f, 1.f}) {
      stand.positions.emplace_back(0.9f * (static_cast<float>(k) / 49 - 0.5f), 0.f,
                                   0.3f - 0.011f * static_cast<float>(k));
      stand.normals.emplace_back(0.f, side, 0.f);
    }
  // The sheet is flat, so the receiver's plane is the occluder: only directions nearly along it may err.
  EXPECT_LT(relative_l2(stand.egl(GetParam().settings), stand.unshadowed()), 0.005);
}

TEST_P(ShadowOptions, HollowBallIsDarkInside) {
  Stand stand;
  TriangleMesh inside = shapes::icosphere(4, 0.9f);
  for (Triangle& triangle : inside.triangles) std::swap(triangle[1], triangle[2]);
  stand.occluders = shapes::joined(shapes::icosphere(4), inside, Eigen::Vector3f::Zero());
  ASSERT_TRUE(is_closed(stand.occluders));
  for (const Eigen::Vector3f& point : sample_directions(Sampling::fibonacci, 200, 4)) {
    stand.positions.push_back(0.89f * point);
    stand.normals.push_back(-point);
  }
  for (float value : stand.egl(GetParam().settings).values) EXPECT_EQ(value, 0.f);
}

TEST_P(ShadowOptions, TorusShadowsItselfAsRaysSay) {
  Stand stand = torus();
  // Maps of 256 texels: about 2 % for the default.
  EXPECT_LT(relative_l2(stand.egl(GetParam().settings), stand.embree()), 0.04);
}

TEST_P(ShadowOptions, BatchesGiveTheSameBytes) {
  Stand stand = torus();
  stand.directions.resize(50);  // neither a multiple of the block nor of a batch
  ShadowMapSettings settings = GetParam().settings;
  const TransferVectors first = stand.egl(settings);
  const TransferWork work = stand.work;
  settings.batch_directions = 4;
  settings.layered_pass = false;
  EXPECT_EQ(first.values, stand.egl(settings).values);
  EXPECT_EQ(work.ambiguous, stand.work.ambiguous);
}

TEST_P(ShadowOptions, RegionsChangeNoBit) {
  // Tiles of 8 x 8 points under a plate: some see it before all of a direction's light, some before none.
  Stand plate;
  plate.occluders = shapes::plane(8);
  for (Eigen::Vector3f& position : plate.occluders.positions) position.y() += 0.3f;
  for (int tile = 0; tile < 36; ++tile)
    for (int point = 0; point < 64; ++point) {
      plate.positions.emplace_back(0.2f * static_cast<float>(tile % 6) - 0.6f + 0.02f * static_cast<float>(point % 8),
                                   0.f,
                                   0.2f * static_cast<float>(tile / 6) - 0.6f + 0.02f * static_cast<float>(point / 8));
      plate.normals.emplace_back(0, 1, 0);
    }
  for (Stand stand : {plate, torus()}) {
    stand.directions = sample_directions(Sampling::fibonacci, 40, 1);
    ShadowMapSettings settings = GetParam().settings;
    const TransferVectors without = stand.egl(settings);
    const TransferWork work = stand.work;
    settings.regions = true;
    EXPECT_EQ(without.values, stand.egl(settings).values);
    EXPECT_EQ(work.ambiguous, stand.work.ambiguous);
    if (stand.positions.size() != plate.positions.size()) continue;
    EXPECT_GT(stand.work.lit_tiles, 0u);
    // With ids the nearest triangle may be one that casts no shadow.
    EXPECT_TRUE(settings.triangle_ids || stand.work.shadowed_tiles > 0);
    EXPECT_LE(stand.work.lit_tiles + stand.work.shadowed_tiles + stand.work.behind_tiles, stand.work.pairs);
  }
}

TEST(ShadowMaps, SumsAreTrueForAnyNumberOfDirections) {
  // All that could shadow lies below, so that the sums are known: in float64, from the same float32 directions.
  Stand stand;
  stand.occluders = shapes::plane(1);
  for (const Eigen::Vector3f& normal : {Eigen::Vector3f(0, 1, 0), Eigen::Vector3f(0.1f, 0.99f, -0.05f).normalized()}) {
    stand.positions.emplace_back(0.f, 50.f, 0.f);
    stand.normals.push_back(normal);
  }
  ShadowMapSettings settings;
  settings.size_texels = 16;
  const ShBasis basis(4);
  for (const int count : {1, 1000, 1000000}) {
    // Take only the sphere's upper part, where no receiver can look down at the plane.
    stand.directions = sample_directions(Sampling::fibonacci, count + 1, 1);
    std::erase_if(stand.directions, [](const Eigen::Vector3f& direction) { return direction.y() < 0.2f; });
    if (count == 1) stand.directions = {Eigen::Vector3f(0.3f, 0.8f, 0.5f).normalized()};
    EglEngine engine(stand.scene(), "software", 0, settings);
    stand.run(engine);
    const TransferSums sums = engine.sums();
    double squared_error = 0, squared = 0;
    std::vector<double> values(16);
    for (std::size_t r = 0; r < 2; ++r) {
      std::vector<double> expected(16, 0);
      for (const Eigen::Vector3f& direction : stand.directions) {
        basis.evaluate<double>(direction.cast<double>(), values);
        const double cosine = stand.normals[r].cast<double>().dot(direction.cast<double>());
        for (int i = 0; i < 16; ++i) expected[i] += std::max(0.0, cosine) * values[i];
      }
      for (int i = 0; i < 16; ++i) {
        const double error = static_cast<double>(sums.plane(i)[r]) / fixed_point_one - expected[i];
        squared_error += error * error;
        squared += expected[i] * expected[i];
      }
    }
    EXPECT_LT(std::sqrt(squared_error / squared), 1e-5) << count << " directions";
  }
}

INSTANTIATE_TEST_SUITE_P(Bake, ShadowOptions, testing::ValuesIn(options),
                         [](const auto& tested) { return tested.param.name; });

TEST(ShadowMaps, TriangleIdsRemoveSelfShadowingWithoutAnyBias) {
  Stand stand = furnace();
  ShadowMapSettings settings;
  settings.size_texels = 256;
  settings.depth_bias = 0;
  settings.angle_bias_texels = settings.normal_offset_texels = 0;
  settings.receiver_plane = false;
  const TransferVectors truth = stand.unshadowed();
  EXPECT_GT(relative_l2(stand.egl(settings), truth), 0.2);  // acne
  settings.triangle_ids = true;
  EXPECT_LT(relative_l2(stand.egl(settings), truth), 0.01);
}

TEST(ShadowMaps, RefiningGivesWhatRaysGive) {
  Stand stand = torus();
  ShadowMapSettings settings;
  settings.size_texels = 256;
  const TransferVectors rays = stand.embree();
  const double unrefined = relative_l2(stand.egl(settings), rays);
  EXPECT_EQ(stand.work.ambiguous, 0u);  // nobody asked
  settings.refine = true;
  const double refined = relative_l2(stand.egl(settings), rays);
  // Remaining errors: whole occluders between texels, and creases thinner than the offset. The torus has neither.
  EXPECT_LT(refined, 0.004);
  EXPECT_LT(refined, 0.4 * unrefined);
  EXPECT_EQ(stand.work.ambiguous, stand.work.refined);
  EXPECT_GT(stand.work.ambiguous, 0u);
  EXPECT_LT(static_cast<double>(stand.work.ambiguous), 0.1 * static_cast<double>(stand.work.pairs));
}

TEST(ShadowMaps, CountingChangesNoByte) {
  Stand stand = torus();
  ShadowMapSettings settings;
  settings.size_texels = 256;
  settings.filter = ShadowFilter::two_by_two;
  const TransferVectors uncounted = stand.egl(settings);
  settings.count_ambiguous = true;
  EXPECT_EQ(uncounted.values, stand.egl(settings).values);
  EXPECT_GT(stand.work.ambiguous, 0u);
  EXPECT_EQ(stand.work.refined, 0u);
}

TEST(ShadowRefine, MarksGoAndRaysDecideThem) {
  const std::vector<Eigen::Vector3f> points(3, Eigen::Vector3f::Zero()), normals(3, Eigen::Vector3f::UnitY()),
      directions = {Eigen::Vector3f::UnitY(), Eigen::Vector3f(0, 0.6f, 0.8f)};
  const std::vector<std::uint32_t> tiles = {0};
  const std::vector<float> marked = {1, -0.f, 0, -0.3f, 0.6f, -0.6f};
  TransferWork work;
  std::vector<float> weights = marked;
  EXPECT_TRUE(resolve_ambiguous({weights, 0, 3, tiles}, {points, normals}, directions, false, {}, work));
  EXPECT_EQ(weights, (std::vector<float>{1, 0, 0, 0.3f, 0.6f, 0.6f}));
  EXPECT_FALSE(std::signbit(weights[1]));
  EXPECT_EQ(work.ambiguous, 3u);
  EXPECT_EQ(work.refined, 0u);

  ShadowRays rays;
  rays.occluded = [](const Receivers&, std::span<ShadowRayQuery> queries) {
    EXPECT_EQ(queries[0].receivers, std::vector<std::uint32_t>{1});
    EXPECT_EQ(queries[1].receivers, (std::vector<std::uint32_t>{0, 2}));
    queries[0].occluded[0] = 0;
    queries[1].occluded = {1, 0};
  };
  weights = marked;
  EXPECT_TRUE(resolve_ambiguous({weights, 0, 3, tiles}, {points, normals}, directions, true, rays, work));
  EXPECT_EQ(weights, (std::vector<float>{1, 1, 0, 0, 0.6f, 0.6f}));
  EXPECT_EQ(work.refined, 3u);
  EXPECT_FALSE(resolve_ambiguous({weights, 0, 3, tiles}, {points, normals}, directions, true, rays, work));
}

TEST(ShadowChoice, TakesTheSmallestMapUnderTheFloor) {
  Stand stand = torus();
  const Occluders occluders = join_occluders({stand.occluders});
  BakeSettings settings;
  settings.bands = 4;
  settings.directions = 64;
  settings.shadows.refine = true;
  const ReceiverSet receivers{static_cast<int>(stand.positions.size()), 1, {}, stand.positions, stand.normals};
  const ShadowSizeChoice choice = choose_shadow_size(receivers.view(), {receivers, occluders, settings, 1});
  EXPECT_TRUE(choice.reached);
  EXPECT_EQ(choice.size_texels, 256);  // RefiningGivesWhatRaysGive: 0.4 % at most
  EXPECT_LE(choice.error, choice.floor);
  EXPECT_NEAR(choice.floor, quantisation_floor(stand.embree(), 8), 0.1 * choice.floor);
  // Maps alone need more texels.
  settings.shadows.refine = false;
  settings.directions = 16;
  const ShadowSizeChoice alone = choose_shadow_size(receivers.view(), {receivers, occluders, settings, 1});
  EXPECT_GT(alone.size_texels, 256);
  EXPECT_EQ(alone.reached, alone.error <= alone.floor);
}

TEST(ShadowSettings, SizeIsANumberOrAuto) {
  BakeSettings settings;
  const OptionSet set = bake_options(settings);
  const Option* size = set.find("shadow-size");
  ASSERT_NE(size, nullptr);
  EXPECT_EQ(size->get(), 1024);
  size->set("auto");
  EXPECT_EQ(settings.shadow_size, 0);
  EXPECT_EQ(size->get(), "auto");
  size->set("512");
  EXPECT_EQ(settings.shadow_size, 512);
  for (const char* wrong : {"0", "15", "16385", "512x", ""}) EXPECT_THROW(size->set(wrong), WrongUsage) << wrong;
}

}  // namespace test_shadow_maps
}  // namespace kiln
