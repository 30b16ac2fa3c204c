// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "base/parallel.h"
#include "import/import_mesh.h"
#include "raycast/beam_transfer.h"
#include "raycast/ray_transfer.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"
#include "shapes.h"

namespace kiln {
namespace test_ray_transfer {

constexpr int bands = 3;
struct Points {
  std::vector<Eigen::Vector3f> positions, normals;
  Receivers view() const { return {positions, normals}; }
};

/// Takes every `step`-th vertex, with its normal.
Points vertices_of(const TriangleMesh& mesh, std::size_t step) {
  std::vector<Eigen::Vector3f> sums(mesh.positions.size(), Eigen::Vector3f::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    for (std::uint32_t vertex : t) sums[vertex] += (b - a).cross(c - a);
  }
  Points points;
  for (std::size_t v = 0; v < sums.size(); v += step) {
    if (!(sums[v].squaredNorm() > 0)) continue;
    points.positions.push_back(mesh.positions[v]);
    points.normals.push_back(sums[v].normalized());
  }
  return points;
}

std::vector<Eigen::Vector3f> coherent(int count, int seed) {
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, count, seed);
  order_coherently(directions, block_directions);
  return directions;
}

TransferSums by_beams(const TriangleMesh& mesh, const Points& points, std::span<const Eigen::Vector3f> directions) {
  TransferSums sums(points.positions.size(), coefficient_count(bands));
  add_transfer_by_beams(BeamScene(mesh.positions, mesh.triangles),
                        BeamReceivers(points.view(), rounding_offset(mesh.positions)), directions, sums);
  return sums;
}

TransferSums by_streams(const TriangleMesh& mesh, const Points& points, std::span<const Eigen::Vector3f> directions) {
  TransferSums sums(points.positions.size(), coefficient_count(bands));
  add_transfer_by_rays(RayScene(mesh), points.view(), directions, rounding_offset(mesh.positions), sums);
  return sums;
}

/// Lists the receivers for which some direction was decided differently. Rounding of a block's sum amounts to some
/// units of fixed point, a ray to its cosine times 2 million of them in the first plane.
int receivers_that_differ(const TransferSums& a, const TransferSums& b) {
  const std::int64_t roundings = 32 * ((a.directions + block_directions - 1) / block_directions);
  int differing = 0;
  for (std::size_t r = 0; r < a.receivers; ++r)
    differing += std::abs(a.plane(0)[r] - b.plane(0)[r]) > roundings ? 1 : 0;
  return differing;
}

TEST(RayTransfer, BeamsSeeWhatEmbreeSees) {
  TriangleMesh open_torus = shapes::torus(40);
  open_torus.triangles.resize(open_torus.triangles.size() * 3 / 4);
  TriangleMesh dense_open = shapes::torus(200);
  dense_open.triangles.resize(dense_open.triangles.size() * 3 / 4);
  TriangleMesh crossing = shapes::joined(shapes::torus(30), shapes::cube(6), {1, 0.1f, 0.05f});
  struct Case {
    const char* name;
    TriangleMesh mesh;
    std::size_t step;
  };
  const std::vector<Case> cases = {
      {"torus: closed", shapes::torus(40), 1},
      {"open torus: receivers see back faces", open_torus, 1},
      {"crossing: receivers inside another solid", crossing, 1},
      {"dense: many triangles under 16 receivers", shapes::torus(200), 31},
      {"dense and open", dense_open, 31},
      {"dense, few receivers far apart", shapes::torus(200), 499},
      {"dense, crossing", shapes::joined(shapes::torus(150), shapes::icosphere(6), {1, 0.1f, 0.05f}), 53},
      {"sheet", shapes::wavy_sheet(30, 3, 0.1f), 1},
      {"bunny", load_mesh("/usr/share/glmark2/models/bunny.obj"), 17}};
  for (const Case& c : cases) {
    const Points points = vertices_of(c.mesh, c.step);
    for (const int count : {1, 31, 1000}) {
      const std::vector<Eigen::Vector3f> directions = coherent(count, 3);
      const int differing =
          receivers_that_differ(by_beams(c.mesh, points, directions), by_streams(c.mesh, points, directions));
      // Rays that pass an edge or leave a surface within float32's roundings may go either way.
      EXPECT_LE(differing, static_cast<int>(points.positions.size()) / 200) << c.name << ", " << count << " directions";
    }
  }
}

/// Places `count` points inside the mesh's triangles in turn, computed in float32 as a stage does, with the triangles'
/// normals.
Points points_of_faces(const TriangleMesh& mesh, std::size_t count) {
  Points points;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t index = k * 7919 % mesh.triangles.size();
    const Triangle& t = mesh.triangles[index];
    const float u = (static_cast<float>(k * 37 % 101) + 0.5f) / 101,
                v = (1 - u) * (static_cast<float>(k * 53 % 97) + 0.5f) / 97;
    const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    points.positions.push_back((1 - u - v) * a + u * b + v * c);
    points.normals.push_back((b - a).cross(c - a).normalized());
  }
  return points;
}

