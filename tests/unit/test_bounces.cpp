// SPDX-License-Identifier: GPL-3.0-or-later
// Bounced light against closed forms, and the ways of gathering it against each other.
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>

#include "bake/bake.h"
#include "bake/egl/bundle_engine.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "bounce_stand.h"
#include "import/import_mesh.h"
#include "sh/directions.h"
#include "shapes.h"

namespace kiln {
namespace test_bounces {

constexpr double t_0 = 0.28209479;

/// Makes transfer of one coefficient that is `value` at every point.
TransferVectors even_transfer(std::size_t points, float value) {
  TransferVectors transfer(points, 1);
  std::fill(transfer.values.begin(), transfer.values.end(), value);
  return transfer;
}

/// Turns a profile (distance from the axis, height) about +Y; a profile that winds counter-clockwise faces outwards.
TriangleMesh revolved(const std::vector<Eigen::Vector2f>& profile, int steps) {
  TriangleMesh mesh;
  const auto rows = static_cast<std::uint32_t>(profile.size());
  for (int step = 0; step < steps; ++step) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(step) / static_cast<float>(steps);
    for (const Eigen::Vector2f& p : profile)
      mesh.positions.emplace_back(p.x() * std::cos(angle), p.y(), -p.x() * std::sin(angle));
  }
  for (std::uint32_t step = 0; step < static_cast<std::uint32_t>(steps); ++step)
    for (std::uint32_t k = 0; k < rows; ++k) {
      const std::uint32_t here = step * rows, there = (step + 1) % static_cast<std::uint32_t>(steps) * rows,
                          next = (k + 1) % rows;
      const std::array<Triangle, 2> pair = {Triangle{here + k, there + k, there + next},
                                            Triangle{here + k, there + next, here + next}};
      mesh.triangles.insert(mesh.triangles.end(), pair.begin(), pair.end());
    }
  compute_vertex_normals(mesh);
  return mesh;
}

/// Places receivers at the centres of every `step`-th triangle that is far enough from the y axis, with its normal.
void stand_on_faces(BounceStand& stand, const TriangleMesh& mesh, std::size_t step, float from_axis) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += step) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const Eigen::Vector3f cross = (q - p).cross(r - p);
    if (!(cross.norm() > 0)) continue;
    const Eigen::Vector3f centre = (p + q + r) / 3;
    if (std::hypot(centre.x(), centre.z()) < from_axis) continue;
    stand.positions.push_back(centre);
    stand.normals.push_back(cross.normalized());
  }
}

/// Tests of bounces with each backend; those on a software GL renderer are smaller.
class Bounces : public testing::TestWithParam<BakeBackend> {
 protected:
  bool egl() const { return GetParam() == BakeBackend::egl; }
  BounceStand stand() const {
    BounceStand stand;
    stand.backend = GetParam();
    if (egl()) {
      stand.settings.shadow_size = 256;
      stand.directions = sample_directions(Sampling::fibonacci, 128, 1);
      order_coherently(stand.directions, block_directions);
    }
    return stand;
  }
};

