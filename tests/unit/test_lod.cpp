// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of detail: what shares an atlas must keep its seams closed, its charts off each other and its texels where
// they were made for. The shapes are such that the answers are known.

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <set>
#include <tuple>
#include <vector>

#include "base/errors.h"
#include "base/json.h"
#include "base/parallel.h"
#include "collapse/level_chain.h"
#include "lod/lod.h"
#include "mesh/hard_edges.h"
#include "mesh/mesh_components.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"
#include "mesh/uv_seams.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_lod {

using shapes::cube_sphere;
using shapes::plane;

constexpr int size = 256;

using Corner = std::array<float, 5>;

Corner corner_of(const TriangleMesh& mesh, std::uint32_t vertex) {
  const Eigen::Vector3f& p = mesh.positions[vertex];
  return {p.x(), p.y(), p.z(), mesh.uvs[vertex].x(), mesh.uvs[vertex].y()};
}

std::set<Corner> corners_of(const TriangleMesh& mesh) {
  std::set<Corner> corners;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) corners.insert(corner_of(mesh, v));
  return corners;
}

std::vector<Triangle> triangles_of(const std::vector<Level>& levels) {
  std::vector<Triangle> all;
  for (const Level& level : levels) all.insert(all.end(), level.mesh.triangles.begin(), level.mesh.triangles.end());
  return all;
}

/// Returns the sides of triangles that nothing joins once equal positions are one.
std::vector<std::uint32_t> open_sides(const TriangleMesh& welded) {
  std::vector<std::uint32_t> open;
  TriangleEdges(welded.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    if (sides.size() == 1) open.push_back(sides[0]);
  });
  return open;
}

double uv_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector2d a = (mesh.uvs[t[1]] - mesh.uvs[t[0]]).cast<double>();
    const Eigen::Vector2d b = (mesh.uvs[t[2]] - mesh.uvs[t[0]]).cast<double>();
    area += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// Makes a flat chart per ring of `rings`: an arc of `degrees` between two radii, uv (0.5, 0.5) its centre, 100 texels
/// to a unit of the radius.
TriangleMesh flat_arcs(const std::vector<std::array<double, 2>>& rings, double degrees, int cells) {
  TriangleMesh mesh;
  for (const auto& [inner, outer] : rings) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j < 2; ++j) {
        const double angle = degrees * std::numbers::pi / 180 * i / cells, radius = j == 0 ? inner : outer;
        const double x = radius * std::cos(angle), y = radius * std::sin(angle);
        mesh.positions.emplace_back(static_cast<float>(x), 0, static_cast<float>(-y));
        mesh.uvs.emplace_back(static_cast<float>(0.5 + x * 100 / size), static_cast<float>(0.5 + y * 100 / size));
        mesh.normals.emplace_back(0, 1, 0);
      }
    for (int i = 0; i < cells; ++i) {
      const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(i);
      mesh.triangles.push_back({a, a + 1, a + 3});
      mesh.triangles.push_back({a, a + 3, a + 2});
    }
  }
  return mesh;
}

TEST(Lod, AFlatSheetOfEvenUvsLosesNothing) {
  const TriangleMesh sheet = plane(20);
  const std::vector<Level> levels = make_level_chain(sheet, {{200, 0}, {12, 0}}, {size, 1.5});
  ASSERT_EQ(levels.size(), 2U);
  const TexelDisplacementMeter meter(sheet, size);
  for (const Level& level : levels) {
    EXPECT_TRUE(level.reached_goal);
    EXPECT_LT(level.deviation, 1e-6);
    EXPECT_NEAR(surface_area(level.mesh), surface_area(sheet), 1e-6);
    EXPECT_NEAR(uv_area(level.mesh), uv_area(sheet), 1e-6);
    const TexelDisplacement texels = meter.measure(level.mesh);
    EXPECT_LT(texels.largest, 1e-5);  // of a side of 1, in floats
    EXPECT_EQ(texels.overhanging, 0);
    EXPECT_EQ(texels.deserted, 0);
    EXPECT_EQ(texels.overlapping, 0);
  }
  EXPECT_LE(levels[1].mesh.triangles.size(), 12U);
}