/// Doubles the points, the second time with reversed normals: receivers on both sides of a surface.
Points both_sides(Points points) {
  const std::size_t count = points.positions.size();
  for (std::size_t k = 0; k < count; ++k) {
    points.positions.push_back(Eigen::Vector3f(points.positions[k]));
    points.normals.push_back(-points.normals[k]);
  }
  return points;
}

TEST(RayTransfer, BeamsSeeWhatEmbreeSeesThroughHoles) {
  const auto without = [](TriangleMesh mesh, const auto& is_gone) {
    std::vector<Triangle> left;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
      if (!is_gone(mesh, k)) left.push_back(mesh.triangles[k]);
    mesh.triangles = left;
    return mesh;
  };
  const auto above = [](float height) {
    return
        [height](const TriangleMesh& mesh, std::size_t k) { return mesh.positions[mesh.triangles[k][0]].y() > height; };
  };
  const auto turned_round = [](TriangleMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
  };
  const auto scattered = [](const TriangleMesh&, std::size_t k) { return k * 7919 % 10 == 0; };
  const TriangleMesh bowl = without(shapes::icosphere(4), above(0.3f));
  // Three sheets that meet at the z axis.
  TriangleMesh fins;
  fins.positions = {{0, 0, -1}, {0, 0, 1}};
  for (const float angle : {0.f, 2.f, 4.f}) {
    const auto first = static_cast<std::uint32_t>(fins.positions.size());
    const Eigen::Vector2f along(std::cos(angle), std::sin(angle));
    fins.positions.emplace_back(along.x(), along.y(), -1);
    fins.positions.emplace_back(along.x(), along.y(), 1);
    fins.triangles.push_back({0, first, first + 1});
    fins.triangles.push_back({0, first + 1, 1});
  }
  const std::vector<std::pair<const char*, TriangleMesh>> cases = {
      {"bowl", bowl},
      {"bowl, turned inside out", turned_round(bowl)},
      {"bowl in a bowl", shapes::joined(bowl, bowl, {0.1f, 0.3f, 0})},
      {"torus with many holes", without(shapes::torus(60), scattered)},
      {"hills with holes", without(shapes::wavy_sheet(40, 3, 0.2f), scattered)},
      {"fins", fins},
      {"bowl and solid", shapes::joined(bowl, shapes::cube(4), {0.2f, 0, 0.1f})}};
  for (const auto& [name, mesh] : cases) {
    const Points points = both_sides(points_of_faces(mesh, 2000));
    const std::vector<Eigen::Vector3f> directions = coherent(1000, 3);
    const int differing =
        receivers_that_differ(by_beams(mesh, points, directions), by_streams(mesh, points, directions));
    // Rays that pass an edge or leave a surface within float32's roundings may go either way.
    EXPECT_LE(differing, static_cast<int>(points.positions.size()) / 200) << name;
  }
}

