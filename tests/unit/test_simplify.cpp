// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "import/import_mesh.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_repair.h"
#include "scratch.h"
#include "shapes.h"
#include "simplify/collapse.h"
#include "simplify/feature_edges.h"
#include "simplify/fit.h"
#include "simplify/low_file.h"
#include "simplify/reduce.h"
#include "simplify/simplify.h"

namespace kiln {
namespace test_simplify {

namespace fs = std::filesystem;

constexpr SimplifyQuality all_qualities[] = {SimplifyQuality::draft, SimplifyQuality::standard, SimplifyQuality::best};

/// Computes vertices - edges + triangles: 2 for each closed surface without handles.
int euler_characteristic(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::set<std::uint32_t> vertices;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      vertices.insert(t[i]);
      edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    }
  return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + static_cast<int>(mesh.triangles.size());
}

/// Lists the edges with a triangle on one side only, from one end to the other.
std::vector<std::pair<std::uint32_t, std::uint32_t>> border_edges(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) edges.emplace(t[i], t[(i + 1) % 3]);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> border;
  for (const auto& [from, to] : edges)
    if (!edges.contains({to, from})) border.emplace_back(from, to);
  return border;
}

/// Finds the largest distance from points of one border, 16 an edge, to the other border.
double border_distance(const TriangleMesh& from, const TriangleMesh& to) {
  double largest = 0;
  const auto border = border_edges(to);
  for (const auto& [a, b] : border_edges(from))
    for (int i = 0; i < 16; ++i) {
      const Eigen::Vector3f p =
          from.positions[a] + static_cast<float>(i) / 16 * (from.positions[b] - from.positions[a]);
      double nearest = HUGE_VAL;
      for (const auto& [c, d] : border) {
        const Eigen::Vector3f edge = to.positions[d] - to.positions[c];
        const float along = std::clamp((p - to.positions[c]).dot(edge) / edge.squaredNorm(), 0.0f, 1.0f);
        nearest = std::min<double>(nearest, (to.positions[c] + along * edge - p).norm());
      }
      largest = std::max(largest, nearest);
    }
  return largest;
}

TriangleMesh bunny() { return load_mesh("/usr/share/glmark2/models/bunny.obj"); }

class LowFileFolder : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_ / name; }

 private:
  const Scratch folder_;
};

using Simplify = LowFileFolder;

TEST(SimplifyShapes, ASphereStaysASphere) {
  const TriangleMesh sphere = shapes::icosphere(4);
  ASSERT_EQ(euler_characteristic(sphere), 2);
  for (const SimplifyQuality quality : all_qualities)
    for (const int faces : {8, 200}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(quality)) + " to " + std::to_string(faces));
      const SimplifyResult result = simplify(sphere, {.faces = faces, .quality = quality});
      EXPECT_EQ(result.mesh.triangles.size(), static_cast<std::size_t>(faces));
      EXPECT_TRUE(result.manifold);
      EXPECT_TRUE(result.closed);
      EXPECT_EQ(euler_characteristic(result.mesh), 2);
      EXPECT_EQ(result.flipped_triangles, 0);
      EXPECT_EQ(result.degenerate_triangles, 0);
      // Best for 200 faces: a triangle of area 4 pi / 200 has an edge of 0.38, and its middle, if its corners are as
      // far outside as that is inside, lies edge^2 / 12 = 0.012 deep. Three times that is allowed, of a diagonal of 2
      // sqrt(3).
      if (faces == 200) {
        EXPECT_LT(result.distance.hausdorff, 3 * 0.012 / (2 * std::sqrt(3.0)));
      }
    }
}

TEST(SimplifyShapes, ACubeOfManyTrianglesIsOneOfTwelve) {
  const TriangleMesh cube = shapes::cube(16);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const SimplifyResult result = simplify(cube, {.faces = 12, .quality = quality});
    EXPECT_EQ(result.mesh.triangles.size(), 12u);
    EXPECT_TRUE(result.closed);
    EXPECT_LT(result.distance.hausdorff, 1e-6);
    EXPECT_NEAR(surface_area(result.mesh), 6, 1e-5);
  }
}