TEST_P(Bounces, InsideOfASphereIsTheSameEverywhere) {
  // The inside of a closed sphere, lit the same everywhere: every point sees nothing but the sphere, so each bounce is
  // the one before times the albedo, wherever one looks.
  BounceStand stand = this->stand();
  const Eigen::Vector3f albedo(0.8f, 0.5f, 0.1f);
  stand.occluders = join_occluders({inverted(shapes::icosphere(4))}, {SurfaceAlbedo::constant(albedo)});
  for (const Eigen::Vector3f& point : sample_directions(Sampling::fibonacci, 200, 4)) {
    stand.positions.push_back(0.99f * point);
    stand.normals.push_back(-point);
  }
  const SurfaceCache cache = make_surface_cache(stand.occluders, 1);
  BounceReport report;
  const std::vector<TransferVectors> got =
      stand.bounced(cache, even_transfer(cache.size(), 0.25f), {false, 3}, report, even_transfer(200, 0.25f));
  ASSERT_EQ(got.size(), 3u);
  // Each bounce errs by as much as the directions do on the integral of a clamped cosine, at the worst of these
  // normals.
  double worst = 0;
  for (const std::vector<Eigen::Vector3f>& normals : {stand.normals, cache.point_normals})
    for (const Eigen::Vector3f& normal : normals) {
      double sum = 0;
      for (const Eigen::Vector3f& direction : stand.directions) sum += std::max(0.f, normal.dot(direction));
      worst = std::max(worst, std::abs(4 * sum / static_cast<double>(stand.directions.size()) - 1));
    }
  EXPECT_LT(worst, 1e-2);
  const double tolerance = 3 * worst + 1e-5;
  for (int c = 0; c < 3; ++c)
    for (float value : got[c].values)
      EXPECT_NEAR(value, 0.25f * (albedo[c] + std::pow(albedo[c], 2) + std::pow(albedo[c], 3)), tolerance * 0.25);
  ASSERT_EQ(report.energy.size(), 3u);
  for (int bounce = 1; bounce <= 3; ++bounce) {
    const Eigen::Array3d power = albedo.cast<double>().array().pow(bounce);
    EXPECT_NEAR(report.energy[bounce - 1], std::sqrt(power.square().mean()), tolerance);
  }
}

TEST_P(Bounces, BacksReflectNothing) {
  // The same sphere facing outwards: seen from inside, all faces are backs.
  BounceStand stand = this->stand();
  stand.occluders = join_occluders({shapes::icosphere(3)}, {SurfaceAlbedo::constant(Eigen::Vector3f{1, 1, 1})});
  for (const Eigen::Vector3f& point : sample_directions(Sampling::fibonacci, 50, 4)) {
    stand.positions.push_back(0.9f * point);
    stand.normals.push_back(-point);
  }
  const SurfaceCache cache = make_surface_cache(stand.occluders, 1);
  BounceReport report;
  const std::vector<TransferVectors> got =
      stand.bounced(cache, even_transfer(cache.size(), 1), {false, 2}, report, even_transfer(50, 1));
  ASSERT_EQ(got.size(), 1u);
  for (float value : got[0].values) EXPECT_EQ(value, 0.f);
}

TEST_P(Bounces, WhiteBowlInAFurnaceShinesAsTheFurnaceDoes) {
  // A thick bowl of albedo 1 under a uniform sky gets back from itself what its inside loses in shadow, so that
  // every point sends out 1 in the end. Energy is neither made nor lost.
  std::vector<Eigen::Vector2f> profile;
  constexpr int rows = 16;
  for (int k = 0; k <= rows; ++k) {  // outside, from the bottom to the rim, then inside back
    const float angle = 0.5f * std::numbers::pi_v<float> * (static_cast<float>(k) / rows - 1);
    profile.emplace_back(1.1f * std::max(std::cos(angle), 0.01f), 1.1f * std::sin(angle));
  }
  for (int k = rows; k >= 0; --k) {
    const float angle = 0.5f * std::numbers::pi_v<float> * (static_cast<float>(k) / rows - 1);
    profile.emplace_back(std::max(std::cos(angle), 0.01f), std::sin(angle));
  }
  const TriangleMesh bowl = revolved(profile, 48);
  BounceStand stand = this->stand();
  stand.settings.bounces = {.count = 20};
  stand.settings.bounce_edge = 0.1;
  stand.settings.directions = egl() ? 64 : 256;
  if (egl()) stand.settings.bounces = {.count = 10};
  stand.occluders = join_occluders({bowl}, {SurfaceAlbedo::constant(Eigen::Vector3f{1, 1, 1})});
  ASSERT_TRUE(stand.occluders.closed);
  stand_on_faces(stand, bowl, 7, 0.05f);  // not in the pinhole along the axis that the profile leaves
  const BakeResult result = stand.bake();
  ASSERT_EQ(result.channels.size(), 1u);
  ASSERT_TRUE(result.bounces.has_value());
  // Half of the light that leaves a point of the inside leaves the bowl (the mouth has half its area), so after 20
  // bounces 1e-6 of it is still about, after 10 a thousandth. 256 directions err by 1e-3. A depth map of 256 texels and
  // its bias lose some of the light at grazing angles, at the rim and the bottom: 5 %.
  const double tolerance = egl() ? 0.05 : 0.003;
  double mean = 0, dark = 1;
  for (float value : result.channels[0].values) {
    const double radiance = value / t_0;
    EXPECT_NEAR(radiance, 1, 3 * tolerance);
    mean += radiance / static_cast<double>(result.channels[0].receivers);
    dark = std::min(dark, radiance);
  }
  EXPECT_NEAR(mean, 1, tolerance);
  // Without bounces, points inside see half the sky.
  stand.settings.bounces = {.count = 0};
  const BakeResult direct = stand.bake();
  EXPECT_LT(*std::min_element(direct.channels[0].values.begin(), direct.channels[0].values.end()) / t_0, 0.55);
}

