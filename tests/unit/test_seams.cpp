// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <functional>
#include <gtest/gtest.h>

#include "base/extent.h"
#include "base/parallel.h"
#include "image/gutter.h"
#include "maps/detail_maps.h"
#include "maps/seam_solver.h"
#include "normals/normals.h"
#include "shapes.h"

namespace kiln {
namespace test_seams {

/// Makes a cube sphere whose six charts are turned and scaled, each differently. Positions are rounded as Draco rounds
/// them, so that both sides of a seam have the same bits.
TriangleMesh turned_charts(int cells) {
  TriangleMesh mesh = shapes::cube_sphere(cells);
  for (Eigen::Vector3f& p : mesh.positions)
    for (float& x : p) x = std::round(x * 16384) / 16384;
  const std::size_t per_side = mesh.positions.size() / 6;
  for (std::size_t k = 0; k < mesh.uvs.size(); ++k) {
    const std::size_t side = k / per_side;
    const Eigen::Vector2f centre((static_cast<float>(side % 3) + 0.5f) / 3, (static_cast<float>(side / 3) + 0.5f) / 2);
    const float angle = 0.3f + 0.9f * static_cast<float>(side), scale = 0.7f - 0.03f * static_cast<float>(side);
    Eigen::Vector2f from_centre = (mesh.uvs[k] - centre).cwiseProduct(Eigen::Vector2f(3, 2));
    from_centre = scale * (Eigen::Rotation2Df(angle) * from_centre);
    mesh.uvs[k] = centre + from_centre.cwiseQuotient(Eigen::Vector2f(3, 2));
  }
  return mesh;
}

using Function = std::function<float(const Eigen::Vector3f&)>;

float linear(const Eigen::Vector3f& p) { return p.dot(Eigen::Vector3f(0.3f, -0.5f, 0.8f)); }
float smooth(const Eigen::Vector3f& p) { return std::sin(3 * p.x()) * std::cos(4 * p.y()) + p.z() * p.x(); }

class TurnedCharts : public ::testing::Test {
 protected:
  Image<float> sampled(const Function& function) const {
    Image<float> image(raster_.width, raster_.height, 1);
    for (int j = 0; j < raster_.height; ++j)
      for (int i = 0; i < raster_.width; ++i)
        if (raster_.at(i, j).covered())
          image.at(i, j) = function(interpolate(mesh_, mesh_.positions, raster_.at(i, j)));
    fill_gutters(image, covered_);
    return image;
  }

  /// Computes the root mean square difference between lookups on seams and the function.
  double error_at_seams(const Image<float>& image, const Function& function) const {
    double sum = 0;
    const std::vector<SeamPoint> points = seams_.points(7);
    for (const SeamPoint& point : points)
      for (const SeamSide& side : point.sides)
        sum += std::pow(side.footprint.lookup(image, 0) -
                            static_cast<double>(function(interpolate(mesh_, mesh_.positions, side.source))),
                        2);
    return std::sqrt(sum / (2.0 * static_cast<double>(points.size())));
  }