TEST(SimplifyShapes, BordersKeepTheirShape) {
  const TriangleMesh sheet = shapes::wavy_sheet(60);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const SimplifyResult result = simplify(sheet, {.faces = 500, .quality = quality});
    EXPECT_LE(result.mesh.triangles.size(), 500u);
    EXPECT_GE(result.mesh.triangles.size(), 499u);
    EXPECT_TRUE(result.manifold);
    EXPECT_FALSE(result.closed);
    EXPECT_EQ(euler_characteristic(result.mesh), 1) << "a disk stays one";
    EXPECT_EQ(result.flipped_triangles, 0);
    // Waves of 0.05 on a sheet of 1: a border that lost them would be 0.05 away, one that is kept to a tenth of them is
    // good.
    EXPECT_LT(border_distance(sheet, result.mesh), 0.005);
    EXPECT_LT(border_distance(result.mesh, sheet), 0.005);
  }
}

TEST(SimplifyShapes, AStraightBorderIsKeptExactly) {
  const TriangleMesh square = shapes::plane(20);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const SimplifyResult result = simplify(square, {.faces = 20, .quality = quality});
    EXPECT_LE(result.mesh.triangles.size(), 20u);
    EXPECT_LT(border_distance(square, result.mesh), 1e-6);
    EXPECT_LT(result.distance.hausdorff, 1e-6);
  }
}

TEST(SimplifyShapes, PartsStayApart) {
  // Two spheres, one far off the origin.
  TriangleMesh both = shapes::icosphere(3);
  TriangleMesh other = shapes::icosphere(3);
  const auto first = static_cast<std::uint32_t>(both.positions.size());
  for (const Eigen::Vector3f& p : other.positions) both.positions.push_back(p + Eigen::Vector3f(1000, 0, 0));
  for (const Triangle& t : other.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const SimplifyResult result = simplify(both, {.faces = 400});
  EXPECT_EQ(result.mesh.triangles.size(), 400u);
  EXPECT_TRUE(result.closed);
  EXPECT_EQ(euler_characteristic(result.mesh), 4);
}

TEST(SimplifyShapes, WhatHasFewerTrianglesIsKept) {
  const TriangleMesh sphere = shapes::icosphere(2);
  const SimplifyResult result = simplify(sphere, {.faces = 1000});
  EXPECT_EQ(result.mesh.triangles, sphere.triangles);
  EXPECT_EQ(result.mesh.positions, sphere.positions);
  EXPECT_LT(result.distance.hausdorff, 1e-15);
}

TEST(SimplifyShapes, MaxErrorIsHonouredAndUsed) {
  const TriangleMesh sphere = shapes::icosphere(3);
  for (const SimplifyQuality quality : all_qualities) {
    std::size_t triangles = sphere.triangles.size();
    for (const double max_error : {0.01, 0.03}) {
      if (quality == SimplifyQuality::best && max_error == 0.01) continue;  // long, and no other than the rest
      SCOPED_TRACE(std::to_string(static_cast<int>(quality)) + " within " + std::to_string(max_error));
      const SimplifyResult result = simplify(sphere, {.max_error = max_error, .quality = quality});
      EXPECT_LE(result.distance.hausdorff, max_error);
      // The error of a smooth surface goes with the area of a triangle: a mesh that uses less than half of what it may
      // could have had half the triangles.
      EXPECT_GT(result.distance.hausdorff, 0.5 * max_error);
      EXPECT_LT(result.mesh.triangles.size(), triangles);
      EXPECT_TRUE(result.closed);
      triangles = result.mesh.triangles.size();
    }
  }
  EXPECT_THROW(simplify(sphere, {.max_error = 1e-6}), WrongUsage);
}

/// Counts the points of `places` that are no vertex of the mesh, to `tolerance`.
int count_missing(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& places, float tolerance) {
  return static_cast<int>(std::count_if(places.begin(), places.end(), [&](const Eigen::Vector3f& place) {
    return std::none_of(mesh.positions.begin(), mesh.positions.end(),
                        [&](const Eigen::Vector3f& p) { return (p - place).norm() <= tolerance; });
  }));
}

/// Makes a tube about the y axis of radius 1 from -1 to 1, closed by two disks: vertices at the disks' middles last.
TriangleMesh closed_cylinder(int around, int along) {
  TriangleMesh mesh;
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * around + i % around); };
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * 3.14159265358979 * i / around;
      mesh.positions.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(2.0 * j / along - 1),
                                  static_cast<float>(-std::sin(angle)));
    }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  const auto bottom = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.emplace_back(0.0f, -1.0f, 0.0f);
  mesh.positions.emplace_back(0.0f, 1.0f, 0.0f);
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({bottom, vertex(i + 1, 0), vertex(i, 0)});
    mesh.triangles.push_back({bottom + 1, vertex(i, along), vertex(i + 1, along)});
  }
  return mesh;
}

