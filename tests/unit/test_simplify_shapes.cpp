// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that fall apart easily: thin walls, specks, slivers, parts far away. All of it is generated.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/parallel.h"
#include "hard_shapes.h"
#include "import/import_mesh.h"
#include "mesh/mesh_components.h"
#include "mesh/mesh_distance.h"
#include "scratch.h"
#include "simplify/low_file.h"
#include "simplify/simplify.h"
#include "simplify/small_components.h"

namespace kiln {
namespace test_simplify_shapes {

constexpr SimplifyQuality all_qualities[] = {SimplifyQuality::draft, SimplifyQuality::standard, SimplifyQuality::best};

const char* name_of(SimplifyQuality quality) {
  return quality == SimplifyQuality::draft ? "draft" : quality == SimplifyQuality::standard ? "standard" : "best";
}

/// Counts the components that have the extent of the unit box.
int count_boxes(const TriangleMesh& mesh, float side) {
  int count = 0;
  for (const BoundingBox& box : component_boxes(mesh, find_components(mesh)))
    count += ((box.highest - box.lowest).array() - side).abs().maxCoeff() < 0.01f * side;
  return count;
}

TEST(HardShapes, AThinBowlIsNotTorn) {
  const TriangleMesh bowl = shapes::thin_bowl(32, 8, 0.001f);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(name_of(quality));
    const SimplifyResult result = simplify(bowl, {.faces = 300, .quality = quality});
    EXPECT_LE(result.mesh.triangles.size(), 300u);
    EXPECT_TRUE(result.closed);
    EXPECT_EQ(result.flipped_triangles, 0);
    EXPECT_LT(result.distance.hausdorff, 0.02);
  }
}

TEST(HardShapes, AFineThinBowlIsNotTorn) {
  const TriangleMesh bowl = shapes::thin_bowl(144, 36, 0.002f);
  for (const SimplifyQuality quality : all_qualities)
    for (const int faces : {400, 2000}) {
      SCOPED_TRACE(std::string(name_of(quality)) + " to " + std::to_string(faces));
      const SimplifyResult result = simplify(bowl, {.faces = faces, .quality = quality});
      EXPECT_EQ(result.mesh.triangles.size(), static_cast<std::size_t>(faces));
      EXPECT_EQ(result.flipped_triangles, 0);
      EXPECT_LT(result.distance.hausdorff, 0.02);
    }
}

TEST(HardShapes, SpecksDoNotEatABox) {
  const TriangleMesh mesh = shapes::with_specks(shapes::cube(4), 40, 0.002f);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(name_of(quality));
    const SimplifyResult result = simplify(mesh, {.faces = 100, .quality = quality});
    EXPECT_LE(result.mesh.triangles.size(), 100u);
    EXPECT_EQ(count_boxes(result.mesh, 1), 1);
    EXPECT_EQ(result.dropped.components, 40);
    EXPECT_EQ(result.dropped.triangles, 480);
    EXPECT_NEAR(result.dropped.area_share, 40 * 0.002 * 0.002, 1e-5);
    EXPECT_TRUE(result.shortfall.empty());
    EXPECT_LT(result.distance.hausdorff, 1e-5) << "from what is left of the input";
    EXPECT_EQ(result.to_json()["dropped_components"], 40);
  }
}

TEST(HardShapes, WhatMayNotBeDroppedIsNotPaidForByTheRest) {
  const TriangleMesh mesh = shapes::with_specks(shapes::cube(4), 40, 0.002f);
  for (const SimplifyQuality quality : all_qualities) {
    SCOPED_TRACE(name_of(quality));
    const SimplifyResult result = simplify(mesh, {.faces = 100, .quality = quality, .drop_components = "0"});
    EXPECT_EQ(result.dropped.components, 0);
    EXPECT_EQ(result.mesh.triangles.size(), 12u + 40 * 4);
    EXPECT_EQ(count_boxes(result.mesh, 1), 1);
    EXPECT_LT(result.distance.hausdorff, 0.002);
    // The reason has the numbers, and the advice is right.
    EXPECT_NE(result.shortfall.find("stopped at 172 triangles of 100: 40 components of 4 triangles each cannot vanish"),
              std::string::npos)
        << result.shortfall;
    const std::string advice = "--drop-components ";
    const std::size_t at = result.shortfall.find(advice);
    ASSERT_NE(at, std::string::npos) << result.shortfall;
    const std::size_t begin = at + advice.size();
    const std::string size = result.shortfall.substr(begin, result.shortfall.find(' ', begin) - begin);
    const SimplifyResult followed = simplify(mesh, {.faces = 100, .quality = quality, .drop_components = size});
    EXPECT_LE(followed.mesh.triangles.size(), 100u);
    EXPECT_NE(result.shortfall.find("drops " + std::to_string(followed.dropped.components) + " component"),
              std::string::npos);
  }
}

