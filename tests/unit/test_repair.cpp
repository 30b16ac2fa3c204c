// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "mesh/mesh_distance.h"
#include "mesh/mesh_repair.h"
#include "shapes.h"

namespace kiln {
namespace test_repair {

/// Computes vertices - edges + triangles: 2 for a sphere, 1 for a disk, 0 for a torus or a ring.
int euler_characteristic(const TriangleMesh& mesh) {
  std::set<std::uint32_t> vertices;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      vertices.insert(t[k]);
      edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
    }
  return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + static_cast<int>(mesh.triangles.size());
}

double volume(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const Triangle& t : mesh.triangles)
    six_volumes += mesh.positions[t[0]].cast<double>().dot(
        mesh.positions[t[1]].cast<double>().cross(mesh.positions[t[2]].cast<double>()));
  return six_volumes / 6;
}

/// Compares the counted repairs with `expected`, and all others with 0.
void expect_repairs(const MeshRepairs& found, const std::vector<std::pair<int MeshRepairs::*, int>>& expected) {
  for (const auto& [name, count] : MeshRepairs::kinds()) {
    int wanted = 0;
    for (const auto& [kind, number] : expected)
      if (kind == count) wanted = number;
    EXPECT_EQ(found.*count, wanted) << name;
  }
}

