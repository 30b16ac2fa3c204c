// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/hashes.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "hard_shapes.h"
#include "import/import_mesh.h"
#include "mesh/disjoint_sets.h"
#include "mesh/hard_edges.h"
#include "mesh/mesh_components.h"
#include "mesh/mesh_repair.h"
#include "mesh/nearest_surface.h"
#include "mesh/same_position.h"
#include "scratch.h"
#include "shapes.h"
#include "simplify/cgal_collapse.h"
#include "simplify/feature_edges.h"
#include "simplify/low_file.h"
#include "simplify/reduce.h"
#include "simplify/simplify.h"

namespace kiln {
namespace test_cgal_collapse {

using Vector = Eigen::Vector3d;

constexpr CollapseCost all_costs[] = {CollapseCost::lindstrom_turk, CollapseCost::plane, CollapseCost::triangle,
                                      CollapseCost::probabilistic_plane, CollapseCost::probabilistic_triangle};

SimplifySettings by_cgal(int faces, CollapseCost cost = CollapseCost::lindstrom_turk) {
  SimplifySettings settings;
  settings.faces = faces;
  settings.engine = SimplifyEngine::cgal;
  settings.cost = cost;
  settings.drop_components = "0";
  return settings;
}

/// Topology of a mesh, which no collapse may change.
struct Topology {
  int euler = 0;  ///< vertices - edges + triangles
  std::size_t components = 0;
  int border_loops = 0;  ///< counted as components of the border's graph, whose vertices have two edges each

  bool operator==(const Topology&) const = default;
};

std::ostream& operator<<(std::ostream& stream, const Topology& topology) {
  return stream << topology.euler << " Euler, " << topology.components << " components, " << topology.border_loops
                << " borders";
}

Topology topology_of(const TriangleMesh& mesh) {
  std::set<std::uint32_t> vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      vertices.insert(t[k]);
      ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    }
  DisjointSets loops(mesh.positions.size());
  std::set<std::uint32_t> on_border;
  for (const auto& [edge, triangles] : edges)
    if (triangles == 1) {
      loops.join(edge.first, edge.second);
      on_border.insert({edge.first, edge.second});
    }
  const std::vector<std::uint32_t> roots = loops.roots();
  std::set<std::uint32_t> loop_roots;
  for (const std::uint32_t vertex : on_border) loop_roots.insert(roots[vertex]);
  return {static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + static_cast<int>(mesh.triangles.size()),
          find_components(mesh).count, static_cast<int>(loop_roots.size())};
}

/// Finds the largest distance of points of `low` (corners and 45 points in each triangle, its edges among them) from
/// `high`, by trying every triangle: no hierarchy, nor anything else that the engine uses.
double largest_distance(const TriangleMesh& low, const TriangleMesh& high) {
  constexpr int steps = 8;
  const auto corner = [](const TriangleMesh& mesh, const Triangle& t, int k) {
    return mesh.positions[t[k]].cast<double>().eval();
  };
  double largest = 0;
  for (const Triangle& t : low.triangles)
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const Vector p = (i * corner(low, t, 0) + j * corner(low, t, 1) + (steps - i - j) * corner(low, t, 2)) / steps;
        double nearest = HUGE_VAL;
        for (const Triangle& h : high.triangles)
          nearest = std::min(
              nearest, (p - nearest_on_triangle(p, corner(high, h, 0), corner(high, h, 1), corner(high, h, 2))).norm());
        largest = std::max(largest, nearest);
      }
  return largest;
}

double diagonal_of(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  return (box.highest - box.lowest).cast<double>().norm();
}