TEST(RayTransfer, AConvexSolidNeverShadowsItself) {
  // At the origin, and as far away as a mesh stays without a frame of its own (8 sides).
  const auto moved = [](TriangleMesh mesh, const Eigen::Vector3f& by, const Eigen::Vector3f& scale) {
    for (Eigen::Vector3f& p : mesh.positions) p = p.cwiseProduct(scale) + by;
    return mesh;
  };
  const auto turned = [](TriangleMesh mesh, float angle) {
    const Eigen::AngleAxisf turn(angle, Eigen::Vector3f(0.3f, 0.5f, 0.8f).normalized());
    for (Eigen::Vector3f& p : mesh.positions) p = turn * p;
    return mesh;
  };
  const std::vector<Eigen::Vector3f> directions = coherent(2000, 3);
  const TriangleMesh slab = moved(shapes::cube(1), {0, 0, 0}, {1, 1e-3f, 1}),
                     needle = moved(shapes::cube(1), {0, 0, 0}, {1, 2e-3f, 1e-3f});
  // Slivers a thousand times longer than high: a point next to an edge may be on either side of it, by rounding.
  for (const TriangleMesh& mesh : {turned(slab, 0.3f), turned(slab, 1.1f), turned(needle, 0.7f), turned(needle, 2)}) {
    const Points points = points_of_faces(mesh, 3000);
    EXPECT_LE(receivers_that_differ(by_streams(mesh, points, directions), by_beams({}, points, directions)), 3);
    EXPECT_LE(receivers_that_differ(by_beams(mesh, points, directions), by_beams({}, points, directions)), 3);
  }
  for (const TriangleMesh& mesh :
       {slab, shapes::icosphere(0), shapes::icosphere(2), moved(shapes::icosphere(2), {16, -16, 16}, {1, 1, 1}),
        moved(shapes::cube(1), {16, 16, 16}, {1, 1, 1}), moved(shapes::cube(1), {3, 0, 0}, {1, 1e-2f, 1e-2f})}) {
    const Points points = points_of_faces(mesh, 3000);
    const TransferSums free = by_beams({}, points, directions);
    EXPECT_EQ(receivers_that_differ(by_streams(mesh, points, directions), free), 0) << mesh.positions[0].transpose();
    EXPECT_EQ(receivers_that_differ(by_beams(mesh, points, directions), free), 0) << mesh.positions[0].transpose();
  }
}

