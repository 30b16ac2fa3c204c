// SPDX-License-Identifier: GPL-3.0-or-later
// What the user can ask of an atlas besides how it is cut and packed: its size, its density, uvs to keep; and what
// becomes of odd triangles.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

#include "atlas/atlas.h"
#include "atlas/charts.h"
#include "atlas/density.h"
#include "atlas/drawing.h"
#include "atlas/keep_uv.h"
#include "base/errors.h"
#include "base/extent.h"
#include "base/json.h"
#include "import/uv_mesh.h"
#include "mesh/uv_raster.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_atlas_layout {

namespace fs = std::filesystem;

class AtlasLayout : public ::testing::Test {
 protected:
  WrittenAtlas written(const AtlasResult& result) const { return write_atlas(folder_ / "atlas.drc", result); }

  fs::path file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  const Scratch folder_;
};

/// Makes settings with few angles, which packs quickly: packing is not tested here.
AtlasSettings quick_settings(const Extent& size, int gutter = 4) {
  AtlasSettings settings;
  settings.size = size;
  settings.gutter = gutter;
  settings.rotations = 2;
  return settings;
}

TriangleMesh with_vertex_normals(TriangleMesh mesh) {
  compute_vertex_normals(mesh);
  return mesh;
}

/// Checks that every triangle without texels is reported.
void expect_told(const AtlasMeasures& measures, const TriangleMesh& atlas, const Extent& size) {
  const UvRaster raster = rasterise_uvs(atlas, size.width, size.height);
  std::vector<int> texels(atlas.triangles.size());
  for (const TexelSource& texel : raster.texels)
    if (texel.covered()) ++texels[texel.triangle];
  EXPECT_EQ(measures.uncovered_triangles, std::count(texels.begin(), texels.end(), 0));
  EXPECT_EQ(measures.uncovered.size(), std::min<std::size_t>(100, measures.uncovered_triangles));
  for (const auto& entry : measures.uncovered) EXPECT_EQ(texels[entry.triangle], 0);
  EXPECT_EQ(measures.overlapping_texels, 0);
  EXPECT_EQ(measures.flipped_triangles, 0);
}

TEST_F(AtlasLayout, IsAsWideAndHighAsAsked) {
  const TriangleMesh mesh = shapes::torus(12);
  for (const Extent& size : {Extent(192, 72), Extent(72, 192)}) {
    SCOPED_TRACE(size.text());
    const AtlasSettings settings = quick_settings(size, 2);
    const AtlasResult result = make_atlas(mesh, settings);
    EXPECT_EQ(result.size, size);
    const WrittenAtlas atlas = written(result);
    EXPECT_GT(atlas.measures.utilisation, 0.35);
    EXPECT_GE(atlas.measures.smallest_gap_texels, 2);
    // Texels are as wide as high on the surface: stretch is that of the charts.
    EXPECT_LT(atlas.measures.stretch.l2, 1.01);
    expect_told(atlas.measures, atlas.mesh, size);
    const Json json = result.to_json();
    EXPECT_EQ(json["width"], size.width);
    EXPECT_EQ(json["height"], size.height);

    const Image<std::uint8_t> picture = draw_atlas(atlas.mesh, size, 2);
    EXPECT_EQ(picture.width() * size.height, picture.height() * size.width);
    EXPECT_GE(std::max(picture.width(), picture.height()), 1024);
  }
}

TEST_F(AtlasLayout, HasTheDensityAskedFor) {
  const TriangleMesh mesh = shapes::icosphere(1);
  int last_side = 0;
  for (const double density : {15.0, 30.0}) {
    AtlasSettings settings = quick_settings(512);
    settings.texels_per_unit = density;
    const AtlasResult result = make_atlas(mesh, settings);
    const AtlasMeasures measures = written(result).measures;
    EXPECT_NEAR(measures.texels_per_unit, density, 2e-3 * density);
    EXPECT_GE(measures.smallest_gap_texels, settings.gutter);
    EXPECT_EQ(result.size.width, result.size.height);
    EXPECT_EQ(result.size.width % 4, 0);
    EXPECT_GT(measures.utilisation, 0.3) << result.size.text();
    EXPECT_GT(result.size.width, last_side);
    last_side = result.size.width;
  }
}