/// Computes the part of a point's hemisphere, weighted by the cosine, that a rectangle x0..x1, z0..z1 at height h above
/// it and parallel to it covers (Howell, "A catalog of radiation heat transfer configuration factors", B-4, by
/// corners).
double rectangle_above(double x0, double x1, double z0, double z1, double h) {
  const auto corner = [&](double x, double z) {
    const double a = x / h, b = z / h, p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * std::numbers::pi);
  };
  return corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0);
}

TEST_P(Bounces, ParallelPlatesExchangeWhatFormFactorsSay) {
  // Two unit squares that face each other, half a unit apart; the lower one is lit the same everywhere, the upper one
  // not at all. Bounce 1 reaches the upper alone: albedo times the form factor, in closed form. Bounce 2 comes back to
  // the lower: of bounce 1 as above, over 40 x 40 patches, each with its form factor in closed form.
  constexpr double gap = 0.5, lower_albedo = 0.9, upper_albedo = 0.6;
  BounceStand stand = this->stand();
  TriangleMesh upper = inverted(shapes::plane(1, 1, gap));
  stand.occluders = join_occluders({shapes::plane(1, 1, 0), upper},
                                   {SurfaceAlbedo::constant(Eigen::Vector3f::Constant(lower_albedo)),
                                    SurfaceAlbedo::constant(Eigen::Vector3f::Constant(upper_albedo))});
  const SurfaceCache cache = make_surface_cache(stand.occluders, 0.03);
  TransferVectors lit(cache.size(), 1);
  for (std::size_t p = 0; p < cache.size(); ++p) lit.plane(0)[p] = cache.point_normals[p].y() > 0 ? 1.f : 0.f;
  stand.directions = sample_directions(Sampling::fibonacci, egl() ? 1024 : 4096, 1);
  order_coherently(stand.directions, block_directions);
  const auto first_bounce = [&](double x, double z) {
    return lower_albedo * rectangle_above(-0.5 - x, 0.5 - x, -0.5 - z, 0.5 - z, gap);
  };
  const auto second_bounce = [&](double x, double z) {
    constexpr int patches = 40;
    double sum = 0;
    for (int i = 0; i < patches; ++i)
      for (int j = 0; j < patches; ++j) {
        const double x0 = -0.5 + i / double{patches}, z0 = -0.5 + j / double{patches}, half = 0.5 / patches;
        sum += upper_albedo * first_bounce(x0 + half, z0 + half) *
               rectangle_above(x0 - x, x0 + 2 * half - x, z0 - z, z0 + 2 * half - z, gap);
      }
    return sum;
  };
  for (int k = 0; k < 25; ++k) {
    const float x = -0.4f + 0.2f * static_cast<float>(k % 5), z = -0.4f + 0.2f * static_cast<float>(k / 5);
    stand.positions.emplace_back(x, gap, z);
    stand.normals.emplace_back(0, -1, 0);
    stand.positions.emplace_back(x, 0, z);
    stand.normals.emplace_back(0, 1, 0);
  }
  BounceReport report;
  const std::vector<TransferVectors> got = stand.bounced(cache, lit, {false, 2}, report, even_transfer(50, 1));
  // A plate's edge cuts through the 4,096 directions: a ray weighs 1e-3 at most, and some twenty are cut wrongly, most
  // of which cancel; 0.5 % of 1. Egl finds the edge of a plate by whole texels of 1/500: another 0.5 %.
  const double tolerance = egl() ? 0.015 : 0.005;
  for (std::size_t r = 0; r < stand.positions.size(); ++r) {
    const double x = stand.positions[r].x(), z = stand.positions[r].z();
    const double truth = stand.normals[r].y() < 0 ? first_bounce(x, z) : second_bounce(x, z);
    EXPECT_NEAR(got[0].plane(0)[r], truth, tolerance) << x << ", " << z;
  }
}

