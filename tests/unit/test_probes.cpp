// SPDX-License-Identifier: GPL-3.0-or-later
// Probes in space: matrices against closed forms, what is inside, the files, and what a renderer asks of them.
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>

#include "asset/probe_set.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/parallel.h"
#include "mesh/winding.h"
#include "probes/probe_points.h"
#include "probes/probes.h"
#include "probes/surface_light.h"
#include "scratch.h"
#include "sh/basis.h"
#include "shapes.h"

namespace kiln {
namespace {

namespace fs = std::filesystem;

ProbesResult at(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& points, const ProbesSettings& settings,
                const SurfaceLight& light = {}) {
  return probe_matrices(mesh, light, place_probes(mesh, points, settings), settings, 1);
}

/// Integrates B_i B_j over the upper half sphere, +Y, by products of Gauss-Legendre points in height and equal steps in
/// azimuth: exact, except for rounding, for polynomials of degree up to 2 (bands - 1).
std::vector<double> half_sphere_matrix(int bands) {
  // Gauss-Legendre on [0, 1] by Newton's method ([Press], section 4.6).
  constexpr int order = 16, steps = 64;
  const ShBasis basis(bands);
  const auto size = static_cast<std::size_t>(basis.size());
  std::vector<double> matrix(size * size, 0.0), values(size);
  for (int k = 0; k < order; ++k) {
    double x = std::cos(std::numbers::pi * (k + 0.75) / (order + 0.5)), slope = 0;
    for (int round = 0; round < 20; ++round) {
      double p0 = 1, p1 = x;
      for (int n = 2; n <= order; ++n) std::swap(p0, p1), p1 = ((2 * n - 1) * x * p0 - (n - 1) * p1) / n;
      slope = order * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    const double height = (x + 1) / 2, weight = 1 / ((1 - x * x) * slope * slope);
    for (int s = 0; s < steps; ++s) {
      const double azimuth = 2 * std::numbers::pi * s / steps, ring = std::sqrt(1 - height * height);
      basis.evaluate<double>(Eigen::Vector3d(ring * std::cos(azimuth), height, ring * std::sin(azimuth)), values);
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j)
          matrix[i * size + j] += weight * 2 * std::numbers::pi / steps * values[i] * values[j];
    }
  }
  return matrix;
}

TEST(Probes, EmptySpaceGivesTheIdentity) {
  ProbesSettings settings;
  settings.directions = 64;  // the correction makes any number do
  const ProbesResult result = at(TriangleMesh{}, {{0, 0, 0}, {3, -1, 2}}, settings);
  for (std::size_t probe = 0; probe < 2; ++probe) {
    EXPECT_NE(result.probes.valid[probe], 0);
    const std::span<const float> matrix = result.probes.matrix(probe, 0);
    for (std::size_t k = 0; k < matrix.size(); ++k) EXPECT_NEAR(matrix[k], k % 26 == 0 ? 1 : 0, 1e-6) << k;
  }
  EXPECT_EQ(result.open_share, 1);
}

TEST(Probes, AboveABlackPlaneTheUpperHalfSphereIsLeft) {
  ProbesSettings settings;
  settings.directions = 16384;
  // Seen from 0.001 above, a square of 1,000 covers all but 2e-6 of the lower half sphere.
  const ProbesResult result = at(shapes::plane(2, 1000), {{0.1f, 0.001f, 0.2f}, {0.1f, -0.001f, 0.2f}}, settings);
  const std::vector<double> expected = half_sphere_matrix(5);
  ASSERT_NEAR(expected[0], 0.5, 1e-12);
  double upper = 0, lower = 0, norm = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double identity = k % 26 == 0 ? 1 : 0;
    upper = std::max(upper, std::abs(result.probes.matrix(0, 0)[k] - expected[k]));
    lower = std::max(lower, std::abs(result.probes.matrix(1, 0)[k] - (identity - expected[k])));
    norm = std::max(norm, std::abs(expected[k]));
  }
  // 16,384 Fibonacci directions integrate products with an edge at the horizon to about count^-3/4, 7e-4.
  EXPECT_LT(upper, 2e-3);
  EXPECT_LT(lower, 2e-3);
  EXPECT_NEAR(result.open_share, 0.5, 1e-3);
  EXPECT_GT(norm, 0.4);
  // A plane goes around nothing.
  EXPECT_EQ(result.invalid(), 0u);
}

TEST(Probes, WithoutBouncesMatricesAreSymmetricAndOfEigenvaluesBetween0And1) {
  ProbesSettings settings;
  settings.bands = 3;
  settings.directions = 512;
  const ProbesResult result =
      at(shapes::torus(24), {{0, 0, 0}, {0.3f, 0.1f, -0.2f}, {0, 0.6f, 1}, {2, 0, 0}}, settings);
  EXPECT_EQ(result.invalid(), 0u);
  for (std::size_t probe = 0; probe < 4; ++probe) {
    const std::span<const float> matrix = result.probes.matrix(probe, 0);
    double trace = 0;
    for (std::size_t i = 0; i < 9; ++i) {
      trace += matrix[i * 9 + i];
      for (std::size_t j = 0; j < 9; ++j) EXPECT_NEAR(matrix[i * 9 + j], matrix[j * 9 + i], 1e-6);
    }
    // Light is blocked, never added: x' M x is the power that passes. The trace is that of all nine functions.
    EXPECT_GT(trace, 9 * 0.2);
    EXPECT_LT(trace, 9);
  }
}

TEST(Probes, ATurnedSceneGivesTheSameToConstantLight) {
  // M_00 is the open share of the sky, whatever stands around.
  ProbesSettings settings;
  settings.bands = 2;
  settings.directions = 4096;
  const TriangleMesh ball = shapes::icosphere(3);
  const ProbesResult result = at(ball, {{2, 0, 0}, {0, -2, 0}, {1.2f, 1.2f, 1.2f}}, settings);
  for (std::size_t probe = 0; probe < 3; ++probe) {
    const double distance = result.probes.positions[probe].norm();
    const double open = 1 - (1 - std::sqrt(1 - 1 / (distance * distance))) / 2;  // all but the cap that the ball covers
    // The polyhedron lies up to 0.4 % inside of the ball; 4,096 directions count areas to 1e-3.
    EXPECT_NEAR(result.probes.matrix(probe, 0)[0], open, 3e-3) << distance;
  }
}

TEST(Probes, PointsInsideSolidsAreNotValid) {
  const TriangleMesh two = shapes::joined(shapes::icosphere(2), shapes::cube(3), {3, 0, 0});
  EXPECT_NEAR(winding_number(two, {0.5f, 0.2f, 0.1f}), 1, 1e-9);
  EXPECT_NEAR(winding_number(two, {3.4f, 0.4f, -0.4f}), 1, 1e-9);
  EXPECT_NEAR(winding_number(two, {1.7f, 0, 0}), 0, 1e-9);
  ProbesSettings settings;
  settings.bands = 1;
  settings.directions = 64;
  settings.grid = {9, 3, 3};
  settings.box = std::array{-0.9f, -0.9f, -0.9f, 3.1f, 0.9f, 0.9f};
  const ProbesResult result = at(two, {}, settings);
  ASSERT_EQ(result.probes.positions.size(), 81u);
  for (std::size_t k = 0; k < 81; ++k) {
    const Eigen::Vector3f& p = result.probes.positions[k];
    const bool in_ball = p.norm() < 0.95f, in_cube = (p - Eigen::Vector3f(3, 0, 0)).cwiseAbs().maxCoeff() < 0.5f;
    if (p.norm() > 0.95f && p.norm() < 1.01f) continue;  // the polyhedron is not quite the ball
    EXPECT_EQ(result.probes.valid[k] == 0, in_ball || in_cube) << p.transpose();
  }
  // The winding number in the middle of a sphere with a hole is the share of the sphere that is left.
  TriangleMesh open = shapes::icosphere(2);
  std::erase_if(open.triangles, [&](const Triangle& t) { return open.positions[t[0]].y() > 0.8f; });
  EXPECT_GT(winding_number(open, Eigen::Vector3d::Zero()), 0.8);
  EXPECT_LT(winding_number(open, Eigen::Vector3d::Zero()), 0.99);
}

/// A scene of one mesh of constant albedo, its light, and the probes in it.
ProbesResult lit(const TriangleMesh& mesh, const Eigen::Vector3f& albedo, const std::vector<Eigen::Vector3f>& points,
                 const ProbesSettings& settings) {
  SceneMesh scene;
  scene.add(mesh, SurfaceAlbedo::constant(albedo));
  return at(mesh, points, settings, light_surface(scene, settings, 1));
}

TEST(Probes, WhiteSurfacesKeepConstantLight) {
  // The lower half of a sphere, its front inside. What is white neither makes nor takes light, so with the same
  // radiance from everywhere there is the same radiance everywhere.
  TriangleMesh bowl = shapes::icosphere(3);
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return bowl.positions[t[0]].y() + bowl.positions[t[1]].y() + bowl.positions[t[2]].y() > 0;
  });
  for (Triangle& t : bowl.triangles) std::swap(t[1], t[2]);
  ProbesSettings settings;
  settings.bands = 2;
  settings.bounces = {.automatic = true};
  settings.bounce_edge = 0.1;
  const std::vector<Eigen::Vector3f> points = {{0, 0, 0}, {0.3f, -0.5f, 0.2f}, {0, -0.8f, 0}};
  const ProbesResult result = lit(bowl, {1, 1, 1}, points, settings);
  EXPECT_EQ(result.invalid(), 0u);
  EXPECT_GT(result.bounces, 3);
  ProbesSettings once = settings;
  once.bounces = {.count = 1};
  const ProbesResult single = lit(bowl, {1, 1, 1}, points, once);
  for (std::size_t probe = 0; probe < 3; ++probe) {
    const std::span<const float> matrix = result.probes.matrix(probe, 0);
    // Light bounces until a thousandth is left; 1,024 directions and a cut surface leave some more.
    EXPECT_NEAR(matrix[0], 1, 0.01) << probe;
    for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(matrix[i * 4], 0, 0.01) << probe << " " << i;
    EXPECT_LT(single.probes.matrix(probe, 0)[0], 0.9);
  }
}