class CgalEnvelope : public testing::Test, protected Scratch {
 protected:
  /// Simplifies as far as the envelope allows, and checks the written file against the envelope.
  SimplifyResult check(const TriangleMesh& mesh, double envelope, CollapseCost cost = CollapseCost::lindstrom_turk) {
    SimplifySettings settings = by_cgal(4, cost);
    settings.envelope = envelope;
    LowFile file(folder() / "low.drc");
    SimplifyResult result = simplify(mesh, settings, [&](const TriangleMesh& low) { return file.write(low); });
    EXPECT_TRUE(result.manifold);
    EXPECT_EQ(result.degenerate_triangles, 0);
    EXPECT_LE(largest_distance(result.mesh, mesh), envelope * diagonal_of(mesh));
    EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size() / 2)
        << "an engine that refuses everything keeps it, too";
    EXPECT_EQ(topology_of(join_at_positions(result.mesh)), topology_of(mesh));
    return result;
  }
};

TEST_F(CgalEnvelope, HoldsForASphere) {
  const TriangleMesh sphere = shapes::icosphere(3);
  for (const CollapseCost cost : all_costs) {
    SCOPED_TRACE(static_cast<int>(cost));
    const SimplifyResult result = check(sphere, 0.01, cost);
    EXPECT_TRUE(result.closed);
    EXPECT_NE(result.shortfall.find("envelope of 0.01"), std::string::npos) << result.shortfall;
  }
}

TEST_F(CgalEnvelope, IsUsedUp) {
  // Distances reach half of the envelope or more: CGAL's prisms are sqrt(3) times thinner than what they may be. The
  // flat end of a mesh that no collapse may leave would be far below.
  const SimplifyResult result = check(shapes::icosphere(4), 0.005);
  EXPECT_GT(result.distance.hausdorff_from_second, 0.5 * 0.005);
}

TEST_F(CgalEnvelope, HoldsForAnOpenSheet) { check(shapes::wavy_sheet(30), 0.004); }
TEST_F(CgalEnvelope, HoldsForAnOpenRing) { check(shapes::cylinder_patch(24, 1, 5), 0.004); }
TEST_F(CgalEnvelope, HoldsForATorus) { check(shapes::torus(24), 0.01); }

TEST_F(CgalEnvelope, HoldsForManyParts) {
  TriangleMesh parts = shapes::icosphere(2);
  for (int i = 1; i < 5; ++i)
    parts = shapes::joined(parts, shapes::scaled(shapes::cube(4), Eigen::Vector3f::Constant(0.2f)),
                           Eigen::Vector3f(1.5f * static_cast<float>(i), 0, 0));
  check(parts, 0.004);
}

TEST_F(CgalEnvelope, HoldsForAThinPlate) {
  // Thinner than the envelope, so that either side is in reach of the other.
  const SimplifyResult result = check(shapes::scaled(shapes::cube(10), Eigen::Vector3f(1, 1, 0.01f)), 0.02);
  EXPECT_TRUE(result.closed);
}

TEST_F(CgalEnvelope, HoldsFarFromTheOrigin) {
  const TriangleMesh sphere = shapes::icosphere(3);
  std::ofstream file(folder() / "far.obj");
  file.precision(12);
  for (const Eigen::Vector3f& p : sphere.positions)
    file << "v " << 4e6 + p.x() << ' ' << -7e6 + p.y() << ' ' << p.z() << '\n';
  for (const Triangle& t : sphere.triangles) file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  file.close();
  const TriangleMesh far = load_mesh(folder() / "far.obj");
  ASSERT_GT(far.frame.origin.norm(), 1e6);
  const SimplifyResult result = check(far, 0.01);
  EXPECT_EQ(result.mesh.frame, far.frame);
}

TEST(CgalCollapse, TakesASphereToEachCount) {
  const TriangleMesh sphere = shapes::icosphere(4);
  for (const CollapseCost cost : all_costs)
    for (const int faces : {8, 200}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(cost)) + " to " + std::to_string(faces));
      const SimplifyResult result = simplify(sphere, by_cgal(faces, cost));
      EXPECT_EQ(result.mesh.triangles.size(), static_cast<std::size_t>(faces));
      EXPECT_EQ(topology_of(result.mesh), topology_of(sphere));
      EXPECT_EQ(result.flipped_triangles, 0);
      EXPECT_EQ(result.degenerate_triangles, 0);
      EXPECT_EQ(result.shortfall, "");
      // Best for 200 faces: a triangle of area 4 pi / 200 has an edge of 0.38 and lies, half outside, edge^2 / 12 =
      // 0.012 deep. Six times that is allowed, of a diagonal of 2 sqrt(3): quadrics put corners outside.
      if (faces == 200) {
        EXPECT_LT(result.distance.hausdorff, 6 * 0.012 / (2 * std::sqrt(3.0)));
      }
    }
}