INSTANTIATE_TEST_SUITE_P(Bake, Bounces, testing::Values(BakeBackend::egl, BakeBackend::beams, BakeBackend::embree),
                         [](const auto& backend) { return backend_name(backend.param); });

/// Makes the bunny on a floor, both coloured; receivers on the bunny.
BounceStand bunny_on_floor(std::size_t step) {
  BounceStand stand;
  TriangleMesh bunny = load_mesh("/usr/share/glmark2/models/bunny.obj");
  const BoundingBox box = bounding_box(bunny);
  const float size = box.diagonal();
  TriangleMesh floor = shapes::plane(1, 2 * size, box.lowest.y());
  for (Eigen::Vector3f& p : floor.positions) p += Eigen::Vector3f(box.centre().x(), 0, box.centre().z());
  stand.occluders = join_occluders({bunny, floor}, {SurfaceAlbedo::constant(Eigen::Vector3f{0.9f, 0.9f, 0.9f}),
                                                    SurfaceAlbedo::constant(Eigen::Vector3f{0.8f, 0.2f, 0.1f})});
  for (std::size_t v = 0; v < bunny.positions.size(); v += step) {
    stand.positions.push_back(bunny.positions[v]);
    stand.normals.push_back(bunny.normals[v]);
  }
  stand.settings.bands = 3;
  stand.settings.bounces = {.count = 2};
  stand.settings.directions = 128;
  stand.settings.bounce_edge = 0.02;
  return stand;
}

TEST(BounceRays, BeamsAndEmbreeAgree) {
  BounceStand stand = bunny_on_floor(50);
  const BakeResult rays = stand.bake();
  stand.backend = BakeBackend::beams;
  const BakeResult beams = stand.bake();
  ASSERT_EQ(rays.channels.size(), 3u);
  // Rays that pass an edge may differ, as in direct transfer: a few in a million.
  EXPECT_LT(relative_l2(beams.channels, rays.channels), 1e-4);
  EXPECT_GT(relative_l2(std::span(&rays.channels[0], 1), std::span(&rays.channels[2], 1)), 0.05);
}

TEST(BounceRays, ThreadsGiveTheSameBytes) {
  for (BakeBackend backend : {BakeBackend::embree, BakeBackend::beams}) {
    BounceStand stand = bunny_on_floor(100);
    stand.backend = backend;
    stand.settings.directions = 64;
    const BakeResult many = stand.bake();
    const ThreadLimit one(1);
    const BakeResult single = stand.bake();
    for (int c = 0; c < 3; ++c) EXPECT_EQ(many.channels[c].values, single.channels[c].values);
    EXPECT_EQ(many.bounces->energy, single.bounces->energy);
  }
}