TEST(RayTransfer, ACreviceOfAHundredThousandthIsDark) {
  TriangleMesh plates;
  for (const float height : {0.f, 1e-5f})
    for (const Eigen::Vector2f& at : {Eigen::Vector2f(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
      plates.positions.emplace_back(at.x(), height, at.y());
  plates.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  Points points;
  for (int k = 0; k < 100; ++k) {
    points.positions.emplace_back(static_cast<float>(k % 10) * 0.1f - 0.45f, 0.f,
                                  static_cast<float>(k / 10) * 0.1f - 0.45f);
    points.normals.emplace_back(0, 1, 0);
  }
  for (std::int64_t value : by_beams(plates, points, coherent(1000, 1)).values) ASSERT_EQ(value, 0);
  for (std::int64_t value : by_streams(plates, points, coherent(1000, 1)).values) ASSERT_EQ(value, 0);
}

TEST(RayTransfer, NoRaySlipsOutOfAClosedCavity) {
  const TriangleMesh mesh = shapes::icosphere(4);
  Points points;
  for (const Eigen::Vector3f& point : sample_directions(Sampling::fibonacci, 500, 4)) {
    points.positions.push_back(0.9f * point);
    points.normals.push_back(-point);
  }
  const TransferSums sums = by_beams(mesh, points, coherent(5000, 1));
  for (std::int64_t value : sums.values) ASSERT_EQ(value, 0);
  // Aimed at corners and at the middles of edges, from the middle of the solid.
  Points centre{{Eigen::Vector3f::Zero()}, {Eigen::Vector3f(0, 1, 0)}};
  std::vector<Eigen::Vector3f> aimed;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f &a = mesh.positions[t[k]], &b = mesh.positions[t[(k + 1) % 3]];
      aimed.push_back(a.normalized());
      aimed.push_back((a + b).normalized());
    }
  for (std::int64_t value : by_beams(mesh, centre, aimed).values) ASSERT_EQ(value, 0);
}

TEST(RayTransfer, NothingIsTestedWhereNothingStands) {
  const TriangleMesh mesh = shapes::icosphere(4);
  const Points points = vertices_of(mesh, 1);
  const std::vector<Eigen::Vector3f> directions = coherent(2048, 2);
  TransferSums sums(points.positions.size(), coefficient_count(bands));
  // Vertices of a faceted sphere: rays that start farther off than its facets are from it see nothing of it.
  constexpr float ray_offset = 1e-3f;
  const BeamSavings savings = add_transfer_by_beams(BeamScene(mesh.positions, mesh.triangles),
                                                    BeamReceivers(points.view(), ray_offset), directions, sums);
  const auto pairs = static_cast<double>(points.positions.size() * directions.size());
  // Each direction faces one half of a sphere, and sees all of it. Packets on the rim are in neither share.
  EXPECT_GT(static_cast<double>(savings.behind), 0.35 * pairs);
  EXPECT_GT(static_cast<double>(savings.lit), 0.4 * pairs);
}

TEST(RayTransfer, SameBitsForAnyThreadsAndAnyCuts) {
  const TriangleMesh mesh = shapes::torus(40);
  const Points points = vertices_of(mesh, 1);
  const std::vector<Eigen::Vector3f> directions = coherent(1000, 5);
  const auto sums = [&](int threads) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    return by_beams(mesh, points, directions).values;
  };
  const std::vector<std::int64_t> one = sums(1);
  EXPECT_EQ(one, sums(4));

  // Whole blocks in two calls.
  TransferSums cut(points.positions.size(), coefficient_count(bands));
  const BeamScene scene(mesh.positions, mesh.triangles);
  const BeamReceivers receivers(points.view(), rounding_offset(mesh.positions));
  add_transfer_by_beams(scene, receivers, std::span(directions).first(320), cut);
  add_transfer_by_beams(scene, receivers, std::span(directions).subspan(320), cut);
  EXPECT_EQ(one, cut.values);

  // Receivers in another order: other packets.
  Points reversed = points;
  std::reverse(reversed.positions.begin(), reversed.positions.end());
  std::reverse(reversed.normals.begin(), reversed.normals.end());
  const TransferSums backwards = by_beams(mesh, reversed, directions);
  int differing = 0;
  for (std::size_t r = 0; r < points.positions.size(); ++r)
    differing += backwards.plane(0)[points.positions.size() - 1 - r] != one[r] ? 1 : 0;
  EXPECT_LE(differing, static_cast<int>(points.positions.size()) / 200);  // roundings about another packet's centre
}

TEST(RayTransfer, SumsAreTrueForAnyNumberOfDirections) {
  // Nothing is in the way, so that the sums are known: in float64, from the same float32 directions.
  Points points;
  for (const Eigen::Vector3f& normal : sample_directions(Sampling::fibonacci, 3, 7)) {
    points.positions.push_back(normal);
    points.normals.push_back(normal);
  }
  const ShBasis basis(bands);
  for (const int count : {1, 1000, 1000000}) {
    const std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, count, 1);
    const TransferSums sums = by_beams({}, points, directions);
    std::vector<double> expected(points.positions.size() * basis.size(), 0), values(basis.size());
    for (const Eigen::Vector3f& direction : directions) {
      basis.evaluate<double>(direction.cast<double>(), values);
      for (std::size_t r = 0; r < points.positions.size(); ++r) {
        const double cosine = points.normals[r].cast<double>().dot(direction.cast<double>());
        for (int i = 0; i < basis.size(); ++i) expected[r * basis.size() + i] += std::max(0.0, cosine) * values[i];
      }
    }
    double squared_error = 0, squared = 0;
    for (std::size_t r = 0; r < points.positions.size(); ++r)
      for (int i = 0; i < basis.size(); ++i) {
        const double truth = expected[r * basis.size() + i];
        const double error = static_cast<double>(sums.plane(i)[r]) / fixed_point_one - truth;
        squared_error += error * error;
        squared += truth * truth;
      }
    EXPECT_LT(std::sqrt(squared_error / squared), 1e-5) << count << " directions";
  }
}

TEST(RayTransfer, EmptyScenesAndFewReceivers) {
  const std::vector<Eigen::Vector3f> directions = coherent(100, 1);
  EXPECT_EQ(by_beams(shapes::torus(8), {}, directions).values.size(), 0u);
  TriangleMesh one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  const Points point{{{0.2f, 0.2f, 0.1f}}, {{0, 0, -1}}};
  const TransferSums hidden = by_beams(one, point, directions), free = by_beams({}, point, directions);
  EXPECT_LT(hidden.plane(0)[0], free.plane(0)[0]);
  EXPECT_EQ(receivers_that_differ(hidden, by_streams(one, point, directions)), 0);
}

}  // namespace test_ray_transfer
}  // namespace kiln