void turn(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

void turn_all(TriangleMesh& mesh) { std::for_each(mesh.triangles.begin(), mesh.triangles.end(), turn); }

TriangleMesh scaled(TriangleMesh mesh, float factor) {
  for (Eigen::Vector3f& p : mesh.positions) p *= factor;
  return mesh;
}

TEST(Repair, LeavesCleanMeshesAlone) {
  for (const TriangleMesh& clean : {shapes::wavy_sheet(5), shapes::icosphere(2), shapes::torus(12), shapes::cube(3),
                                    shapes::joined(shapes::icosphere(2), shapes::wavy_sheet(4), {5, 0, 0})}) {
    TriangleMesh mesh = clean;
    EXPECT_TRUE(is_manifold(mesh));
    const MeshRepairs repairs = repair_mesh(mesh);
    EXPECT_TRUE(repairs.is_clean()) << repairs.text();
    EXPECT_EQ(mesh.triangles, clean.triangles);
    EXPECT_EQ(mesh.positions, clean.positions);
  }
}

TEST(Repair, MergesVerticesAtOnePlaceAndDropsUnusedOnes) {
  // A cube sphere's sides have vertices of their own.
  TriangleMesh sphere = shapes::cube_sphere(4);
  const auto vertices = static_cast<int>(sphere.positions.size());
  sphere.positions.emplace_back(9.f, 9.f, 9.f);
  sphere.normals.clear();
  sphere.uvs.clear();
  // The sides' common corners are sums in another order, so they differ by rounding; they are put to one grid.
  for (Eigen::Vector3f& p : sphere.positions) p = (p * 4096).array().round() / 4096;
  const MeshRepairs repairs = repair_mesh(sphere);
  EXPECT_EQ(repairs.border_loops, 0);
  EXPECT_EQ(repairs.components, 1);
  EXPECT_TRUE(is_manifold(sphere));
  EXPECT_TRUE(is_closed(sphere));
  EXPECT_EQ(euler_characteristic(sphere), 2);
  // Six sides of 5 x 5; 8 corners are there three times and 12 edges' 3 inner vertices twice.
  expect_repairs(repairs, {{&MeshRepairs::merged_vertices, 8 * 2 + 12 * 3}, {&MeshRepairs::unused_vertices, 1}});
  EXPECT_EQ(static_cast<int>(sphere.positions.size()), vertices - 8 * 2 - 12 * 3);
}

TEST(Repair, DropsDuplicateTrianglesInAnyOrder) {
  TriangleMesh sphere = shapes::icosphere(1);
  const std::vector<Triangle> clean = sphere.triangles;
  const auto& [a, b, c] = clean[3];
  sphere.triangles.push_back({a, b, c});
  sphere.triangles.push_back({b, c, a});
  sphere.triangles.push_back({c, b, a});
  expect_repairs(repair_mesh(sphere), {{&MeshRepairs::duplicate_triangles, 2}, {&MeshRepairs::dropped_backs, 1}});
  EXPECT_EQ(sphere.triangles, clean);
}

TEST(Repair, TrianglesThatRepeatAVertexGo) {
  TriangleMesh sphere = shapes::icosphere(1);
  const std::vector<Triangle> clean = sphere.triangles;
  sphere.triangles.push_back({4, 4, 5});
  sphere.triangles.push_back({7, 7, 7});
  expect_repairs(repair_mesh(sphere), {{&MeshRepairs::degenerate_triangles, 2}});
  EXPECT_EQ(sphere.triangles, clean);
}

TEST(Repair, FlatTrianglesGoWithoutACrack) {
  // A unit cube of two triangles a side. On one side's diagonal (0, 1) comes a vertex that only one of its two
  // triangles is cut at; a triangle without area joins them.
  TriangleMesh cube = shapes::cube(1);
  const auto [a, b, c] = cube.triangles[0];
  const auto middle = static_cast<std::uint32_t>(cube.positions.size());
  // The longest edge of the flat triangle is the diagonal.
  Triangle t = {a, b, c};
  while ((cube.positions[t[1]] - cube.positions[t[0]]).norm() < 1.2f) std::rotate(t.begin(), t.begin() + 1, t.end());
  cube.positions.push_back(0.5f * (cube.positions[t[0]] + cube.positions[t[1]]));
  cube.triangles[0] = {t[0], middle, t[2]};
  cube.triangles.push_back({middle, t[1], t[2]});
  cube.triangles.push_back({t[0], t[1], middle});
  ASSERT_TRUE(is_closed(cube));
  expect_repairs(repair_mesh(cube), {{&MeshRepairs::degenerate_triangles, 1}});
  EXPECT_TRUE(is_manifold(cube));
  EXPECT_TRUE(is_closed(cube));
  EXPECT_EQ(euler_characteristic(cube), 2);
  EXPECT_DOUBLE_EQ(volume(cube), 1);
  EXPECT_NEAR(surface_area(cube), 6, 1e-12);
}

TEST(Repair, TurnsTheFewNotTheMany) {
  TriangleMesh sphere = shapes::icosphere(2);
  const std::vector<Triangle> right = sphere.triangles;
  for (const std::size_t i : {0, 5, 17}) turn(sphere.triangles[i]);
  expect_repairs(repair_mesh(sphere), {{&MeshRepairs::reversed_triangles, 3}});
  const double octant = 4.0 / 3 * 3.14159 / 8;
  EXPECT_GT(volume(sphere), 7 * octant) << "outwards";
  EXPECT_TRUE(is_closed(sphere));

  // An open sheet has no outside: its greater part decides.
  TriangleMesh sheet = shapes::wavy_sheet(6);
  for (std::size_t i = 0; i < sheet.triangles.size(); ++i)
    if (i > 20) turn(sheet.triangles[i]);
  expect_repairs(repair_mesh(sheet), {{&MeshRepairs::reversed_triangles, 21}});
  compute_vertex_normals(sheet);
  for (const Eigen::Vector3f& normal : sheet.normals) EXPECT_LT(normal.y(), 0);
}

TEST(Repair, ClosedComponentsAreTurnedOutwardsButForCavities) {
  // A sphere inside out, a shell with a cavity in it, and a sphere that is right.
  TriangleMesh sphere = shapes::icosphere(2);
  TriangleMesh inside_out = sphere;
  turn_all(inside_out);
  TriangleMesh all = shapes::joined(inside_out, scaled(sphere, 3), {10, 0, 0});
  all = shapes::joined(all, inside_out, {10, 0, 0});
  all = shapes::joined(all, sphere, {-10, 0, 0});
  const std::vector<Triangle> before = all.triangles;
  const MeshRepairs repairs = repair_mesh(all);
  expect_repairs(repairs, {{&MeshRepairs::inside_out_components, 1}});
  EXPECT_EQ(repairs.components, 4);
  const std::size_t one = sphere.triangles.size();
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(all.triangles[i] == before[i], i >= one) << i;
}

TEST(Repair, SolidsThatTouchInAVertexComeApart) {
  TriangleMesh touching;
  touching.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  touching.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};
  EXPECT_FALSE(is_manifold(touching));
  const TriangleMesh before = touching;
  const MeshRepairs repairs = repair_mesh(touching);
  expect_repairs(repairs, {{&MeshRepairs::nonmanifold_vertices, 1}});
  EXPECT_EQ(repairs.components, 2);
  EXPECT_EQ(touching.positions.size(), 8u);
  EXPECT_TRUE(is_manifold(touching));
  EXPECT_TRUE(is_closed(touching));
  EXPECT_EQ(euler_characteristic(touching), 4);
  EXPECT_LT(mesh_distance(before, touching).hausdorff, 1e-12);
}