TEST(CgalCollapse, KeepsBordersAndTheirCorners) {
  const TriangleMesh sheet = shapes::wavy_sheet(40);
  for (const CollapseCost cost : all_costs) {
    SCOPED_TRACE(static_cast<int>(cost));
    const SimplifyResult result = simplify(sheet, by_cgal(500, cost));
    EXPECT_LE(result.mesh.triangles.size(), 500u);
    EXPECT_GE(result.mesh.triangles.size(), 499u);
    EXPECT_EQ(topology_of(result.mesh), topology_of(sheet));
    // Waves of 0.05 on a sheet of 1, so 0.035 of a diagonal of 1.4: a border that lost them would be that far away.
    // Half of that is allowed, for the worst of the costs; lindstrom-turk comes to 0.0118.
    EXPECT_LT(result.distance.hausdorff, 0.0175);
  }
}

TEST(CgalCollapse, KeepsFeatureEdges) {
  const TriangleMesh cube = shapes::cube(8);
  const std::vector<VertexPair> edges = find_feature_edges(cube, 45);
  for (const CollapseCost cost : all_costs) {
    SCOPED_TRACE(static_cast<int>(cost));
    const Reduced low = reduce_to_faces(cube, by_cgal(60, cost), {}, {}, {edges, {}});
    EXPECT_LE(low.mesh.triangles.size(), 60u);
    double length = 0;
    for (const auto& [a, b] : low.feature_edges)
      length += (low.mesh.positions[a] - low.mesh.positions[b]).cast<double>().norm();
    EXPECT_NEAR(length, 12, 1e-4) << "the edges of a unit cube; floats round each end by 6e-8";
    for (const auto& [a, b] : low.feature_edges) {
      const Eigen::Vector3f middle = (low.mesh.positions[a] + low.mesh.positions[b]) / 2;
      int at_faces = 0;  // of the cube: two where the edge is one of it
      const BoundingBox box = bounding_box(cube);
      for (int axis = 0; axis < 3; ++axis)
        at_faces +=
            std::abs(middle[axis] - box.lowest[axis]) < 1e-5f || std::abs(middle[axis] - box.highest[axis]) < 1e-5f;
      EXPECT_EQ(at_faces, 2);
    }
  }
}

TEST(CgalCollapse, TurnsNoTriangleFartherThanAllowed) {
  for (const double degrees : {5.0, 15.0}) {
    const CollapseSequence sequence =
        collapse_by_cgal(shapes::icosphere(3), {.faces = 4}, {.max_normal_change = degrees});
    ASSERT_GT(sequence.collapses.size(), 100u);
    std::vector<Vector> at;
    for (const Eigen::Vector3f& p : sequence.start.positions) at.push_back(p.cast<double>());
    std::vector<Triangle> triangles = sequence.start.triangles;
    const auto normal = [&](const Triangle& t) {
      return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).normalized().eval();
    };
    double largest = 0;
    for (const Collapse& step : sequence.collapses) {
      std::vector<std::pair<std::size_t, Vector>> before;
      for (std::size_t i = 0; i < triangles.size(); ++i)
        if (std::count(triangles[i].begin(), triangles[i].end(), step.removed) +
                std::count(triangles[i].begin(), triangles[i].end(), step.kept) ==
            1)
          before.emplace_back(i, normal(triangles[i]));
      at[step.kept] = step.position.cast<double>();
      for (Triangle& t : triangles) std::replace(t.begin(), t.end(), step.removed, step.kept);
      std::erase_if(before, [&](const auto& entry) {
        const Triangle& t = triangles[entry.first];
        return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      });
      for (const auto& [i, was] : before)
        largest = std::max(largest, std::acos(std::clamp(was.dot(normal(triangles[i])), -1.0, 1.0)) * 180 / M_PI);
    }
    EXPECT_LT(largest, degrees + 0.01) << "positions are rounded to floats between steps";
    EXPECT_GT(largest, 0.8 * degrees) << "a limit that is never met was not tested";
  }
}