TEST_F(AtlasLayout, SaysWhichDensityFits) {
  AtlasSettings settings;
  settings.texels_per_unit = 1e5;
  try {
    make_atlas(shapes::icosphere(1), settings);
    FAIL();
  } catch (const WrongUsage& error) {
    // The sphere's area is 10 to 13: 16,384 texels a side hold 4,500 to 5,200 texels per unit, less what packing loses.
    const std::string message = error.what();
    const std::size_t place = message.find("--texels-per-unit ");
    ASSERT_NE(place, std::string::npos) << message;
    const double fits = std::stod(message.substr(place + 18));
    EXPECT_GT(fits, 2000);
    EXPECT_LT(fits, 5200);
  }
}

TEST_F(AtlasLayout, GivesTexelsToWhereTransferVaries) {
  // Far from each other: an open square, on which transfer is the same everywhere, and a pleated one.
  TriangleMesh pleated = shapes::plane(16);
  for (Eigen::Vector3f& p : pleated.positions) p.y() = 0.15f * std::sin(12 * p.x());
  const TriangleMesh mesh = with_vertex_normals(shapes::joined(shapes::plane(4), pleated, {10, 0, 0}));
  const Surface surface = analyse_surface(mesh);
  ChartSet cut = cut_into_charts(surface, {});
  const ChartDensities densities = densities_by_transfer(surface, cut.charts, nullptr);
  ASSERT_EQ(densities.scales.size(), cut.charts.size());

  double area = 0, scaled = 0, open = 0, least_pleated = 10;
  for (std::size_t c = 0; c < cut.charts.size(); ++c) {
    double chart_area = 0;
    for (const std::uint32_t face : cut.charts[c].faces) chart_area += surface.rest[face].area;
    area += chart_area;
    scaled += chart_area * densities.scales[c] * densities.scales[c];
    EXPECT_GE(densities.scales[c], 0.5);
    EXPECT_LE(densities.scales[c], 2);
    if (cut.charts[c].faces[0] < 32)
      open = densities.scales[c];
    else
      least_pleated = std::min(least_pleated, densities.scales[c]);
  }
  EXPECT_NEAR(scaled, area, 1e-6 * area);
  EXPECT_EQ(open, 0.5);  // nothing is lost there: the least that a chart may have
  EXPECT_GT(least_pleated, 1);

  // The atlas has these scales.
  AtlasSettings settings = quick_settings(256);
  settings.density = AtlasDensity::transfer;
  const AtlasResult result = make_atlas(mesh, settings);
  const AtlasMeasures measures = written(result).measures;
  const double highest = *std::max_element(densities.scales.begin(), densities.scales.end());
  EXPECT_NEAR(measures.density_max / measures.density_min, highest / 0.5, 0.02 * highest / 0.5);
  EXPECT_LT(measures.stretch.l2, 1.01);  // a chart's scale is no stretch
  EXPECT_GE(measures.smallest_gap_texels, settings.gutter);
}

TEST_F(AtlasLayout, KeepsColors) {
  TriangleMesh mesh = shapes::plane(2);
  for (const Eigen::Vector3f& p : mesh.positions) mesh.colors.push_back(p + Eigen::Vector3f::Constant(0.5f));
  const TriangleMesh atlas = make_atlas(mesh, quick_settings(64)).mesh;
  ASSERT_EQ(atlas.colors.size(), atlas.positions.size());
  for (std::size_t v = 0; v < atlas.positions.size(); ++v)
    EXPECT_EQ(atlas.colors[v], atlas.positions[v] + Eigen::Vector3f::Constant(0.5f));
}

TEST(Measure, HowMuchOfASeamIsSeen) {
  // From outside nothing hides the twelve seams of a sphere; from inside it hides all of the sky. Along each a cube's
  // edge is seen from the centre: an arc of acos(1/3).
  TriangleMesh sphere = shapes::cube_sphere(8);
  const AtlasMeasures outside = measure_atlas(sphere, 96, 64);
  const double relative = 12 * std::acos(1.0 / 3) / std::sqrt(4 * std::numbers::pi);
  EXPECT_NEAR(outside.seam_length_relative, relative, 0.01 * relative);  // of chords, and of a smaller area
  EXPECT_NEAR(outside.visible_seam_length_relative, outside.seam_length_relative,
              0.02 * outside.seam_length_relative);  // surface_openness is within 2 %
  for (Triangle& t : sphere.triangles) std::swap(t[1], t[2]);
  for (Eigen::Vector3f& normal : sphere.normals) normal = -normal;
  const AtlasMeasures inside = measure_atlas(sphere, 96, 64);
  EXPECT_NEAR(inside.seam_length_relative, relative, 0.01 * relative);
  EXPECT_NEAR(inside.visible_seam_length_relative, 0, 0.02);
}