TEST(BounceEgl, BundlesAgreeWithRays) {
  BounceStand stand = bunny_on_floor(20);
  stand.settings.directions = 64;
  stand.settings.bounces = {.count = 1};
  stand.settings.shadow_size = 1024;
  // Texels do not resolve the crevice between bunny and floor: rays start above it as well.
  stand.settings.ray_offset = 1e-4;
  std::vector<TransferVectors> bounce[2];  // without the direct light, whose depth maps err by themselves
  double energy[2] = {0, 0};
  for (int k = 0; k < 2; ++k) {
    stand.backend = k == 0 ? BakeBackend::embree : BakeBackend::egl;
    const BakeResult result = stand.bake();
    energy[k] = result.bounces->energy[0];
    bounce[k] = result.channels;
    BounceStand direct = stand;
    direct.settings.bounces = {.count = 0};
    const TransferVectors without = direct.bake().channels[0];
    for (TransferVectors& channel : bounce[k])
      for (std::size_t i = 0; i < channel.values.size(); ++i) channel.values[i] -= without.values[i];
  }
  // A receiver's rays pass through the centres of texels, half a texel of 1/700 of the scene off at most, so at edges
  // one ray in some takes another surface than it should: 3.3 %, noise that does not pile up in the energy.
  EXPECT_LT(relative_l2(bounce[1], bounce[0]), 0.037);
  EXPECT_NEAR(energy[1] / energy[0], 1, 0.01);
}

TEST(BounceEgl, BatchesGiveWhatSingleDirectionsGive) {
  const BounceStand stand = bunny_on_floor(200);
  const SurfaceCache cache = make_surface_cache(stand.occluders, 0.1);
  std::vector<float> sent(cache.size() * 75);
  for (std::size_t k = 0; k < sent.size(); ++k) sent[k] = std::sin(static_cast<float>(k));
  const std::span<const Eigen::Vector3f> directions = std::span(stand.directions).first(70);  // not whole blocks
  ShadowMapSettings settings;
  settings.size_texels = 256;
  std::vector<TransferSums> sums;
  for (int batch : {16, 1}) {
    settings.batch_directions = batch;
    BundleEngine engine(surface_of(cache, stand.occluders), "software", 2, settings);
    engine.set_radiance(sent, 75);
    sums.push_back(engine.gather(stand.receivers(), directions, no_progress));
  }
  EXPECT_EQ(sums[0].values, sums[1].values);
  EXPECT_NE(sums[0].values, TransferSums(stand.positions.size(), 75).values);
}

TEST(BounceCount, AutomaticStopsUnderTheFloor) {
  BounceStand stand = bunny_on_floor(50);
  stand.settings.bounces = {.automatic = true};
  const BakeResult automatic = stand.bake();
  const std::size_t taken = automatic.bounces->energy.size();
  EXPECT_TRUE(automatic.bounces->reached);
  ASSERT_GE(taken, 1u);
  // The same number of bounces, given explicitly, gives the same bytes; the next bounce is below the floor, the last
  // above.
  stand.settings.bounces = {.count = static_cast<int>(taken) + 1};
  const BakeResult more = stand.bake();
  for (std::size_t b = 0; b < taken; ++b) EXPECT_EQ(more.bounces->energy[b], automatic.bounces->energy[b]);
  double total = 1;
  for (double energy : automatic.bounces->energy) total += energy;
  EXPECT_LT(more.bounces->energy[taken], automatic.bounces->floor * total);
  stand.settings.bounces = {.count = static_cast<int>(taken)};
  const BakeResult same = stand.bake();
  for (int c = 0; c < 3; ++c) EXPECT_EQ(same.channels[c].values, automatic.channels[c].values);
}

TEST(BounceCount, IsParsed) {
  EXPECT_TRUE(parse_bounces("auto").automatic);
  EXPECT_EQ(parse_bounces("7").count, 7);
  EXPECT_FALSE(parse_bounces("0").any());
  for (const char* text : {"", "-1", "101", "2.5", "many", "3x"}) EXPECT_THROW(parse_bounces(text), WrongUsage) << text;
}