TEST(SimplifyCreases, OfACubeStayExact) {
  const TriangleMesh cube = shapes::cube(12);
  std::vector<Eigen::Vector3f> corners;
  for (const float x : {-0.5f, 0.5f})
    for (const float y : {-0.5f, 0.5f})
      for (const float z : {-0.5f, 0.5f}) corners.emplace_back(x, y, z);
  for (const SimplifyQuality quality : all_qualities)
    for (const int faces : {12, 100}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(quality)) + " to " + std::to_string(faces));
      const SimplifyResult result = simplify(cube, {.faces = faces, .quality = quality, .crease = 30});
      EXPECT_EQ(result.mesh.triangles.size(), static_cast<std::size_t>(faces));
      EXPECT_TRUE(result.closed);
      EXPECT_EQ(count_missing(result.mesh, corners, 0), 0);
      EXPECT_LT(result.distance.hausdorff, 1e-7);
      // The edges are 12 long in all; they are found in the result again by their angle.
      double length = 0;
      for (const auto& [a, b] : find_feature_edges(result.mesh, 30))
        length += (result.mesh.positions[a] - result.mesh.positions[b]).norm();
      EXPECT_NEAR(length, 12, 1e-4);
    }
}

TEST(SimplifyCreases, OfACylinderStayCircles) {
  const TriangleMesh cylinder = closed_cylinder(96, 24);
  const auto rims = find_feature_edges(cylinder, 45);
  ASSERT_EQ(rims.size(), 2u * 96);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const SimplifyResult result = simplify(cylinder, {.faces = 200, .quality = quality, .crease = 45});
    EXPECT_LE(result.mesh.triangles.size(), 200u);
    EXPECT_TRUE(result.closed);
    // The remaining rims are closed lines in their planes, near the circles.
    std::map<std::uint32_t, int> ends;
    for (const auto& [a, b] : find_feature_edges(result.mesh, 45)) {
      for (const std::uint32_t vertex : {a, b}) {
        ++ends[vertex];
        const Eigen::Vector3f& p = result.mesh.positions[vertex];
        EXPECT_NEAR(std::abs(p.y()), 1, 1e-3);
        EXPECT_NEAR(std::hypot(p.x(), p.z()), 1, 0.05);
      }
    }
    EXPECT_GE(ends.size(), 2u * 8);
    for (const auto& [vertex, lines] : ends) EXPECT_EQ(lines, 2) << "of vertex " << vertex;
  }
}

/// Lists the edges of `cube` between its sides.
std::vector<VertexPair> edges_between_sides(const TriangleMesh& cube) { return find_feature_edges(cube, 45); }

double length_of(const TriangleMesh& mesh, const std::vector<VertexPair>& edges) {
  double length = 0;
  for (const auto& [a, b] : edges) length += (mesh.positions[a] - mesh.positions[b]).norm();
  return length;
}

Reduced reduced(const TriangleMesh& mesh, const SimplifySettings& settings, const std::vector<VertexPair>& edges) {
  const auto distance = [&](const TriangleMesh& candidate) { return mesh_distance(mesh, candidate); };
  return reduce_to_faces(mesh, settings, distance, {}, {edges, {}});
}