TEST(Lod, UvsThatAreBentOverAFlatSheetCount) {
  TriangleMesh sheet = plane(20);
  for (Eigen::Vector2f& uv : sheet.uvs) uv.x() = uv.x() * (0.4f + 0.6f * uv.x());
  const std::vector<Level> levels = make_level_chain(sheet, {{12, 0}}, {size, 1.5});
  const TexelDisplacement texels = TexelDisplacementMeter(sheet, size).measure(levels[0].mesh);
  EXPECT_NEAR(surface_area(levels[0].mesh), 1, 1e-6);
  EXPECT_GT(levels[0].deviation, 1e-4);
  EXPECT_GT(texels.largest, 1e-4);
  // Triangles that span the whole sheet would slide texels by half of the largest change of du/dx, 0.6, over 4.
  EXPECT_LT(texels.largest, 0.6 / 4);
  // An error that is asked for is kept to at the samples; between them the texels show little more.
  const std::vector<Level> bounded = make_level_chain(sheet, {{0, 0.004}}, {size, 1.5});
  EXPECT_LE(bounded[0].deviation, 0.004);
  EXPECT_LT(TexelDisplacementMeter(sheet, size).measure(bounded[0].mesh).largest, 1.5 * 0.004);
  EXPECT_LT(bounded[0].mesh.triangles.size(), 400U);
}

TEST(Lod, ABoxOfSixChartsBecomesItsTwelveTriangles) {
  TriangleMesh box = cube_sphere(8);
  for (std::size_t t = 0; t < box.triangles.size(); ++t)
    for (const std::uint32_t v : box.triangles[t]) {
      Eigen::Vector3f& p = box.positions[v];
      p /= p.cwiseAbs().maxCoeff();
    }
  for (const Triangle& t : box.triangles)
    for (const std::uint32_t v : t) box.normals[v] = area_normal(box, t).normalized().cast<float>();
  const std::vector<Level> levels = make_level_chain(box, {{12, 0}}, {size, 0});
  EXPECT_EQ(levels[0].mesh.triangles.size(), 12U);
  EXPECT_LT(levels[0].deviation, 1e-5);
  EXPECT_NEAR(surface_area(levels[0].mesh), 24, 1e-5);
  EXPECT_TRUE(is_closed(join_at_positions(levels[0].mesh)));
  EXPECT_EQ(TexelDisplacementMeter(box, size).measure(levels[0].mesh).overlapping, 0);
}

TEST(Lod, SeamsOfASphereStayClosed) {
  const TriangleMesh sphere = cube_sphere(16);
  ASSERT_TRUE(is_closed(join_at_positions(sphere)));
  const std::set<Corner> all = corners_of(sphere);
  const std::vector<Level> levels = make_level_chain(sphere, {{1500, 0}, {600, 0}, {200, 0}}, {size, 1.5, 6});
  std::size_t before = sphere.triangles.size();
  double area = surface_area(sphere);
  for (const Level& level : levels) {
    EXPECT_TRUE(level.reached_goal);
    EXPECT_LT(level.mesh.triangles.size(), before);
    before = level.mesh.triangles.size();
    // Welded by position it is one closed surface: no side of a seam has moved without the other.
    const TriangleMesh welded = join_at_positions(level.mesh);
    EXPECT_TRUE(is_closed(welded));
    EXPECT_EQ(find_components(welded).count, 1U);
    // Its vertices are vertices of the atlas, uvs included.
    for (const Corner& corner : corners_of(level.mesh)) EXPECT_TRUE(all.contains(corner));
    const TexelDisplacement texels = TexelDisplacementMeter(sphere, size).measure(level.mesh);
    EXPECT_EQ(texels.overlapping, 0);
    // Inscribed into the sphere, it shrinks; a triangle of n among N has the sagitta of its circle, 1 - cos of the
    // angle that it spans.
    EXPECT_LT(surface_area(level.mesh), area);
    area = surface_area(level.mesh);
    EXPECT_LT(texels.largest, 12.0 / static_cast<double>(level.mesh.triangles.size()) + 0.05);
  }
}