TEST(SurfaceCache, CutsLongEdgesAndKeepsTheSurface) {
  const TriangleMesh sheet = shapes::plane(1, 2, 0.5f);
  const Occluders occluders = join_occluders(
      {sheet, shapes::icosphere(2)},
      {SurfaceAlbedo::constant(Eigen::Vector3f{1, 1, 1}), SurfaceAlbedo::constant(Eigen::Vector3f{0.5f, 0.5f, 0.5f})});
  const SurfaceCache cache = make_surface_cache(occluders, 0.05);
  const float longest = 0.05f * bounding_box(occluders.mesh).diagonal();
  double area = 0;
  for (std::size_t t = 0; t < cache.triangles.size(); ++t) {
    const auto& [a, b, c] = cache.triangles[t];
    const Eigen::Vector3f &p = cache.positions[a], &q = cache.positions[b], &r = cache.positions[c];
    EXPECT_LE(std::max({(p - q).norm(), (q - r).norm(), (r - p).norm()}), longest * 1.0001f);
    area += 0.5 * (q - p).cross(r - p).norm();
    // Points stand at their corners, or a tenth of the way inside.
    for (int k = 0; k < 3; ++k)
      EXPECT_LT((cache.point_positions[cache.points[t][k]] - cache.positions[cache.triangles[t][k]]).norm(),
                0.1f * longest);
  }
  EXPECT_NEAR(area, surface_area(occluders.mesh), 1e-4 * area);
  for (std::size_t p = 0; p < cache.size(); ++p) {
    const bool on_sheet = std::abs(cache.point_positions[p].y() - 0.5f) < 1e-6f && cache.point_normals[p].y() > 0.999f;
    if (on_sheet && cache.point_positions[p].norm() > 1.01f) {
      EXPECT_EQ(cache.point_albedos[p].x(), 1.f);
    }
    EXPECT_NEAR(cache.point_normals[p].norm(), 1, 1e-5);
  }
}

TEST(SurfaceCache, CreasesStaySharp) {
  // A cube of eight vertices: each is three points, with the normals of its three sides.
  TriangleMesh cube;
  for (int k = 0; k < 8; ++k)
    cube.positions.emplace_back(static_cast<float>(k & 1), static_cast<float>(k >> 1 & 1), static_cast<float>(k >> 2));
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    cube.triangles.push_back({a, b, c});
    cube.triangles.push_back({a, c, d});
  }
  ASSERT_TRUE(is_closed(cube));
  const SurfaceCache cache =
      make_surface_cache(join_occluders({cube}, {SurfaceAlbedo::constant(Eigen::Vector3f{1, 1, 1})}), 1);
  EXPECT_EQ(cache.size(), 24u);
  for (std::size_t p = 0; p < cache.size(); ++p) {
    EXPECT_NEAR(cache.point_normals[p].cwiseAbs().maxCoeff(), 1, 1e-6);
    // The point is on the triangle's own side, inside the border.
    const Eigen::Vector3f out = (cache.point_positions[p] - Eigen::Vector3f::Constant(0.5f));
    EXPECT_NEAR(out.dot(cache.point_normals[p]), 0.5, 1e-6);
  }
}

TEST(SurfaceCache, PointsHaveTheMeanAlbedo) {
  // Red to the left of x = 0, blue to the right: points within a cell of the line have both.
  const TriangleMesh sheet = shapes::plane(8);
  SurfaceAlbedo::Textured textured;
  for (const Eigen::Vector3f& color : {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0, 0, 1)})
    textured.materials.push_back({.color = color, .texture = nullptr});
  for (const auto& [a, b, c] : sheet.triangles)
    textured.material_of.push_back(sheet.positions[a].x() + sheet.positions[b].x() + sheet.positions[c].x() < 0 ? 0u
                                                                                                                : 1u);
  const SurfaceAlbedo halves = SurfaceAlbedo::of_materials(textured, SurfaceAlbedo::Source::materials);
  const SurfaceCache cache = make_surface_cache(join_occluders({sheet}, {halves}), 1);
  EXPECT_FALSE(cache.grey);
  for (std::size_t p = 0; p < cache.size(); ++p) {
    const float x = cache.point_positions[p].x();
    const float red = std::abs(x) < 0.01f ? 0.5f : x < 0 ? 1.f : 0.f;
    EXPECT_NEAR(cache.point_albedos[p].x(), red, std::abs(x) < 0.01f ? 0.2 : 1e-6);
    EXPECT_NEAR(cache.point_albedos[p].x() + cache.point_albedos[p].z(), 1, 1e-6);
  }
}

}  // namespace test_bounces
}  // namespace kiln