TEST(HardShapes, WhatIsMostOfAMeshIsNoSpeck) {
  // A ball, and a grain 2,000 diameters away: by its diagonal, the ball is small.
  TriangleMesh mesh = shapes::joined(shapes::icosphere(3), shapes::scaled(shapes::cube(1), {0.01f, 0.01f, 0.01f}),
                                     Eigen::Vector3f(4000, 0, 0));
  const DroppedComponents dropped = drop_small_components(mesh, {.drop_components = "0.01"});
  EXPECT_EQ(dropped.components, 1);
  EXPECT_EQ(dropped.triangles, 12);
  EXPECT_EQ(mesh.triangles.size(), 1280u);
  // Gravel is all of a mesh of gravel.
  TriangleMesh gravel =
      shapes::with_specks(shapes::scaled(shapes::cube(1), Eigen::Vector3f::Constant(0.002f)), 300, 0.002f);
  gravel = shapes::scaled(gravel, Eigen::Vector3f::Constant(100));
  TriangleMesh kept = gravel;
  EXPECT_EQ(drop_small_components(kept, {.faces = 100}).components, 0) << "auto";
  EXPECT_EQ(kept.triangles.size(), gravel.triangles.size());
  EXPECT_LE(drop_small_components(kept, {.drop_components = "1"}).area_share, 0.5);
  EXPECT_THROW(drop_small_components(kept, {.drop_components = "-1"}), WrongUsage);
  EXPECT_THROW(drop_small_components(kept, {.drop_components = "0.1x"}), WrongUsage);
}

TEST(HardShapes, SliversOnABoxVanish) {
  const TriangleMesh box = shapes::box_with_slivers(4, 1e-7f);
  ASSERT_TRUE(is_closed(box));
  for (const SimplifyQuality quality : all_qualities)
    for (const int faces : {60, 12}) {
      SCOPED_TRACE(std::string(name_of(quality)) + " to " + std::to_string(faces));
      const SimplifyResult result = simplify(box, {.faces = faces, .quality = quality});
      EXPECT_EQ(result.mesh.triangles.size(), static_cast<std::size_t>(faces));
      EXPECT_LT(result.distance.hausdorff, 1e-5);
      EXPECT_NEAR(surface_area(result.mesh), 6, 1e-4);
      EXPECT_EQ(result.degenerate_triangles, 0);
      EXPECT_EQ(result.flipped_triangles, 0);
    }
}

class FarParts : public testing::Test, protected Scratch {};