TEST(Lod, HardEdgesWithinAChartStayWhereTheyAre) {
  // Bend a sheet along its middle line and split its normals there, in one chart.
  TriangleMesh sheet = plane(10);
  for (Eigen::Vector3f& p : sheet.positions)
    if (p.x() > 0) p = {0, p.x(), p.z()};
  compute_normals_between(sheet, hard_edges_by_angle(sheet, 45));
  TriangleMesh split = split_at_hard_edges(sheet);
  ASSERT_GT(split.positions.size(), sheet.positions.size());
  const std::vector<Level> levels = make_level_chain(split, {{16, 0}}, {size, 0});
  EXPECT_TRUE(levels[0].reached_goal);
  EXPECT_LT(levels[0].deviation, 1e-6);
  EXPECT_NEAR(surface_area(levels[0].mesh), surface_area(sheet), 1e-6);
  for (const std::uint32_t side : open_sides(join_at_positions(levels[0].mesh))) {
    const TriangleMesh welded = join_at_positions(levels[0].mesh);
    const Eigen::Vector3f& a = welded.positions[vertex_at(welded.triangles, side)];
    const Eigen::Vector3f& b = welded.positions[vertex_at(welded.triangles, next_corner(side))];
    const bool along_the_bend = a.x() == 0 && a.y() == 0 && b.x() == 0 && b.y() == 0;
    EXPECT_FALSE(along_the_bend);
  }
}

TEST(Lod, AnOutlineThatDipsInwardsKeepsToItsOverhang) {
  // Between neighbours by twos the inner arc, 48 texels in radius, dips by 48 (1 - cos 3 degrees) = 0.066 texels.
  const TriangleMesh arc = flat_arcs({{0.48, 0.96}}, 180, 60);
  const auto inner_vertices = [&](double overhang) {
    const std::vector<Level> levels = make_level_chain(arc, {{2, 0}}, {size, overhang});
    return std::count_if(levels[0].mesh.positions.begin(), levels[0].mesh.positions.end(),
                         [](const Eigen::Vector3f& p) { return p.norm() < 0.5f; });
  };
  // Two of its 61 vertices, those at its ends, may go, where the outline draws back.
  EXPECT_EQ(inner_vertices(0.05), 59);
  EXPECT_LT(inner_vertices(0.1), 59);
  // A chord over an angle a hangs over by 48 (1 - cos(a / 2)): 1 texel takes 23.4 degrees, so eight chords at least.
  EXPECT_GE(inner_vertices(1), 7);
  EXPECT_LT(inner_vertices(1), inner_vertices(0.1));
}

TEST(Lod, ChartsInsideOneAnotherNeverMeet) {
  // Four texels between both arcs; any overhang is asked for.
  const TriangleMesh arcs = flat_arcs({{0.48, 0.96}, {0.2, 0.44}}, 180, 60);
  const std::vector<Level> levels = make_level_chain(arcs, {{2, 0}}, {size, 64});
  EXPECT_LT(levels[0].mesh.triangles.size(), 100U);
  EXPECT_EQ(rasterise_uvs(levels[0].mesh, 8 * size, 8 * size).overlapping_texels, 0);
}

TEST(Lod, LevelsAreTheSameOnAnyNumberOfThreads) {
  const TriangleMesh sphere = cube_sphere(10);
  const std::vector<LevelGoal> goals = {{500, 0}, {200, 0}};
  const std::vector<Level> many = make_level_chain(sphere, goals, {size, 1.5});
  const ThreadLimit one(1);
  EXPECT_EQ(triangles_of(make_level_chain(sphere, goals, {size, 1.5})), triangles_of(many));
}

TEST(Lod, AMeshOfNothingButJunctionsMissesItsGoal) {
  const TriangleMesh box = cube_sphere(1);
  const std::vector<Level> levels = make_level_chain(box, {{4, 0}}, {size, 64});
  EXPECT_FALSE(levels[0].reached_goal);
  EXPECT_EQ(levels[0].mesh.triangles.size(), box.triangles.size());
  const Scratch scratch;
  OutputSet outputs(scratch.folder() / "lod");
  const LodInput input{.atlas = box, .size = size, .file = "box.drc"};
  EXPECT_THROW(make_levels(outputs, input, {}), BadInput);
}