TEST(Probes, AboveAWhitePlaneTheSkyIsMirroredDiffusely) {
  // A plane of albedo rho sends up rho t_j = rho A_j / pi Y_j(n) of the coefficient j, the same from everywhere:
  // M = half sphere + (integral of B_i over the lower half) rho t_j.
  ProbesSettings settings;
  settings.bands = 3;
  settings.directions = 4096;
  settings.bounces = {.count = 2};  // the second adds nothing, as a plane does not see itself
  settings.bounce_edge = 0.2;
  const ProbesResult result = lit(shapes::plane(2, 1000), {0.5f, 0.5f, 0.5f}, {{1, 0.01f, 2}}, settings);
  EXPECT_EQ(result.probes.channels, 1);
  EXPECT_NEAR(result.last_bounce_share, 0, 1e-6);
  const std::vector<double> upper = half_sphere_matrix(3);
  const std::vector<float> transfer = unoccluded_transfer(ShBasis(3), Eigen::Vector3f::UnitY());
  const double y00 = 0.2820947918;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j) {
      // B_0 is constant, so the integral of B_i over the upper half is that of B_i B_0, over B_0.
      const double lower_i = ((i == 0 ? 1 : 0) - upper[i * 9]) / y00;
      const double expected = upper[i * 9 + j] + 0.5 * lower_i * transfer[j];
      // 4,096 directions with an edge at the horizon, here and in the transfer.
      EXPECT_NEAR(result.probes.matrix(0, 0)[i * 9 + j], expected, 5e-3) << i << " " << j;
    }
}

