// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "mesh/same_position.h"
#include "scratch.h"
#include "shapes.h"
#include "simplify/low_file.h"
#include "simplify/own_low.h"
#include "simplify/simplify.h"

namespace kiln {
namespace test_own_low {

/// An octahedron whose texture is the square that it unfolds to: one chart, -Y at its four corners.
constexpr char octahedron[] =
    "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
    "vt .5 .5\nvt .9 .5\nvt .1 .5\nvt .5 .1\nvt .5 .9\nvt .9 .1\nvt .9 .9\nvt .1 .9\nvt .1 .1\n"
    "f 3/1 5/4 1/2\nf 3/1 1/2 6/5\nf 3/1 6/5 2/3\nf 3/1 2/3 5/4\n"
    "f 5/4 4/6 1/2\nf 1/2 4/7 6/5\nf 6/5 4/8 2/3\nf 2/3 4/9 5/4\n";

class OwnLowMesh : public testing::Test {
 protected:
  SimplifySettings settings_of(const std::string& text) const {
    SimplifySettings settings;
    settings.low = (folder_ / "own.obj").string();
    std::ofstream(settings.low) << text;
    return settings;
  }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

 private:
  const Scratch folder_;
};

TEST_F(OwnLowMesh, IsTakenAsItIsWithItsUvs) {
  const TriangleMesh high = shapes::icosphere(5);
  const OwnLow own = *load_own_low(settings_of(octahedron), high);
  EXPECT_TRUE(own.warnings.empty());
  EXPECT_EQ(own.mesh.triangles.size(), 8u);
  LowFile file(path("low.drc"));
  const SimplifyResult result =
      take_low(high, own.mesh, [&](const TriangleMesh& mesh) { return file.write_as_it_is(mesh); });
  EXPECT_EQ(result.mesh.triangles.size(), 8u);
  EXPECT_TRUE(result.manifold && result.closed);
  EXPECT_EQ(result.degenerate_triangles + result.flipped_triangles, 0);
  // The sphere is farthest from the middle of a face: 1 - 1/sqrt(3). 20,480 triangles lie within 1e-3 of it, and have
  // a vertex within an edge, 0.04, of that point, where the distance is less by half its square.
  const double farthest = (1 - 1 / std::sqrt(3.0)) / std::sqrt(12.0);
  EXPECT_NEAR(result.distance.hausdorff, farthest, 2e-3);

  // The corners of the unfolded square are one place, of one normal, so the seam is no hard edge.
  ASSERT_EQ(result.mesh.uvs.size(), 9u);
  EXPECT_EQ(join_at_positions(result.mesh).positions.size(), 6u);
  const std::vector<std::uint32_t> first = first_at_position(result.mesh.positions);
  for (std::size_t v = 0; v < first.size(); ++v) EXPECT_EQ(result.mesh.normals[v], result.mesh.normals[first[v]]);
  for (std::size_t v = 0; v < first.size(); ++v) {
    // Positions have steps of 2 / 65,535; uvs of less than 1 / 65,535.
    const Eigen::Vector3f& p = result.mesh.positions[v];
    EXPECT_NEAR(p.cwiseAbs().maxCoeff(), 1, 2e-5);
    if (p.y() < -0.5f) continue;
    const Eigen::Vector2f expected(0.5f + 0.4f * p.x(), 0.5f - 0.4f * p.z());
    EXPECT_LT((result.mesh.uvs[v] - expected).norm(), 5e-5f);
  }
}

TEST_F(OwnLowMesh, KeepsHardEdges) {
  SimplifySettings settings = settings_of(octahedron);
  settings.import.normals = parse_normal_choice("angle:30");
  const TriangleMesh high = shapes::icosphere(2);
  LowFile file(path("low.drc"));
  const TriangleMesh low = file.write_as_it_is(load_own_low(settings, high)->mesh);
  ASSERT_EQ(low.positions.size(), 24u);
  for (const Triangle& triangle : low.triangles)
    for (const std::uint32_t v : triangle) {
      const Eigen::Vector3f face = low.positions[triangle[0]] + low.positions[triangle[1]] + low.positions[triangle[2]];
      EXPECT_GT(low.normals[v].dot(face.normalized()), 0.9999f);  // 12 bits: steps of 0.05 degrees
    }
}

TEST_F(OwnLowMesh, UvsOfManySquaresKeepTheirSteps) {
  std::string text = octahedron;
  text.replace(text.find("vt .1 .1"), 8, "vt 100.1 .1");
  const TriangleMesh high = shapes::icosphere(2);
  LowFile file(path("low.drc"));
  const TriangleMesh low = file.write_as_it_is(load_own_low(settings_of(text), high)->mesh);
  float largest = 0;
  for (const Eigen::Vector2f& uv : low.uvs) {
    largest = std::max(largest, uv.x());
    const float nearest = std::round((uv.x() - 0.1f) / 0.4f) * 0.4f + 0.1f;
    EXPECT_NEAR(uv.x(), nearest, 2e-5f);
  }
  EXPECT_NEAR(largest, 100.1f, 2e-5f);
}

TEST_F(OwnLowMesh, UvsThatAreNotEverywhereAreLeftOutAloud) {
  std::string text = octahedron;
  text.replace(text.rfind("f 2/3 4/9 5/4"), 13, "f 2 4 5");
  const OwnLow own = *load_own_low(settings_of(text), shapes::icosphere(2));
  EXPECT_TRUE(own.mesh.uvs.empty());
  ASSERT_EQ(own.warnings.size(), 1u);
  EXPECT_NE(own.warnings[0].find("line 23"), std::string::npos) << own.warnings[0];
}

TEST_F(OwnLowMesh, ColorsAreLeftOutAloud) {
  std::string text = octahedron;
  for (const char* vertex : {"v 1 0 0\n", "v -1 0 0\n", "v 0 1 0\n", "v 0 -1 0\n", "v 0 0 1\n", "v 0 0 -1\n"})
    text.insert(text.find(vertex) + std::string(vertex).size() - 1, " 1 .5 0");
  const TriangleMesh high = shapes::icosphere(2);
  const OwnLow own = *load_own_low(settings_of(text), high);
  ASSERT_EQ(own.warnings.size(), 1u);
  EXPECT_NE(own.warnings[0].find("--colors takes those of the high mesh"), std::string::npos) << own.warnings[0];
  LowFile file(path("low.drc"));
  EXPECT_TRUE(file.write_as_it_is(own.mesh).colors.empty());
}

TEST_F(OwnLowMesh, IsMeasuredInTheFrameOfTheHighMesh) {
  // A hundred thousand times as large, the file's own frame is another.
  TriangleMesh high = shapes::icosphere(2), low = high;
  for (Eigen::Vector3f& position : low.positions) position *= 1e5f;
  LowFile file(path("low.drc"));
  const TriangleMesh written = file.write_as_it_is(low);
  EXPECT_EQ(written.frame, high.frame);
  EXPECT_NEAR(bounding_box(written).diagonal(), 1e5f * bounding_box(high).diagonal(), 10);
}

TEST_F(OwnLowMesh, LiesWhereTheHighMeshDoes) {
  const TriangleMesh high = shapes::cylinder_patch(8, 3, 3);
  const auto changed = [&](const auto& change) {
    TriangleMesh low = high;
    for (Eigen::Vector3f& position : low.positions) position = change(position);
    return misplacement(low, high);
  };
  using Point = Eigen::Vector3f;
  EXPECT_EQ(changed([](const Point& p) { return Point(0.8f * p); }), "");
  EXPECT_NE(changed([](const Point& p) { return Point(0.4f * p); }), "");
  const std::string larger = changed([](const Point& p) { return Point(100 * p); });
  EXPECT_NE(larger.find("100 times as large"), std::string::npos) << larger;
  EXPECT_NE(larger.find("--low-scale 0.01"), std::string::npos) << larger;
  const std::string turned = changed([](const Point& p) { return Point(p.x(), -p.z(), p.y()); });
  EXPECT_NE(turned.find("--low-up"), std::string::npos) << turned;
  const std::string moved = changed([](const Point& p) { return Point(p + Point(10, 0, 0)); });
  EXPECT_NE(moved.find("lies 10 from"), std::string::npos) << moved;
}

}  // namespace test_own_low
}  // namespace kiln