  const TriangleMesh mesh_ = turned_charts(6);
  const UvRaster raster_ = rasterise_uvs(mesh_, 192, 128);
  const std::vector<std::uint8_t> covered_ = coverage_of(raster_);
  const Seams seams_{mesh_, 192, 128};
};

TEST(Seams, AreTheEdgesWhereUvsPart) {
  // A cube has 12 edges, of 5 triangle sides each here. Both ends of both sides are the same points.
  const TriangleMesh mesh = turned_charts(5);
  const Seams seams(mesh, 64, 64);
  EXPECT_EQ(seams.edges().size(), 60u);
  for (const SeamPoint& point : seams.points(2)) {
    const Eigen::Vector3f a = interpolate(mesh, mesh.positions, point.sides[0].source),
                          b = interpolate(mesh, mesh.positions, point.sides[1].source);
    EXPECT_LT((a - b).norm(), 1e-6f);
    for (const SeamSide& side : point.sides)
      EXPECT_NEAR(
          side.footprint.weights[0] + side.footprint.weights[1] + side.footprint.weights[2] + side.footprint.weights[3],
          1, 1e-6);
  }
  // One chart has no seams, and neither have borders.
  EXPECT_TRUE(Seams(shapes::plane(4), 64, 64).edges().empty());
  EXPECT_THROW(Seams(shapes::icosphere(1), 64, 64), std::invalid_argument);
}

TEST(Seams, SheetsThatTouchAreNotMixedUp) {
  // Two planes back to back over the same positions, one chart each: four triangles at every inner edge, but the ones
  // above go on above, where uvs do not part. Only their borders meet, smoothly, as the normals hardly differ.
  TriangleMesh mesh = shapes::plane(2, 1, 0, 0.3f);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const TriangleMesh above = mesh;
  for (std::size_t k = 0; k < above.positions.size(); ++k) {
    mesh.positions.push_back(above.positions[k]);
    mesh.normals.push_back((above.normals[k] + 0.02f * Eigen::Vector3f::UnitX()).normalized());
    mesh.uvs.push_back(above.uvs[k] + Eigen::Vector2f(0.25f, 0.25f));
  }
  for (const Triangle& t : above.triangles) mesh.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
  EXPECT_EQ(Seams(mesh, 64, 64).edges().size(), 8u);

  // Sheets that face away from each other meet in a hard edge, which is not to be equalised.
  for (std::size_t k = first; k < mesh.normals.size(); ++k) mesh.normals[k] = -mesh.normals[k];
  EXPECT_TRUE(Seams(mesh, 64, 64).edges().empty());
}

TEST_F(TurnedCharts, MismatchVanishes) {
  const SeamSolver solver(seams_, covered_);
  for (const Function& function : {Function(linear), Function(smooth)}) {
    const Image<float> before = sampled(function);
    Image<float> after = before;
    solver.equalise(after);
    const SeamMismatch was = seams_.mismatch(before), is = seams_.mismatch(after);
    EXPECT_LT(is.mean, was.mean / 30);
    EXPECT_LT(is.largest, was.largest / 5);
    // Equal, and nearer to the truth: gutters that repeat a chart's last texel lag behind.
    EXPECT_LT(error_at_seams(after, function), error_at_seams(before, function) / 2);
  }
}

TEST_F(TurnedCharts, OnlyTexelsAtSeamsChangeAndCoveredOnesLittle) {
  const Image<float> before = sampled(smooth);
  Image<float> after = before;
  const SeamSolver solver(seams_, covered_);
  solver.equalise(after);
  // The texels that a lookup on a seam can see.
  std::vector<std::uint8_t> seen(covered_.size(), 0);
  for (const SeamPoint& point : seams_.points(30))
    for (const SeamSide& side : point.sides)
      for (const std::uint32_t texel : side.footprint.texels) seen[texel] = 1;
  double squares = 0;
  std::size_t changed = 0, covered_seen = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const double change = static_cast<double>(after.values()[k]) - static_cast<double>(before.values()[k]);
    changed += change != 0 ? 1 : 0;
    if (seen[k] == 0) {
      EXPECT_EQ(change, 0);
    }
    if (covered_[k] == 0 || seen[k] == 0) continue;
    squares += change * change;
    ++covered_seen;
  }
  EXPECT_GT(changed, 0u);
  EXPECT_LE(changed, solver.unknown_texels());
  // The mismatch was 0.035 in the mean; equality costs covered texels a tenth of that.
  EXPECT_GT(seams_.mismatch(before).mean, 0.02);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(covered_seen)), 0.1 * seams_.mismatch(before).mean);
}

TEST_F(TurnedCharts, WhatIsEqualStays) {
  const SeamSolver solver(seams_, covered_);
  // A constant is equal on both sides: nothing to do, up to float32 rounding.
  Image<float> flat(192, 128, 1, 0.75f);
  solver.equalise(flat);
  for (const float value : flat.values()) EXPECT_NEAR(value, 0.75f, 1e-6);
  // Equalising a second time changes little.
  const Image<float> before = sampled(smooth);
  Image<float> once = before;
  solver.equalise(once);
  Image<float> twice = once;
  solver.equalise(twice);
  const auto covered_change = [&](const Image<float>& a, const Image<float>& b) {
    double squares = 0;
    for (std::size_t k = 0; k < covered_.size(); ++k)
      if (covered_[k] != 0) squares += std::pow(static_cast<double>(a.values()[k] - b.values()[k]), 2);
    return std::sqrt(squares);
  };
  EXPECT_LT(covered_change(once, twice), 0.6 * covered_change(before, once));
  EXPECT_LE(seams_.mismatch(twice).mean, seams_.mismatch(once).mean);
}