TEST(Repair, SolidsThatTouchAlongEdgesComeApartWhole) {
  // Two cubes of 3 x 3 squares a side, corner to corner along an edge of three pieces: four triangles at each.
  const TriangleMesh cube = shapes::cube(3);
  TriangleMesh both = shapes::joined(cube, cube, {1, 1, 0});
  for (Eigen::Vector3f& p : both.positions) p = (p * 6).array().round();
  const MeshRepairs repairs = repair_mesh(both);
  expect_repairs(repairs, {{&MeshRepairs::merged_vertices, 4}, {&MeshRepairs::nonmanifold_edges, 3}});
  EXPECT_EQ(repairs.components, 2);
  EXPECT_EQ(repairs.border_loops, 0) << "no slit along the edge";
  EXPECT_TRUE(is_manifold(both));
  EXPECT_TRUE(is_closed(both));
  EXPECT_EQ(euler_characteristic(both), 4);
}

TEST(Repair, AFinLeavesTheSheetWhole) {
  // A plane, and a strip that stands on the middle line of it: three triangles at each of its edges.
  TriangleMesh sheet = shapes::plane(4);
  const auto below = [](int i) { return static_cast<std::uint32_t>(2 * 5 + i); };
  const auto first = static_cast<std::uint32_t>(sheet.positions.size());
  for (int i = 0; i <= 4; ++i)
    sheet.positions.push_back(Eigen::Vector3f(sheet.positions[below(i)]) + Eigen::Vector3f(0, 1, 0));
  for (int i = 0; i < 4; ++i) {
    const std::uint32_t above = first + static_cast<std::uint32_t>(i);
    sheet.triangles.push_back({below(i), below(i + 1), above + 1});
    sheet.triangles.push_back({below(i), above + 1, above});
  }
  EXPECT_FALSE(is_manifold(sheet));
  const std::vector<Triangle> before = sheet.triangles;
  const MeshRepairs repairs = repair_mesh(sheet);
  expect_repairs(repairs, {{&MeshRepairs::nonmanifold_edges, 4}});
  EXPECT_TRUE(is_manifold(sheet));
  EXPECT_EQ(repairs.components, 2);
  EXPECT_EQ(repairs.border_loops, 2);
  EXPECT_EQ(euler_characteristic(sheet), 2) << "two disks";
  EXPECT_TRUE(std::equal(before.begin(), before.begin() + 32, sheet.triangles.begin())) << "the sheet's own triangles";
}

TEST(Repair, AMoebiusStripIsCutOnce) {
  TriangleMesh strip;
  constexpr int steps = 12;
  for (int i = 0; i < steps; ++i) {
    const float around = 2 * 3.14159265f * static_cast<float>(i) / steps;
    for (const float side : {-0.3f, 0.3f}) {
      const float distance = 1 + side * std::cos(around / 2);
      strip.positions.emplace_back(distance * std::cos(around), side * std::sin(around / 2),
                                   distance * std::sin(around));
    }
  }
  for (int i = 0; i < steps; ++i) {
    const auto a = static_cast<std::uint32_t>(2 * i);
    const std::uint32_t b = a + 1;
    const bool last = i + 1 == steps;  // comes back the other way up
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.push_back({a, b, d});
    strip.triangles.push_back({a, d, c});
  }
  const MeshRepairs repairs = repair_mesh(strip);
  EXPECT_EQ(repairs.unorientable_edges, 1);
  EXPECT_TRUE(is_manifold(strip));
  EXPECT_EQ(euler_characteristic(strip), 1) << "a band that was cut through is a disk";
  EXPECT_EQ(strip.triangles.size(), 2u * steps);
}