TEST_F(FarParts, DoNotKeepABallFromSimplification) {
  for (const float away : {4000.0f, 100'000.0f}) {
    SCOPED_TRACE(away);
    const TriangleMesh mesh =
        shapes::joined(shapes::icosphere(2), shapes::scaled(shapes::cube(1), Eigen::Vector3f::Constant(0.05f)),
                       Eigen::Vector3f(away, 0, 0));
    for (const SimplifyQuality quality : all_qualities) {
      SCOPED_TRACE(name_of(quality));
      LowFile file(folder() / "low.drc");
      const SimplifyResult result =
          simplify(mesh, {.faces = 100, .quality = quality}, [&](const TriangleMesh& low) { return file.write(low); });
      EXPECT_LE(result.mesh.triangles.size(), 100u);
      EXPECT_GE(result.mesh.triangles.size(), 90u);
      EXPECT_TRUE(result.closed);
      EXPECT_EQ(result.degenerate_triangles, 0);
      EXPECT_EQ(result.flipped_triangles, 0);
      // Distances in units: a ball of 100 triangles is about 0.05 off; a step of 24 bits is 0.006 of the farther mesh.
      EXPECT_LT(result.hausdorff_distance, 0.12);
      EXPECT_GT(file.position_bits(), 16);
      EXPECT_EQ(file.too_few_steps() > 0, away > 50'000);
    }
  }
}

struct Shape {
  std::string name;
  std::function<TriangleMesh()> mesh;
  std::vector<int> faces;
};

/// Names a shape where GoogleTest prints parameters, which would else be bytes of memory.
void PrintTo(const Shape& shape, std::ostream* stream) { *stream << shape.name; }

std::vector<Shape> all_shapes() {
  using namespace shapes;
  return {{"sphere", [] { return icosphere(4); }, {50, 400}},
          {"torus", [] { return torus(48); }, {100, 500}},
          {"cube", [] { return cube(12); }, {12, 100}},
          {"cloth", [] { return wavy_sheet(40); }, {60, 400}},
          {"cylinder_patch", [] { return cylinder_patch(30, 2, 4); }, {20, 100}},
          {"thin_bowl", [] { return thin_bowl(64, 16, 0.002f); }, {200, 600}},
          {"gear", [] { return gear(16, 8); }, {600, 1200}},
          {"slivers", [] { return box_with_slivers(4, 1e-7f); }, {20, 60}},
          {"specks", [] { return with_specks(icosphere(4), 20, 0.003f); }, {100, 500}},
          {"two_spheres",
           [] {
             return joined(icosphere(3), icosphere(3), {1000, 0, 0});
           },
           {200, 600}},
          {"far_from_the_origin",
           [] {
             return joined({}, torus(48), {5000, 3000, -8000});
           },
           {200}},
          {"character", [] { return character(26, 3); }, {600, 1800}},
          {"bunny", [] { return load_mesh("/usr/share/glmark2/models/bunny.obj"); }, {300}}};
}

class EachQuality : public testing::TestWithParam<Shape> {};

TEST_P(EachQuality, IsNoWorseThanTheOneBelow) {
  const TriangleMesh mesh = GetParam().mesh();
  for (const int faces : GetParam().faces) {
    SCOPED_TRACE("to " + std::to_string(faces));
    const auto result_of = [&](SimplifyQuality quality) {
      return simplify(mesh, {.faces = faces, .quality = quality});
    };
    const SimplifyResult draft = result_of(SimplifyQuality::draft), standard = result_of(SimplifyQuality::standard),
                         best = result_of(SimplifyQuality::best);
    for (const SimplifyResult* result : {&draft, &standard, &best}) {
      EXPECT_LE(result->mesh.triangles.size(), static_cast<std::size_t>(faces)) << result->shortfall;
      EXPECT_EQ(result->degenerate_triangles, 0);
      EXPECT_EQ(result->flipped_triangles, 0);
      EXPECT_TRUE(result->manifold);
    }
    EXPECT_LE(best.distance.hausdorff, draft.distance.hausdorff);
    EXPECT_LE(best.distance.rms, draft.distance.rms);
    // `standard` minimises the mean distance; its largest distance depends on single triangles, where draft may be
    // lucky: at worst it is 2.2 times draft's, on the thin bowl. The means may be a tie.
    EXPECT_LE(standard.distance.rms, 1.15 * draft.distance.rms + 1e-6);
    EXPECT_LE(standard.distance.hausdorff, 2.5 * draft.distance.hausdorff + 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EachQuality, testing::ValuesIn(all_shapes()),
                         [](const auto& shape) { return shape.param.name; });

class ManyParts : public testing::Test, protected Scratch {};

TEST_F(ManyParts, AreTheSameOnOneThreadAndTwo) {
  const TriangleMesh high = shapes::character(12, 2), bowl = shapes::thin_bowl(48, 12, 0.002f);
  const auto bytes = [&](std::size_t threads, const TriangleMesh& mesh, const SimplifySettings& settings) {
    const ThreadLimit limit(threads);
    LowFile file(folder() / "low.drc");
    simplify(mesh, settings, [&](const TriangleMesh& low) { return file.write(low); });
    return read_text(folder() / "low.drc");
  };
  for (const TriangleMesh* mesh : {&high, &bowl})
    for (const SimplifyQuality quality : all_qualities)
      EXPECT_EQ(bytes(1, *mesh, {.faces = 300, .quality = quality}),
                bytes(2, *mesh, {.faces = 300, .quality = quality}));
}

TEST(FlippedTriangles, AreThoseThatFaceAgainstAllThatIsNear) {
  const TriangleMesh bowl = shapes::thin_bowl(32, 8, 0.001f);
  // A copy, slightly smaller: each side lies on the other one or beyond it.
  const TriangleMesh smaller = shapes::scaled(bowl, Eigen::Vector3f::Constant(0.998f));
  EXPECT_EQ(count_flipped(smaller, bowl, flipped_reach(smaller, 0.002)), 0);
  TriangleMesh turned = shapes::icosphere(3);
  for (std::size_t i = 0; i < 5; ++i) std::swap(turned.triangles[17 * i][0], turned.triangles[17 * i][1]);
  EXPECT_EQ(count_flipped(turned, shapes::icosphere(3), flipped_reach(turned, 0)), 5);
}

}  // namespace test_simplify_shapes
}  // namespace kiln
