// SPDX-License-Identifier: GPL-3.0-or-later
// Simplification that keeps uvs and materials: textures must show where they did, and colours end where they did. The
// shapes are such that the place of every uv is known.

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/json.h"
#include "collapse/uv_layers.h"
#include "mesh/hard_edges.h"
#include "mesh/same_position.h"
#include "mesh/uv_raster.h"
#include "mesh/uv_seams.h"
#include "scratch.h"
#include "shapes.h"
#include "simplify/make_low.h"

namespace kiln {
namespace test_keep_uv {

/// Returns a mesh with uvs as the importer does: vertices joined, uvs at corners.
ImportedMesh imported(const TriangleMesh& mesh) {
  ImportedMesh result;
  result.file = "scan.obj";
  result.surface.uvs = uvs_at_corners(mesh.triangles, mesh.uvs);
  result.mesh = join_at_positions(mesh);
  result.mesh.uvs.clear();
  if (result.mesh.normals.empty()) compute_vertex_normals(result.mesh);
  return result;
}

SimplifySettings settings_of(const std::string& keep, int faces) {
  SimplifySettings settings;
  settings.keep = keep;
  settings.faces = faces;
  return settings;
}

KeepingResult simplified(const ImportedMesh& mesh, const SimplifySettings& settings, AttributedMesh* read = nullptr,
                         std::vector<std::string>* said = nullptr) {
  const Scratch folder;
  LowFile file(folder / "low.drc");
  std::vector<std::string> warnings;
  KeepingResult result = make_low(mesh, nullptr, settings, file, warnings);
  if (read != nullptr) *read = load_attributed_draco(folder / "low.drc");
  if (said != nullptr) *said = warnings;
  return result;
}

/// Makes a sphere whose charts meet exactly: positions are rounded.
TriangleMesh sphere_of_charts() {
  TriangleMesh sphere = shapes::cube_sphere(40);  // 19,200 triangles
  constexpr float steps = 1 << 20;
  for (Eigen::Vector3f& position : sphere.positions) position = (position * steps).array().round() / steps;
  return sphere;
}

/// Returns where a uv of cube_sphere lies on the sphere, margin 0.02.
Eigen::Vector3d place_on_sphere(const Eigen::Vector2d& uv) {
  const int column = std::clamp(static_cast<int>(3 * uv.x()), 0, 2),
            row = std::clamp(static_cast<int>(2 * uv.y()), 0, 1);
  const int side = 3 * row + column;
  Eigen::Vector3d out = Eigen::Vector3d::Zero(), along_u = Eigen::Vector3d::Zero();
  out[side / 2] = side % 2 == 0 ? 1 : -1;
  along_u[(side / 2 + 1) % 3] = 1;
  const double s = (3 * uv.x() - column - 0.06) / 0.88, t = (2 * uv.y() - row - 0.04) / 0.92;
  return (out + (2 * s - 1) * along_u + (2 * t - 1) * out.cross(along_u)).normalized();
}

/// Returns the largest and the root mean square distance, over texels, of where a uv shows from `truth`.
template <class Truth>
std::array<double, 2> slide(const TriangleMesh& low, const Truth& truth) {
  const UvRaster raster = rasterise_uvs(low, 300, 300);
  double largest = 0, sum = 0;
  for (int j = 0; j < raster.height; ++j)
    for (int i = 0; i < raster.width; ++i) {
      const TexelSource& source = raster.at(i, j);
      if (!source.covered()) continue;
      const Triangle& t = low.triangles[source.triangle];
      const Eigen::Vector3d shown = ((1 - source.u - source.v) * low.positions[t[0]] + source.u * low.positions[t[1]] +
                                     source.v * low.positions[t[2]])
                                        .cast<double>();
      const double squared = (shown - truth(Eigen::Vector2d((i + 0.5) / 300, (j + 0.5) / 300))).squaredNorm();
      largest = std::max(largest, squared);
      sum += squared;
    }
  EXPECT_GT(raster.covered_texels, 30'000);
  return {std::sqrt(largest), std::sqrt(sum / static_cast<double>(raster.covered_texels))};
}

/// Sheet of two materials whose border runs along z = border(x) of its triangles' middles.
template <class Border>
ImportedMesh two_materials(const TriangleMesh& sheet, const Border& border) {
  ImportedMesh mesh = imported(sheet);
  mesh.surface.materials.resize(3);
  mesh.surface.materials[0].name = "unused";
  mesh.surface.materials[1].name = "bark";
  mesh.surface.materials[2].name = "moss";
  for (const Triangle& t : sheet.triangles) {
    const Eigen::Vector3f middle = (sheet.positions[t[0]] + sheet.positions[t[1]] + sheet.positions[t[2]]) / 3;
    mesh.surface.material_of.push_back(middle.z() > border(middle.x()) ? 2 : 1);
  }
  return mesh;
}

/// Returns the material of each triangle of a file, all of whose corners must have it.
std::vector<std::uint16_t> materials_in(const AttributedMesh& file) {
  std::vector<std::uint16_t> found;
  EXPECT_EQ(file.attributes.size(), 1u);
  EXPECT_EQ(file.attributes[0].name, "material");
  for (const Triangle& t : file.mesh.triangles) {
    const auto& of_vertex = file.attributes[0].values;
    EXPECT_TRUE(of_vertex[t[0]] == of_vertex[t[1]] && of_vertex[t[0]] == of_vertex[t[2]]);
    found.push_back(of_vertex[t[0]]);
  }
  return found;
}

TEST(KeepUv, ShowsAFlatSheetsTextureWhereItWas) {
  const KeepingResult kept = simplified(imported(shapes::plane(30)), settings_of("uv", 20));
  EXPECT_LE(kept.simplified.mesh.triangles.size(), 20u);
  EXPECT_LT(kept.simplified.uv_deviation->largest, 1e-6);
  const auto truth = [](const Eigen::Vector2d& uv) {
    return Eigen::Vector3d((uv.x() - 0.1) / 0.8 - 0.5, 0, 0.5 - (uv.y() - 0.1) / 0.8);
  };
  EXPECT_LT(slide(kept.simplified.mesh, truth)[0], 1e-4);  // steps of the file: 1 / 65,535 of both
  EXPECT_LT(kept.simplified.distance.hausdorff, 1e-5);
}

TEST(KeepUv, SlidesTexturesOfASphereByWhatItSays) {
  const ImportedMesh sphere = imported(sphere_of_charts());
  ASSERT_TRUE(is_closed(sphere.mesh));
  SimplifySettings settings = settings_of("uv", 1000);
  const double diagonal = std::sqrt(12.0);
  const KeepingResult fitted = simplified(sphere, settings);
  EXPECT_EQ(fitted.simplified.mesh.triangles.size(), 1000u);
  EXPECT_TRUE(fitted.simplified.closed);
  EXPECT_EQ(fitted.simplified.flipped_triangles + fitted.simplified.degenerate_triangles, 0);
  const auto [largest, rms] = slide(fitted.simplified.mesh, place_on_sphere);
  // Samples lie 1/80 of a chart apart, and the input is 3e-4 off the sphere at most.
  EXPECT_NEAR(largest, fitted.simplified.uv_deviation->largest * diagonal, 0.25 * largest);
  EXPECT_NEAR(rms, fitted.simplified.uv_deviation->rms * diagonal, 0.1 * rms);

  // What is not fitted lies inside the sphere, with its vertices on it.
  settings.quality = SimplifyQuality::draft;
  const KeepingResult draft = simplified(sphere, settings);
  EXPECT_LT(rms, 0.8 * slide(draft.simplified.mesh, place_on_sphere)[1]);
  EXPECT_LT(fitted.simplified.distance.rms, 0.7 * draft.simplified.distance.rms);
  for (const Eigen::Vector3f& position : draft.simplified.mesh.positions) EXPECT_NEAR(position.norm(), 1, 1e-4);
  // Normals are fitted, too: those of a sphere point away from its middle, to a few degrees.
  for (std::size_t v = 0; v < fitted.simplified.mesh.positions.size(); ++v)
    EXPECT_GT(fitted.simplified.mesh.normals[v].dot(fitted.simplified.mesh.positions[v].normalized()), 0.996f);
}

TEST(KeepUv, EndsBeforeTexturesSlideTooFar) {
  SimplifySettings settings = settings_of("uv", 1000);
  settings.max_error = 0.002;
  const KeepingResult kept = simplified(imported(sphere_of_charts()), settings);
  EXPECT_LE(kept.simplified.uv_deviation->largest, 0.002);
  EXPECT_LE(kept.simplified.distance.hausdorff, 0.002);
  EXPECT_TRUE(kept.simplified.shortfall.empty());
  EXPECT_LT(kept.simplified.mesh.triangles.size(), 2000u);
  settings.max_error = 0.02;
  EXPECT_LT(simplified(imported(sphere_of_charts()), settings).simplified.mesh.triangles.size(),
            kept.simplified.mesh.triangles.size() / 3);
}

TEST(KeepUv, SaysWhereOutlinesOfChartsLeaveTooMany) {
  // 200 charts of two triangles each: their outlines are all there is.
  TriangleMesh charts = shapes::plane(20);
  TriangleMesh split;
  for (std::size_t t = 0; t < charts.triangles.size(); t += 2) {
    const auto first = static_cast<std::uint32_t>(split.positions.size());
    const float left = static_cast<float>(t / 2 % 20) / 20, low = static_cast<float>(t / 2 / 20) / 20;
    const std::array<std::uint32_t, 4> corners = {charts.triangles[t][0], charts.triangles[t][1],
                                                  charts.triangles[t][2], charts.triangles[t + 1][2]};
    const std::array<Eigen::Vector2f, 4> places = {{{0, 0}, {.04f, 0}, {.04f, .04f}, {0, .04f}}};
    for (std::size_t k = 0; k < 4; ++k) {
      split.positions.push_back(charts.positions[corners[k]]);
      split.normals.push_back(charts.normals[corners[k]]);
      split.uvs.push_back(Eigen::Vector2f(left, low) + places[k]);
    }
    split.triangles.push_back({first, first + 1, first + 2});
    split.triangles.push_back({first, first + 2, first + 3});
  }
  const KeepingResult kept = simplified(imported(split), settings_of("uv", 100));
  EXPECT_GE(kept.simplified.mesh.triangles.size(), 796u);  // corners of the sheet may go
  EXPECT_NE(kept.simplified.shortfall.find("triangles of 100"), std::string::npos);
  EXPECT_NE(kept.simplified.shortfall.find("--uv-overhang"), std::string::npos);
}

TEST(KeepUv, StackedChartsDoNotHinderEachOther) {
  // An arc, whose inner outline gains where it loses vertices; and strips on top of it in the texture, elsewhere in
  // space, whose outlines run through what it gains.
  TriangleMesh arc;
  const auto at = [](double radius, double angle) {
    return Eigen::Vector2f(static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)));
  };
  const auto add = [](TriangleMesh& mesh, const Eigen::Vector2f& uv, float away) {
    mesh.positions.emplace_back(uv.x() + away, 0, -uv.y());
    mesh.uvs.push_back(uv);
    mesh.normals.push_back(Eigen::Vector3f::UnitY());
  };
  constexpr int cells = 64;
  for (int i = 0; i <= cells; ++i)
    for (const double radius : {0.5, 0.6}) add(arc, at(radius, 1.5 * i / cells), 0);
  for (std::uint32_t i = 0; i < cells; ++i) {
    arc.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    arc.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  TriangleMesh both = arc;
  for (int strip = 0; strip < 12; ++strip) {
    const auto first = static_cast<std::uint32_t>(both.positions.size());
    const double angle = 1.5 * (strip + 0.5) / 12;
    for (const double turn : {-0.01, 0.01})
      for (const double radius : {0.4, 0.7}) add(both, at(radius, angle + turn), 10);
    both.triangles.push_back({first, first + 1, first + 3});
    both.triangles.push_back({first, first + 3, first + 2});
  }
  const std::vector<std::uint32_t> layers = find_uv_layers(both);
  EXPECT_EQ(layers.front(), 0u);
  EXPECT_EQ(layers.back(), 1u);
  const auto triangles_of_arc = [](const TriangleMesh& mesh) {
    const TriangleMesh low = simplified(imported(mesh), settings_of("uv", 4)).simplified.mesh;
    return std::ranges::count_if(low.triangles, [&](const Triangle& t) { return low.positions[t[0]].x() < 5; });
  };
  EXPECT_LT(triangles_of_arc(arc), 40);
  EXPECT_LE(triangles_of_arc(both), triangles_of_arc(arc));
}

TEST(KeepUv, ChartsBesideEachOtherAreOfOneLayer) {
  const std::vector<std::uint32_t> layers = find_uv_layers(shapes::cube_sphere(8));
  EXPECT_EQ(*std::max_element(layers.begin(), layers.end()), 0u);
  // Charts of different pictures may lie on the same uvs.
  const TriangleMesh sphere = shapes::cube_sphere(8);
  std::vector<std::uint32_t> pictures(sphere.positions.size(), 0);
  std::fill(pictures.begin() + static_cast<std::ptrdiff_t>(pictures.size()) / 2, pictures.end(), 1u);
  const std::vector<std::uint32_t> apart = find_uv_layers(sphere, pictures);
  EXPECT_EQ(apart.front(), 0u);
  EXPECT_EQ(apart.back(), 1u);
}

TEST(KeepMaterials, BordersStayWhereTheyAre) {
  // A straight border along z = 0 of a sheet with a hill, kept with uvs and without.
  TriangleMesh sheet = shapes::wavy_sheet(40, 1);
  sheet.uvs = shapes::plane(40).uvs;
  const ImportedMesh mesh = two_materials(sheet, [](float) { return 0.f; });
  std::array<double, 2> wanted{};
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
    wanted[static_cast<std::size_t>(mesh.surface.material_of[t] - 1)] +=
        0.5 * area_normal(sheet, sheet.triangles[t]).y();
  for (const char* keep : {"uv,materials", "materials"}) {
    AttributedMesh file;
    std::vector<std::string> warnings;
    const KeepingResult kept = simplified(mesh, settings_of(keep, 300), &file, &warnings);
    EXPECT_EQ(kept.materials, (std::vector<std::string>{"bark", "moss"})) << keep;
    EXPECT_TRUE(warnings.empty());
    EXPECT_LE(file.mesh.triangles.size(), 300u) << keep;
    const std::vector<std::uint16_t> materials = materials_in(file);
    std::array<double, 2> areas{};
    for (std::size_t t = 0; t < materials.size(); ++t) {
      const Triangle& triangle = file.mesh.triangles[t];
      // Seen from above, no triangle lies on both sides of the border.
      double lowest = 1, highest = -1;
      for (const std::uint32_t v : triangle) {
        lowest = std::min<double>(lowest, file.mesh.positions[v].z());
        highest = std::max<double>(highest, file.mesh.positions[v].z());
      }
      EXPECT_LT(std::min(-lowest, highest), 0.004) << keep;  // a tenth of an edge of the input
      areas[materials[t]] += 0.5 * std::abs(area_normal(file.mesh, triangle).y());
    }
    EXPECT_NEAR(areas[0], wanted[0], 0.005) << keep;
    EXPECT_NEAR(areas[1], wanted[1], 0.005) << keep;
    // A border of materials is no edge of the shape.
    const std::vector<std::uint32_t> first = first_at_position(file.mesh.positions);
    for (std::size_t v = 0; v < first.size(); ++v)
      EXPECT_GT(file.mesh.normals[v].dot(file.mesh.normals[first[v]]), 0.999f) << keep;
  }
}

TEST(KeepMaterials, WithoutThemBordersAreSaidToGo) {
  ImportedMesh mesh = two_materials(shapes::plane(10), [](float x) { return x; });
  for (const int k : {1, 2}) {
    mesh.surface.materials[k].texture.emplace();
    mesh.surface.materials[k].texture->picture.name = "picture " + std::to_string(k);
  }
  std::vector<std::string> warnings;
  simplified(mesh, settings_of("uv", 100), nullptr, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("has 2 textures"), std::string::npos);
  simplified(mesh, settings_of("uv,materials", 100), nullptr, &warnings);
  EXPECT_TRUE(warnings.empty());
}

TEST(KeepUv, IsRefusedWithoutWholeUvs) {
  ImportedMesh bare = imported(shapes::plane(4));
  bare.surface.without_uvs = {{true, 7, 3}};
  EXPECT_THROW(simplified(bare, settings_of("uv", 10)), BadInput);
  bare.surface.uvs.clear();
  EXPECT_THROW(simplified(bare, settings_of("uv", 10)), BadInput);
  ImportedMesh broken = imported(shapes::plane(4));
  broken.surface.materials_fault = BadInput("scan.mtl", "does not exist", "a material library", "copy it, too");
  EXPECT_THROW(simplified(broken, settings_of("uv,materials", 10)), BadInput);
  EXPECT_NO_THROW(simplified(broken, settings_of("uv", 10)));
}

TEST(KeepUv, SettingsAreNamesOfWhatIsKept) {
  const auto keeps = [](const std::string& text) {
    const SimplifySettings settings = settings_of(text, 1);
    return std::pair(settings.keeps_uvs(), settings.keeps_materials());
  };
  EXPECT_EQ(keeps("none"), std::pair(false, false));
  EXPECT_EQ(keeps("uv"), std::pair(true, false));
  EXPECT_EQ(keeps("materials"), std::pair(false, true));
  EXPECT_EQ(keeps("uv, materials"), std::pair(true, true));
  for (const char* wrong : {"", "uvs", "uv,uv", "none,uv", "uv materials"}) EXPECT_THROW(keeps(wrong), WrongUsage);
}

}  // namespace test_keep_uv
}  // namespace kiln