TEST(SimplifyFeatureEdges, OfACubeComeDownToItsTwelve) {
  const TriangleMesh cube = shapes::cube(10);
  ASSERT_EQ(cube.triangles.size(), 6u * 200);
  const std::vector<VertexPair> edges = edges_between_sides(cube);
  ASSERT_EQ(edges.size(), 12u * 10);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const Reduced low = reduced(cube, {.faces = 12, .quality = quality}, edges);
    EXPECT_EQ(low.mesh.triangles.size(), 12u);
    EXPECT_EQ(low.feature_edges.size(), 12u);
    EXPECT_EQ(low.feature_edges, find_feature_edges(low.mesh, 45));
    EXPECT_LT(mesh_distance(cube, low.mesh).hausdorff, 1e-6);
  }
}

TEST(SimplifyFeatureEdges, InsideAPlaneGoAlongTheirLine) {
  // A square in two halves: the line between them is no crease, but stays.
  const TriangleMesh square = shapes::plane(20);
  const auto is_between = [&](std::uint32_t vertex) { return square.positions[vertex].x() == 0; };
  std::vector<VertexPair> edges;
  for (const Triangle& t : square.triangles)
    for (int k = 0; k < 3; ++k)
      if (is_between(t[k]) && is_between(t[(k + 1) % 3])) edges.emplace_back(t[k], t[(k + 1) % 3]);
  ASSERT_EQ(edges.size(), 2u * 20) << "from either side";
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const Reduced low = reduced(square, {.faces = 4, .quality = quality}, edges);
    EXPECT_EQ(low.mesh.triangles.size(), 4u) << "two halves";
    ASSERT_EQ(low.feature_edges.size(), 1u);
    EXPECT_NEAR(length_of(low.mesh, low.feature_edges), 1, 1e-6);
    for (const std::uint32_t vertex : {low.feature_edges[0].first, low.feature_edges[0].second})
      EXPECT_EQ(low.mesh.positions[vertex].x(), 0);
    EXPECT_EQ(surface_area(low.mesh), 1);
  }
}

TEST(SimplifyFeatureEdges, OnASphereAreStillALoop) {
  const TriangleMesh sphere = shapes::cube_sphere(16);
  TriangleMesh whole{sphere.positions, sphere.triangles, {}, {}};
  repair_mesh(whole);
  ASSERT_TRUE(is_closed(whole));
  // The equator.
  std::vector<VertexPair> edges;
  const auto is_on = [&](std::uint32_t vertex) { return std::abs(whole.positions[vertex].y()) < 1e-6f; };
  for (const Triangle& t : whole.triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] < t[(k + 1) % 3] && is_on(t[k]) && is_on(t[(k + 1) % 3])) edges.emplace_back(t[k], t[(k + 1) % 3]);
  ASSERT_EQ(edges.size(), 4u * 16);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const Reduced low = reduced(whole, {.faces = 300, .quality = quality}, edges);
    EXPECT_EQ(low.mesh.triangles.size(), 300u);
    std::map<std::uint32_t, int> ends;
    for (const auto& [a, b] : low.feature_edges) {
      ++ends[a];
      ++ends[b];
    }
    EXPECT_GE(ends.size(), 8u);
    EXPECT_EQ(ends.size(), low.feature_edges.size());
    for (const auto& [vertex, count] : ends) {
      EXPECT_EQ(count, 2) << "of vertex " << vertex;
      EXPECT_NEAR(low.mesh.positions[vertex].y(), 0, 1e-3);
    }
    // An inscribed polygon of n sides is shorter than the circle by pi^2 / 6 n^2: 3 % of 8 sides.
    EXPECT_NEAR(length_of(low.mesh, low.feature_edges), 2 * 3.14159265, 0.03 * 2 * 3.14159265);
  }
}