TEST_F(AtlasLayout, OddTrianglesGetTexelsOrAreTold) {
  TriangleMesh slivers = shapes::plane(1);  // triangles a thousandth as wide as long
  for (int i = 0; i < 5; ++i) {
    const auto first = static_cast<std::uint32_t>(slivers.positions.size());
    const float x = 2 + 0.1f * static_cast<float>(i);
    for (const Eigen::Vector3f& p : {Eigen::Vector3f(x, 0, 0), {x + 1e-3f, 0, 0}, {x, 0, -1}})
      slivers.positions.push_back(p);
    slivers.triangles.push_back({first, first + 1, first + 2});
  }
  TriangleMesh flat = shapes::plane(2);
  flat.triangles.push_back({0, 0, 1});
  flat.triangles.push_back({0, 1, 2});  // on a line
  TriangleMesh crowd;
  for (int i = 0; i < 30; ++i) {
    TriangleMesh part = shapes::icosphere(0, 0.1f);
    crowd = shapes::joined(crowd, part, {0.3f * static_cast<float>(i % 8), 0, 0.3f * static_cast<float>(i / 8)});
  }
  TriangleMesh single;
  single.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
  single.triangles = {{0, 1, 2}};

  const auto check = [&](TriangleMesh mesh, int size) {
    mesh = with_vertex_normals(mesh);
    const AtlasSettings settings = quick_settings(size, 2);
    const WrittenAtlas atlas = written(make_atlas(mesh, settings));
    expect_told(atlas.measures, atlas.mesh, size);
    EXPECT_GE(atlas.measures.smallest_gap_texels, 2);
    return atlas.measures;
  };
  const AtlasMeasures of_slivers = check(slivers, 64);
  EXPECT_GT(of_slivers.uncovered_triangles, 0);  // some 0.02 texels wide
  for (const auto& entry : of_slivers.uncovered) EXPECT_FALSE(entry.without_area);
  const AtlasMeasures of_flat = check(flat, 64);
  for (const auto& entry : of_flat.uncovered) EXPECT_TRUE(entry.without_area);
  EXPECT_EQ(check(single, 64).uncovered_triangles, 0);
  EXPECT_EQ(check(shapes::wavy_sheet(8), 64).uncovered_triangles, 0);
  const AtlasMeasures of_crowd = check(crowd, 128);
  EXPECT_GE(of_crowd.charts, 30);
  EXPECT_EQ(of_crowd.uncovered_charts, 0);
}

/// Makes two squares side by side in the plane and in the texture: 0.1 to 0.4 and 0.6 to 0.9 of its width.
constexpr char two_squares[] =
    "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nv 2 0 0\nv 2 0 -1\n"
    "vt 0.1 0.1\nvt 0.4 0.1\nvt 0.4 0.4\nvt 0.1 0.4\nvt 0.6 0.1\nvt 0.9 0.1\nvt 0.9 0.4\nvt 0.6 0.4\n";

TEST_F(AtlasLayout, LoadsUvs) {
  const fs::path obj =
      file("mesh.obj", std::string(two_squares) +
                           "vn 0 1 0\n# a quad, and two triangles with counts from the end\nusemtl none\n"
                           "f 1/1/1 2/2/1 3/3/1 4/4/1\nf -5/-4/1 -2/-3/1 -1/-2/1\nf -5/-4/1 -1/-2/1 -4/-1/1\n");
  const TriangleMesh mesh = load_uv_mesh(obj);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.positions.size(), 8u);  // the common edge has two uvs
  EXPECT_EQ(mesh.uvs[mesh.triangles[2][0]], Eigen::Vector2f(0.6f, 0.1f));
  EXPECT_EQ(mesh.positions[mesh.triangles[2][0]], Eigen::Vector3f(1, 0, 0));
  for (const Eigen::Vector3f& normal : mesh.normals) EXPECT_LT((normal - Eigen::Vector3f::UnitY()).norm(), 1e-6f);

  for (const char* bad : {"f 1 2 3\n", "f 1/1 2/2\n", "f 1/1 2/2 9/3\n", "f 1/1 2/2 3/99\n", "f 1/1 2/2 0/3\n",
                          "f 1/1 2/x 3/3\n", "vt 0.1\n", "v 1 2 nan\n", ""})
    EXPECT_THROW(load_uv_mesh(file("bad.obj", std::string(two_squares) + bad)), BadInput) << bad;
  EXPECT_THROW(load_uv_mesh(file("bad.stl", "solid\n")), BadInput);
}