TEST(CgalCollapse, PutsTrianglesWhereWeightsAre) {
  const TriangleMesh sphere = shapes::icosphere(4);
  std::vector<double> weights;
  for (const Eigen::Vector3f& p : sphere.positions) weights.push_back(p.z() > 0 ? 100 : 1);
  const auto upper_share = [&](std::span<const double> used) {
    const TriangleMesh low = reduce_to_faces(sphere, by_cgal(400), {}, used).mesh;
    const auto upper = std::count_if(low.triangles.begin(), low.triangles.end(), [&](const Triangle& t) {
      return low.positions[t[0]].z() + low.positions[t[1]].z() + low.positions[t[2]].z() > 0;
    });
    return static_cast<double>(upper) / static_cast<double>(low.triangles.size());
  };
  EXPECT_NEAR(upper_share({}), 0.5, 0.05) << "as CGAL breaks ties";
  // Cost goes with the sixth power of an edge's length and so with the third of a triangle's area: a hundredfold weight
  // is worth 4.6 times the triangles, a share of 0.82.
  EXPECT_GT(upper_share(weights), 0.7);
}

TEST(CgalCollapse, KeepsAMaxError) {
  SimplifySettings settings = by_cgal(4);
  settings.max_error = 0.01;
  const SimplifyResult result = simplify(shapes::icosphere(4), settings);
  EXPECT_LE(result.distance.hausdorff, 0.01);
  EXPECT_GT(result.distance.hausdorff, 0.005) << "half as many triangles are twice as far";
}

TEST(CgalCollapse, SaysThatPartsCannotVanish) {
  TriangleMesh parts = shapes::icosphere(2);
  for (int i = 1; i <= 20; ++i)
    parts = shapes::joined(parts, shapes::cube(1), Eigen::Vector3f(3 * static_cast<float>(i), 0, 0));
  const SimplifyResult result = simplify(parts, by_cgal(40));
  EXPECT_EQ(result.mesh.triangles.size(), 84u) << "four for each of 21 closed parts";
  EXPECT_NE(result.shortfall.find("stopped at 84 triangles of 40"), std::string::npos) << result.shortfall;
  EXPECT_NE(result.shortfall.find("cannot vanish"), std::string::npos) << result.shortfall;
}

TEST(CgalCollapse, LetsAnInterruptionThrough) {
  const ProgressFunction interrupt = [](double) { throw Interrupted(); };
  EXPECT_THROW(simplify(shapes::icosphere(4), by_cgal(100), with_normals, interrupt), Interrupted);
}

TEST(CgalCollapse, RefusesAnEnvelopeThatNoFileKeeps) {
  SimplifySettings settings = by_cgal(100);
  settings.envelope = 5e-5;
  EXPECT_THROW(simplify(shapes::icosphere(2), settings), WrongUsage);
  settings.envelope = 0.01;
  settings.engine = SimplifyEngine::kiln;
  EXPECT_THROW(simplify(shapes::icosphere(2), settings), WrongUsage);
}

class CgalThreads : public testing::Test, protected Scratch {};

TEST_F(CgalThreads, GiveTheSameFile) {
  const auto hash_with = [&](std::size_t threads) {
    const ThreadLimit limit(threads);
    LowFile file(folder() / "low.drc");
    SimplifySettings settings = by_cgal(300, CollapseCost::probabilistic_plane);
    settings.envelope = 0.01;
    simplify(shapes::torus(40), settings, [&](const TriangleMesh& low) { return file.write(low); });
    return hash_file(folder() / "low.drc");
  };
  EXPECT_EQ(hash_with(1), hash_with(2));
}

}  // namespace test_cgal_collapse
}  // namespace kiln