TEST_F(TurnedCharts, ChannelsAreSolvedAloneAndThreadsDoNotMatter) {
  const SeamSolver solver(seams_, covered_);
  const Image<float> a = sampled(linear), b = sampled(smooth);
  Image<float> both(192, 128, 2);
  for (int j = 0; j < 128; ++j)
    for (int i = 0; i < 192; ++i) {
      both.at(i, j, 0) = a.at(i, j);
      both.at(i, j, 1) = b.at(i, j);
    }
  solver.equalise(both);
  std::vector<Image<float>> alone = {a, b, a, b};
  parallel_for(0, 4, [&](int k) { solver.equalise(alone[static_cast<std::size_t>(k)]); });
  const ThreadLimit limit(1);
  Image<float> again = b;
  SeamSolver(seams_, covered_).equalise(again);
  EXPECT_EQ(again.values(), alone[1].values());
  EXPECT_EQ(alone[1].values(), alone[3].values());
  for (int j = 0; j < 128; ++j)
    for (int i = 0; i < 192; ++i) {
      ASSERT_EQ(both.at(i, j, 0), alone[2].at(i, j));
      ASSERT_EQ(both.at(i, j, 1), alone[3].at(i, j));
    }
}

TEST_F(TurnedCharts, SizesHaveToFit) {
  const SeamSolver solver(seams_, covered_);
  Image<float> other(128, 128, 1), grey(192, 128, 1);
  EXPECT_THROW(solver.equalise(other), std::invalid_argument);
  EXPECT_THROW(SeamSolver(seams_, covered_, NormalSpace::tangent).equalise(grey), std::invalid_argument);
  EXPECT_THROW(SeamSolver(seams_, std::vector<std::uint8_t>(7)), std::invalid_argument);
  EXPECT_THROW(seams_.mismatch_degrees(grey, NormalSpace::object), std::invalid_argument);
}

/// Makes a sphere with dents whose detail is a few texels wide.
TriangleMesh dented_sphere() {
  TriangleMesh mesh = shapes::icosphere(6);
  for (Eigen::Vector3f& p : mesh.positions)
    p *= 1 + 0.03f * std::sin(20 * p.x()) * std::sin(17 * p.y()) * std::cos(15 * p.z());
  compute_vertex_normals(mesh);
  return mesh;
}

TEST_F(TurnedCharts, NormalMapsOfBothSpaces) {
  const TriangleMesh high = dented_sphere();
  for (const NormalSpace space : {NormalSpace::object, NormalSpace::tangent}) {
    const Extent size(192, 128);
    const NormalsResult kept = make_normals(high, mesh_, {.space = space, .size = size, .seams = SeamChoice::keep});
    const NormalsResult equal = make_normals(high, mesh_, {.space = space, .size = size});
    EXPECT_EQ(kept.normal.width(), 192);
    EXPECT_EQ(kept.normal.height(), 128);
    EXPECT_EQ(kept.seam_edges, 72u);
    EXPECT_EQ(kept.seam_after.mean, kept.seam_before.mean);
    EXPECT_EQ(kept.seam_change_degrees_rms, 0);
    EXPECT_EQ(equal.seam_before.mean, kept.seam_before.mean);
    // Texels beside charts have the high mesh's normals, so that there is less to mend than in images with plain
    // gutters; and these charts are sheared against each other, which real ones are not.
    EXPECT_GT(equal.seam_before.mean, 0.5);  // degrees
    EXPECT_LT(equal.seam_after.mean, equal.seam_before.mean / 2);
    EXPECT_LT(equal.seam_after.largest, equal.seam_before.largest / 2);
    EXPECT_GT(equal.seam_change_degrees_rms, 0);
    // The receivers stay where they are.
    EXPECT_EQ(equal.position.values(), kept.position.values());
    // The map stays about as near to the high mesh.
    EXPECT_LT(equal.map_error.mean_degrees, 1.05 * kept.map_error.mean_degrees);
  }
}

}  // namespace test_seams
}  // namespace kiln