TEST(Repair, HolesAreCountedAndFilledWhenAsked) {
  // A sphere without one vertex's triangles (a hole of 5 or 6 edges) and a small sheet, whose rim is no hole.
  TriangleMesh sphere = shapes::icosphere(3);
  const auto has_first = [](const Triangle& t) { return std::find(t.begin(), t.end(), 0u) != t.end(); };
  const auto around = static_cast<int>(std::count_if(sphere.triangles.begin(), sphere.triangles.end(), has_first));
  sphere.triangles.erase(std::remove_if(sphere.triangles.begin(), sphere.triangles.end(), has_first),
                         sphere.triangles.end());
  const TriangleMesh open = shapes::joined(sphere, shapes::plane(1), {5, 0, 0});

  for (const int most : {0, around - 1, around, 100}) {
    SCOPED_TRACE(most);
    TriangleMesh mesh = open;
    const MeshRepairs repairs = repair_mesh(mesh, {.fill_hole_edges = most});
    const int filled = most >= around ? 1 : 0;
    EXPECT_EQ(repairs.filled_holes, filled);
    EXPECT_EQ(repairs.border_loops, 2 - filled);
    EXPECT_EQ(repairs.unused_vertices, 1);
    EXPECT_EQ(repairs.components, 2);
    EXPECT_TRUE(is_manifold(mesh));
    EXPECT_EQ(euler_characteristic(mesh), filled == 1 ? 3 : 2);
    EXPECT_EQ(mesh.triangles.size(), open.triangles.size() + static_cast<std::size_t>(filled * (around - 2)));
  }
}

TEST(Repair, ColorsGoWithTheirVertices) {
  TriangleMesh sphere = shapes::icosphere(2);
  sphere.positions.insert(sphere.positions.begin(), Eigen::Vector3f(7, 7, 7));  // unused
  for (Triangle& t : sphere.triangles)
    for (std::uint32_t& vertex : t) ++vertex;
  sphere.positions.push_back(Eigen::Vector3f(sphere.positions[9]));  // one vertex twice
  sphere.triangles[0] = sphere.triangles[1];                         // a hole, and a duplicate
  for (const Eigen::Vector3f& p : sphere.positions) sphere.colors.push_back((p.array() + 1) / 2);
  repair_mesh(sphere);
  ASSERT_EQ(sphere.colors.size(), sphere.positions.size());
  for (std::size_t i = 0; i < sphere.colors.size(); ++i)
    EXPECT_EQ(sphere.colors[i], Eigen::Vector3f((sphere.positions[i].array() + 1) / 2));
}

TEST(Repair, AnySoupBecomesAManifold) {
  // Few places and many triangles: every defect at once, and in each other's way.
  std::mt19937 random(7);
  const auto below = [&](unsigned limit) { return random() % limit; };
  for (int k = 0; k < 500; ++k) {
    SCOPED_TRACE(k);
    const unsigned vertices = 4 + below(12), triangles = 1 + below(40), places = 2 + below(4);
    TriangleMesh mesh;
    const auto coordinate = [&] { return static_cast<float>(below(places)); };
    for (unsigned i = 0; i < vertices; ++i) mesh.positions.emplace_back(coordinate(), coordinate(), coordinate());
    for (unsigned i = 0; i < triangles; ++i)
      mesh.triangles.push_back({static_cast<std::uint32_t>(below(vertices)),
                                static_cast<std::uint32_t>(below(vertices)),
                                static_cast<std::uint32_t>(below(vertices))});
    repair_mesh(mesh, {.fill_hole_edges = static_cast<int>(below(8))});
    EXPECT_TRUE(is_manifold(mesh));
    for (const Triangle& t : mesh.triangles) EXPECT_LT(*std::max_element(t.begin(), t.end()), mesh.positions.size());
  }
}

TEST(Repair, TellsManifoldsFromOthers) {
  TriangleMesh fan;  // three half planes about the z axis
  fan.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  fan.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  EXPECT_FALSE(is_manifold(fan));
  const MeshRepairs repairs = repair_mesh(fan);
  EXPECT_EQ(repairs.nonmanifold_edges, 1);
  EXPECT_TRUE(is_manifold(fan));
  EXPECT_EQ(fan.triangles.size(), 3u);

  TriangleMesh bow;  // two triangles that share a vertex only
  bow.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  bow.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_FALSE(is_manifold(bow));
  TriangleMesh against = shapes::plane(1);
  turn(against.triangles[0]);
  EXPECT_FALSE(is_manifold(against));
  EXPECT_TRUE(is_manifold(TriangleMesh{}));
}

}  // namespace test_repair
}  // namespace kiln