TEST(SimplifyFeatureEdges, SurviveUnlessTheirEndsBecomeOne) {
  CollapseSequence sequence;
  sequence.start = shapes::plane(2);  // 3 x 3 vertices in rows
  sequence.collapses = {{1, 0, 7, {0, 0, 0}}, {3, 0, 5, {0, 0, 0}}};
  const std::vector<VertexPair> edges = {{0, 1}, {1, 2}, {2, 5}, {5, 8}, {3, 4}, {4, 1}};
  EXPECT_EQ(surviving_edges(sequence, 0, edges),
            (std::vector<VertexPair>{{0, 1}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {5, 8}}));
  // 0, 2, 4, 5, 6, 7 and 8 are left after both, and numbered so; 1-4 and 3-4 are one.
  EXPECT_EQ(surviving_edges(sequence, 2, edges), (std::vector<VertexPair>{{0, 1}, {0, 2}, {1, 3}, {3, 6}}));
}

TEST(SimplifyWeights, TrianglesGoWhereTheyCount) {
  const TriangleMesh sphere = shapes::icosphere(5);
  std::vector<double> weights;
  for (const Eigen::Vector3f& p : sphere.positions) weights.push_back(p.y() > 0 ? 100 : 1);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    const auto upper_share = [&](std::span<const double> vertex_weights) {
      const auto distance = [&](const TriangleMesh& candidate) { return mesh_distance(sphere, candidate); };
      const TriangleMesh low =
          reduce_to_faces(sphere, {.faces = 400, .quality = quality}, distance, vertex_weights).mesh;
      EXPECT_EQ(low.triangles.size(), 400u);
      return static_cast<double>(std::count_if(low.positions.begin(), low.positions.end(),
                                               [](const Eigen::Vector3f& p) { return p.y() > 0; })) /
             static_cast<double>(low.positions.size());
    };
    EXPECT_NEAR(upper_share({}), 0.5, 0.05);
    // Costs go with the sixth power of an edge at least, so with the third of a triangle's area: a hundred times the
    // weight is worth 4.6 times the triangles at most, a share of 0.82. Filters on shape and distance, which know no
    // weights, keep it below; 0.6 is well above chance.
    EXPECT_GT(upper_share(weights), 0.6);
  }
}

TEST(SimplifyShapes, EveryPrefixOfTheCollapsesIsAMesh) {
  const CollapseSequence sequence = collapse_edges_in_two_steps(shapes::icosphere(4), 1000, {.faces = 4});
  ASSERT_FALSE(sequence.collapses.empty());
  for (std::size_t count = 0; count <= sequence.collapses.size(); count += 150) {
    const TriangleMesh mesh = sequence.after(count);
    EXPECT_TRUE(is_manifold(mesh));
    EXPECT_EQ(euler_characteristic(mesh), 2);
    if (count == 0) continue;
    EXPECT_EQ(static_cast<int>(mesh.triangles.size()), sequence.collapses[count - 1].faces);
  }
}

TEST(SimplifyShapes, AnInterruptionComesThrough) {
  const ProgressFunction interrupt = [](double) { throw Interrupted(); };
  EXPECT_THROW(simplify(shapes::icosphere(4), {.faces = 100}, with_normals, interrupt), Interrupted);
}

TEST(SimplifyShapes, ProgressGoesFromNothingToAll) {
  double last = 0;
  const auto note = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
  };
  simplify(shapes::icosphere(5), {.faces = 100}, with_normals, note);
  EXPECT_EQ(last, 1);
}