TEST(Probes, ColoredSurfacesGiveThreeChannels) {
  ProbesSettings settings;
  settings.bands = 2;
  settings.directions = 512;
  settings.bounces = {.count = 1};
  settings.bounce_edge = 0.5;
  const TriangleMesh floor = shapes::plane(2, 100);
  const ProbesResult dark = at(floor, {{0, 0.1f, 0}}, settings);
  const ProbesResult red = lit(floor, {0.8f, 0.2f, 0}, {{0, 0.1f, 0}}, settings);
  ASSERT_EQ(red.probes.channels, 3);
  for (std::size_t k = 0; k < 16; ++k) {
    // One bounce is in proportion to the albedo.
    const double bounced = red.probes.matrix(0, 0)[k] - dark.probes.matrix(0, 0)[k];
    EXPECT_NEAR(red.probes.matrix(0, 1)[k] - dark.probes.matrix(0, 0)[k], bounced / 4, 1e-5);
    EXPECT_NEAR(red.probes.matrix(0, 2)[k], dark.probes.matrix(0, 0)[k], 1e-6);
  }
  EXPECT_GT(red.probes.matrix(0, 0)[0], dark.probes.matrix(0, 0)[0] + 0.3);
}

TEST(Probes, TheSameWithAnyThreads) {
  ProbesSettings settings;
  settings.bands = 3;
  settings.bounces = {.count = 2};
  settings.grid = {4, 3, 2};
  settings.directions = 300;
  std::vector<float> matrices[2];
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    matrices[threads == 4] = lit(shapes::torus(16), {0.5f, 0.6f, 0.7f}, {}, settings).probes.matrices;
  }
  EXPECT_EQ(matrices[0], matrices[1]);
}