TEST_F(AtlasLayout, KeepsSoundUvs) {
  const TriangleMesh mesh =
      load_uv_mesh(file("mesh.obj", std::string(two_squares) + "f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\n"));
  const AtlasSettings settings = quick_settings({128, 64}, 6);
  const AtlasResult result = keep_uvs(mesh, settings);
  EXPECT_EQ(result.mesh.uvs, mesh.uvs);
  const WrittenAtlas atlas = written(result);
  EXPECT_EQ(atlas.measures.charts, 2);
  for (const Eigen::Vector2f& uv : atlas.mesh.uvs) {
    float nearest = 1;
    for (const Eigen::Vector2f& old : mesh.uvs) nearest = std::min(nearest, (uv - old).norm());
    EXPECT_LT(nearest, 2e-5f);  // a step of 16 bits
  }

  // Kiln's own atlases pass its test of uvs.
  const AtlasSettings own = quick_settings(128);
  EXPECT_FALSE(find_uv_defects(written(make_atlas(shapes::torus(12), own)).mesh, own).any());
}

TEST_F(AtlasLayout, NamesWhatIsWrongWithUvs) {
  AtlasSettings settings = quick_settings(128);
  const auto defects = [&](const std::string& faces) {
    return find_uv_defects(load_uv_mesh(file("mesh.obj", two_squares + faces)), settings);
  };
  // Both squares take the first one's place.
  const UvDefects overlap = defects("f 1/1 2/2 3/3 4/4\nf 2/1 5/2 6/3 3/4\n");
  EXPECT_NEAR(static_cast<double>(overlap.overlapping), std::pow(0.3 * 128, 2), 80);  // one row more or less
  EXPECT_EQ(overlap.mirrored_triangles, 0);

  const UvDefects mirrored = defects("f 1/1 2/2 3/3 4/4\nf 2/6 5/5 6/8 3/7\n");
  EXPECT_EQ(mirrored.mirrored_triangles, 2);
  EXPECT_EQ(mirrored.mirrored_charts, 1);
  EXPECT_EQ(mirrored.overlapping, 0);

  const UvDefects collapsed = defects("f 1/1 2/2 3/3 4/4\nf 2/5 5/5 6/5 3/5\n");
  EXPECT_EQ(collapsed.collapsed, 2);

  const UvDefects outside = defects("vt 1.2 0.1\nvt 1.2 0.4\nf 1/1 2/2 3/3 4/4\nf 2/5 5/9 6/10 3/8\n");
  EXPECT_EQ(outside.outside, 2);

  // 0.2 of the width between the squares, 0.1 to the border: 25 and 12 texels.
  settings.gutter = 12;
  EXPECT_FALSE(defects("f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\n").any());
  settings.gutter = 16;
  const UvDefects narrow = defects("f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\n");
  EXPECT_TRUE(narrow.gap_too_small);
  EXPECT_NEAR(narrow.gap_texels, 12.8, 1);

  const TriangleMesh bad =
      load_uv_mesh(file("bad.obj", std::string(two_squares) + "f 1/1 2/2 3/3 4/4\nf 2/2 5/1 6/4 3/3\n"));
  try {
    keep_uvs(bad, settings, "bad.obj");
    FAIL();
  } catch (const BadInput& error) {
    const std::string message = error.what();
    for (const char* words : {"bad.obj", "texels are covered by several", "2 triangles are mirrored, in 1 chart",
                              "gutter of 16", "--uv new"})
      EXPECT_NE(message.find(words), std::string::npos) << message;
  }
}

}  // namespace test_atlas_layout
}  // namespace kiln