TEST_F(Simplify, TheBunnyToAThousandTriangles) {
  const TriangleMesh high = bunny();
  // RMS as fractions of the diagonal. Known for this mesh and size: 0.00100 for Lindstrom-Turk and 0.00138 for
  // Garland-Heckbert quadrics in CGAL. standard and draft are to be those, a tenth more for other sampling; best is
  // measured as 0.00078 and shall be below the former by a tenth. Largest distances are 0.0072, 0.0063 and 0.0043; they
  // depend on a single triangle, and get 15 % more.
  const std::map<SimplifyQuality, std::pair<double, double>> most = {{SimplifyQuality::draft, {0.00152, 0.0083}},
                                                                     {SimplifyQuality::standard, {0.00110, 0.0073}},
                                                                     {SimplifyQuality::best, {0.00090, 0.0050}}};
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(static_cast<int>(quality));
    LowFile file(path("low.drc"));
    const SimplifyResult result =
        simplify(high, {.faces = 1000, .quality = quality}, [&](const TriangleMesh& mesh) { return file.write(mesh); });
    EXPECT_EQ(result.mesh.triangles.size(), 1000u);
    EXPECT_TRUE(result.manifold);
    EXPECT_TRUE(result.closed);
    EXPECT_EQ(euler_characteristic(result.mesh), euler_characteristic(high));
    EXPECT_EQ(result.flipped_triangles, 0);
    EXPECT_EQ(result.degenerate_triangles, 0);
    EXPECT_EQ(file.position_bits(), 16);
    EXPECT_LT(result.distance.rms, most.at(quality).first);
    EXPECT_LT(result.distance.hausdorff, most.at(quality).second);

    // The file holds what was measured.
    const TriangleMesh decoded = load_mesh(path("low.drc"));
    EXPECT_EQ(decoded.triangles, result.mesh.triangles);
    EXPECT_EQ(mesh_distance(high, decoded).hausdorff, result.distance.hausdorff);
    EXPECT_EQ(mesh_distance(high, decoded).hausdorff * bounding_box(high).diagonal(), result.hausdorff_distance);
  }
}

TEST(SimplifyFit, IsNoWorseThanWhatItStartsFrom) {
  // A coarse sphere in a fine one: its corners are on it, so that all of it is too small.
  const TriangleMesh high = shapes::icosphere(5), low = shapes::icosphere(2);
  const std::vector<std::uint8_t> none_fixed(low.positions.size(), 0), all_fixed(low.positions.size(), 1);
  const MeshDistance before = mesh_distance(high, low);
  const TriangleMesh fitted = fit_to_surface(low, high, none_fixed, {.rounds = 10, .samples = 20'000});
  const MeshDistance after = mesh_distance(high, fitted);
  EXPECT_TRUE(is_manifold(fitted));
  EXPECT_EQ(euler_characteristic(fitted), 2);
  // A spherical triangle of edge e is e^2 / 12 deep on average of its middle; moving its corners outwards by about that
  // leaves a third of the RMS. Half is asked for.
  EXPECT_LT(after.rms, 0.5 * before.rms);
  EXPECT_LT(after.hausdorff, before.hausdorff);
  EXPECT_EQ(fit_to_surface(low, high, all_fixed, {.rounds = 4, .samples = 20'000}).positions, low.positions);
}

TEST_F(Simplify, TheFileIsTheSameOnOneThreadAndTwo) {
  const TriangleMesh high = shapes::icosphere(3);
  const auto bytes = [&](std::size_t threads, const SimplifySettings& settings) {
    const ThreadLimit limit(threads);
    LowFile file(path("low.drc"));
    simplify(high, settings, [&](const TriangleMesh& mesh) { return file.write(mesh); });
    return read_text(path("low.drc"));
  };
  for (const SimplifyQuality quality : all_qualities)
    EXPECT_EQ(bytes(1, {.faces = 300, .quality = quality}), bytes(2, {.faces = 300, .quality = quality}));
  EXPECT_EQ(bytes(1, {.max_error = 0.01}), bytes(2, {.max_error = 0.01}));
}

TEST_F(Simplify, ThinTrianglesGetMoreBits) {
  // A sheet with a row of triangles 1/500,000 of its length high, an eighth of what 16 bits can tell.
  TriangleMesh sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 2e-6f, 0}, {0, 2e-6f, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
  LowFile file(path("low.drc"));
  const TriangleMesh decoded = file.write(sheet);
  EXPECT_GT(file.position_bits(), 16);
  EXPECT_EQ(count_degenerate(decoded), 0);
  for (const Eigen::Vector3f& normal : decoded.normals) EXPECT_GT(normal.z(), 0.999f);
}

}  // namespace test_simplify
}  // namespace kiln