// ---- what a renderer asks ----

/// Makes matrices of one band: the light times `value(position)`.
template <class Value>
ProbeSet scalar_probes(const ProbeGrid& grid, const Value& value) {
  ProbeSet probes;
  probes.bands = 1;
  probes.grid = grid;
  for (std::size_t k = 0; k < grid.count(); ++k) {
    probes.positions.push_back(grid.position(k));
    probes.valid.push_back(1);
    probes.matrices.push_back(value(probes.positions.back()));
  }
  return probes;
}

double light_of(const ProbeSet& probes, const Eigen::Vector3f& position) {
  return light_at(probes, position, {1, {{1.f}}}).channels[0][0];
}

TEST(ProbeSet, TrilinearIsExactForLinearFunctions) {
  const auto linear = [](const Eigen::Vector3f& p) { return 1 + 2 * p.x() - p.y() + 0.5f * p.z(); };
  const ProbeGrid grid{{4, 3, 2}, {-1, 0, 2}, {2, 1, 5}};
  const ProbeSet probes = scalar_probes(grid, linear);
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(0.3f, 0.7f, 4.1f), {-1, 0, 2}, {2, 1, 5}, {1, 0.5f, 3}})
    EXPECT_NEAR(light_of(probes, p), linear(p), 1e-5);
  // Beyond the grid the value is that of the border.
  EXPECT_NEAR(light_of(probes, {9, 0.5f, -3}), linear({2, 0.5f, 2}), 1e-5);
  // An axis of one point does not vary.
  const ProbeSet flat = scalar_probes({{2, 1, 1}, {0, 0, 0}, {1, 4, 4}}, linear);
  EXPECT_NEAR(light_of(flat, {0.25f, 3, 1}), linear({0.25f, 2, 2}), 1e-5);
}