TEST(Lod, DistancesFollowTheCamera) {
  // At 90 degrees 1,000 lines span twice the distance: a unit at the distance 500 is a pixel.
  const ReferencePictureSize view{1000, 90};
  EXPECT_NEAR(switching_distance(1, 0, 1, view), 500, 1e-9);
  EXPECT_NEAR(switching_distance(1, 0, 2, view), 250, 1e-9);
  EXPECT_NEAR(switching_distance(1, 7, 1, view), 507, 1e-9);  // from the centre of a sphere of 7
  EXPECT_NEAR(length_of_pixels(5, 10, view), 0.1, 1e-12);
}

TEST(Lod, SettingsAreListsOfFallingShares) {
  LodSettings settings;
  const OptionSet options = lod_options(settings);
  options.find("levels")->set("1; 0.5; 0.25");
  EXPECT_EQ(settings.shares(), (std::vector<double>{0.5, 0.25}));
  options.find("pixels")->set("1, 4");
  EXPECT_EQ(settings.pixel_errors(), (std::vector<double>{1, 4}));
  for (const char* text : {"0.25, 0.5", "0.5, 0.5", "1", "1.5", "0", "half", ""})
    EXPECT_THROW(options.find("levels")->set(text), WrongUsage) << text;
  EXPECT_THROW(options.find("pixels")->set("4, 1"), WrongUsage);
}

TEST(Lod, WrittenLevelsAreMeasuredOnTheirFiles) {
  const TriangleMesh sphere = cube_sphere(12);
  const Scratch scratch;
  OutputSet outputs(scratch.folder() / "lod");
  const LodInput input{.atlas = sphere, .high = &sphere, .size = size, .overhang_texels = 1.5, .file = "sphere.drc"};
  LodSettings settings;
  settings.levels = "0.5, 0.2";
  const LodResult result = make_levels(outputs, input, settings);
  ASSERT_EQ(result.levels.size(), 2U);
  EXPECT_NEAR(result.radius, std::sqrt(3.0), 1e-3);  // of the sphere's box
  for (const WrittenLevel& level : result.levels) {
    const TriangleMesh read = load_atlas(outputs.staging() / level.file);
    EXPECT_EQ(read.triangles.size(), level.triangles);
    EXPECT_TRUE(is_closed(join_at_positions(read)));  // whatever the file's steps are
    EXPECT_GE(level.error, level.hausdorff);
    EXPECT_GE(level.error, level.texels.largest);
    EXPECT_GE(level.hausdorff, level.rms);
    EXPECT_DOUBLE_EQ(level.high_hausdorff, level.hausdorff);  // it is the same mesh here
    EXPECT_NEAR(level.distance, switching_distance(level.error, result.radius, 1, settings.view), 1e-9);
  }
  EXPECT_EQ(result.levels[0].triangles, sphere.triangles.size() / 2);
  EXPECT_LT(result.levels[0].rms, result.levels[1].rms);
  const Json json = result.to_json(input);
  EXPECT_EQ(json.at("levels").size(), 2U);
  EXPECT_EQ(json.at("levels")[1].at("mesh"), "lod_2.drc");
  EXPECT_EQ(json.at("missed_goals"), 0);
}

TEST(Lod, ErrorsInPixelsAreKeptWhereTheyAreMeasured) {
  const TriangleMesh sphere = cube_sphere(12);
  const Scratch scratch;
  OutputSet outputs(scratch.folder() / "lod");
  const LodInput input{.atlas = sphere, .size = size, .overhang_texels = 1.5, .file = "sphere.drc"};
  LodSettings settings;
  settings.pixels = "8, 24";
  const LodResult result = make_levels(outputs, input, settings);
  ASSERT_EQ(result.levels.size(), 2U);
  EXPECT_LT(result.levels[1].triangles, result.levels[0].triangles);
  EXPECT_LT(result.levels[0].triangles, sphere.triangles.size());
  for (const WrittenLevel& level : result.levels) {
    EXPECT_TRUE(level.reached_goal);
    EXPECT_LE(level.error, length_of_pixels(level.goal, result.radius, settings.view));
    EXPECT_GT(level.error, 0.3 * length_of_pixels(level.goal, result.radius, settings.view));
  }
}

}  // namespace test_lod
}  // namespace kiln