TEST(ProbeSet, InvalidPointsAreLeftOut) {
  ProbeSet probes =
      scalar_probes({{3, 1, 1}, {0, 0, 0}, {2, 0, 0}}, [](const Eigen::Vector3f& p) { return p.x() + 1; });
  probes.valid[0] = 0;
  probes.matrices[0] = 100;
  EXPECT_NEAR(light_of(probes, {0.25f, 0, 0}), 2, 1e-6);  // of the cell's corners only the upper one is left
  probes.valid[1] = 0;
  EXPECT_NEAR(light_of(probes, {0.25f, 0, 0}), 3, 1e-6);  // the nearest that is valid
  probes.valid[2] = 0;
  EXPECT_NEAR(light_of(probes, {0.25f, 0, 0}), 1, 1e-6);  // the light itself
}

TEST(ProbeSet, PointsAnywhereWeighByDistance) {
  ProbeSet probes;
  probes.bands = 1;
  probes.positions = {{0, 0, 0}, {3, 0, 0}};
  probes.valid = {1, 1};
  probes.matrices = {1, 5};
  EXPECT_NEAR(light_of(probes, {0, 0, 0}), 1, 1e-6);
  EXPECT_NEAR(light_of(probes, {1, 0, 0}), (4 * 1 + 1 * 5) / 5.0, 1e-5);  // distances 1 and 2
}

TEST(ProbeSet, AppliesMatricesByRowsAndChannels) {
  ProbeSet probes;
  probes.bands = 2;
  probes.channels = 3;
  probes.positions = {{0, 0, 0}};
  probes.valid = {1};
  probes.matrices.assign(48, 0.f);
  probes.matrices[0 * 16 + 1 * 4 + 2] = 2;  // red: L'_1 = 2 L_2
  probes.matrices[2 * 16 + 3 * 4 + 0] = 5;  // blue: L'_3 = 5 L_0
  // One channel far away, three here; bands beyond the probes' are dropped, missing ones are zero.
  const LightCoefficients light = light_at(probes, {0, 0, 0}, {3, {{1, 2, 3, 4, 5, 6, 7, 8, 9}}});
  ASSERT_EQ(light.channels.size(), 3u);
  EXPECT_EQ(light.bands, 2);
  EXPECT_EQ(light.channels[0], (std::vector<float>{0, 6, 0, 0}));
  EXPECT_EQ(light.channels[1], (std::vector<float>{0, 0, 0, 0}));
  EXPECT_EQ(light.channels[2], (std::vector<float>{0, 0, 0, 5}));
  EXPECT_EQ(light_at(probes, {0, 0, 0}, {1, {{1}}}).channels[2], (std::vector<float>{0, 0, 0, 5}));
  EXPECT_THROW(light_at(probes, {0, 0, 0}, {1, {{1}, {1}}}), std::invalid_argument);
}

// ---- the files ----

ProbeSet saved(const fs::path& folder, const ProbeSet& probes) {
  OutputSet outputs(folder);
  save_probes(outputs, probes);
  outputs.commit();
  return load_probes(folder);
}

TEST(ProbeFiles, ReadBackWithinAStep) {
  const Scratch scratch;
  ProbesSettings settings;
  settings.bands = 2;
  settings.directions = 256;
  settings.grid = {3, 4, 2};
  const ProbeSet probes = at(shapes::icosphere(2), {}, settings).probes;
  const ProbeSet read = saved(scratch.folder(), probes);
  ASSERT_TRUE(read.grid);
  EXPECT_EQ(read.grid->size, probes.grid->size);
  EXPECT_EQ(read.positions, probes.positions);
  EXPECT_EQ(read.valid, probes.valid);
  ASSERT_EQ(read.matrices.size(), probes.matrices.size());
  for (std::size_t k = 0; k < read.matrices.size(); ++k) {
    if (probes.valid[k / probes.entries()] == 0) continue;
    EXPECT_NEAR(read.matrices[k], probes.matrices[k],
                2 / 65535.0);  // half a step of a range of 2 at most, and rounding
  }

  ProbeSet points = probes;
  points.grid.reset();
  EXPECT_EQ(saved(scratch.folder() / "points", points).positions, probes.positions);
}

TEST(ProbeFiles, RefuseWhatIsMalformed) {
  const Scratch scratch;
  ProbesSettings settings;
  settings.bands = 1;
  settings.grid = {2, 2, 1};
  saved(scratch.folder(), at(shapes::icosphere(0), {}, settings).probes);
  const fs::path file = scratch.folder() / probes_json_name;
  const Json good = Json::parse(read_text(file));
  const auto refusal = [&](const std::string& pointer, const Json& value) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    std::ofstream(file) << bad.dump();
    try {
      load_probes(scratch.folder());
    } catch (const BadInput& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  struct Case {
    const char *pointer, *value, *said;
  };
  for (const Case& c : {Case{"/format", "\"kiln-prt\"", "kiln-probes"},
                        {"/version", "3", "version"},
                        {"/bands", "9", "bands"},
                        {"/channels", "2", "channels"},
                        {"/grid/size", "[2,2]", "grid.size"},
                        {"/grid/size", "[0,2,2]", "grid.size"},
                        {"/grid/size", "[1024,1024,1024]", "points"},
                        {"/grid/lower", "[1e9,0,0]", "upper"},
                        {"/grid/upper", "[0,\"x\",0]", "grid.upper"},
                        {"/invalid", "[4]", "invalid"},
                        {"/invalid", "3", "invalid"},
                        {"/ranges", "[]", "ranges"},
                        {"/ranges/0/min", "1e6", "ranges[0].min"},
                        {"/ranges/0/max", "null", "ranges[0].max"},
                        {"/matrices_file", "\"../x.png\"", "matrices_file"},
                        {"/matrices_file", "\"none.png\"", "none.png"},
                        {"/grid/size", "[2,2,2]", "matrices.png"}})
    EXPECT_NE(refusal(c.pointer, Json::parse(c.value)).find(c.said), std::string::npos)
        << c.pointer << " " << c.value << ": " << refusal(c.pointer, Json::parse(c.value));
  EXPECT_EQ(refusal("/version", 1), "taken");
}

TEST(ProbePoints, ReadsLines) {
  const Scratch scratch;
  const fs::path file = scratch.folder() / "points.txt";
  std::ofstream(file) << "# where\n0 1 2\n\n  -1.5 2e-1\t3 # here\n";
  EXPECT_EQ(read_points(file), (std::vector<Eigen::Vector3f>{{0, 1, 2}, {-1.5f, 0.2f, 3}}));
  for (const char* text : {"", "# none\n", "1 2\n", "1 2 3 4\n", "1 2 x\n", "1 2 nan\n", "1e13 0 0\n", "0 0 -1e38\n"}) {
    std::ofstream(file, std::ios::trunc) << text;
    EXPECT_THROW(read_points(file), BadInput) << text;
  }
}

TEST(ProbesSettings, GridsAndBoxes) {
  EXPECT_EQ(parse_grid("2x3x4"), (std::array<int, 3>{2, 3, 4}));
  for (const char* text : {"", "2x3", "2x3x", "0x1x1", "2x3x4x5", "1024x1024x1024", "2X3X4"})
    EXPECT_THROW(parse_grid(text), WrongUsage) << text;
  EXPECT_FALSE(parse_box("auto"));
  EXPECT_EQ((*parse_box("-1,0,1,2,3,4"))[3], 2);
  EXPECT_EQ(parse_box("-1; 0; 1; 2; 3; 4"), parse_box("-1,0,1,2,3,4")) << "as a list of pipeline.yaml comes";
  for (const char* text :
       {"", "1,2,3", "1,2,3,0,3,4", "1,2,3,4,5,x", "0,0,0,1,1,inf", "0,0,0,1,1,1e13", "-1e30,0,0,1,1,1"})
    EXPECT_THROW(parse_box(text), WrongUsage) << text;
}

}  // namespace
}  // namespace kiln
