// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/parallel.h"
#include "import/import_mesh.h"
#include "import/uv_mesh.h"
#include "mesh/draco_file.h"
#include "normals/high_parts.h"
#include "normals/low_triangles.h"
#include "normals/match_plan.h"
#include "normals/normals.h"
#include "normals/part_pairs.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_match_names {

namespace fs = std::filesystem;

struct Named {
  std::string name;
  TriangleMesh mesh;
  Eigen::Vector3f move = Eigen::Vector3f::Zero();
};

/// Returns the mesh with a chart of its own for each triangle, in cells of the unit square.
TriangleMesh in_cells(const TriangleMesh& mesh) {
  TriangleMesh result;
  const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(mesh.triangles.size()))));
  const float cell = 1 / static_cast<float>(side);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector2f corner(static_cast<float>(t % side) * cell, static_cast<float>(t / side) * cell);
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (std::uint32_t k = 0; k < 3; ++k) {
      result.positions.push_back(mesh.positions[mesh.triangles[t][k]]);
      result.normals.push_back(mesh.normals[mesh.triangles[t][k]]);
      result.uvs.push_back(corner + cell * Eigen::Vector2f(k == 1 ? 0.9f : 0.1f, k == 2 ? 0.9f : 0.1f));
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

class MatchNames : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_ / name; }

  fs::path write(const std::string& file, const std::vector<Named>& parts) const {
    std::ofstream out(path(file));
    out.precision(9);
    std::size_t first = 1;
    for (const auto& [name, mesh, move] : parts) {
      if (!name.empty()) out << "o " << name << "\n";
      for (const Eigen::Vector3f& p : mesh.positions)
        out << "v " << p.x() + move.x() << " " << p.y() + move.y() << " " << p.z() + move.z() << "\n";
      for (const Triangle& t : mesh.triangles)
        out << "f " << first + t[0] << " " << first + t[1] << " " << first + t[2] << "\n";
      first += mesh.positions.size();
    }
    return path(file);
  }

  /// Makes an atlas of a low mesh's file: by way of low.drc, as kiln-simplify and kiln-atlas do.
  TriangleMesh atlas_of(const fs::path& low) const {
    save_draco(path("low.drc"), split_at_seams(import_mesh(low)));
    save_draco(path("atlas.drc"), in_cells(load_draco(path("low.drc"))));
    return load_atlas(path("atlas.drc"));
  }

  NormalsResult run(const fs::path& low, const fs::path& high, const NormalsSettings& settings) const {
    const TriangleMesh atlas = atlas_of(low);
    const ImportedMesh imported = import_mesh(high, {}, atlas.frame);
    return make_normals(imported.mesh, atlas, settings, {}, no_progress, {},
                        load_match_plan(settings, low, {}, atlas, imported));
  }

  std::string refusal(const fs::path& low, const fs::path& high, const NormalsSettings& settings) const {
    try {
      run(low, high, settings);
    } catch (const std::exception& fault) {
      return fault.what();
    }
    return "";
  }

 private:
  Scratch folder_;
};

NormalsSettings by_names(int size = 96) { return {.size = Extent(size), .match = MatchChoice::names}; }

void for_each_covered(const NormalsResult& result,
                      const std::function<void(int, int, const Eigen::Vector3f&, const Eigen::Vector3f&)>& visit) {
  int count = 0;
  for (int j = 0; j < result.coverage.height(); ++j)
    for (int i = 0; i < result.coverage.width(); ++i) {
      if (result.coverage.at(i, j) == 0) continue;
      ++count;
      const auto pixel = result.normal.pixel(i, j);
      visit(i, j, Eigen::Map<const Eigen::Vector3f>(result.position.pixel(i, j).data()),
            Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) * (2 / 65535.0f) - Eigen::Vector3f::Ones());
    }
  EXPECT_GT(count, 500);
}

/// Counts the texels whose point is not on the sphere that their triangle of the atlas has its corners on: of radius 1
/// or `outer`.
int strangers(const NormalsResult& result, const TriangleMesh& atlas, float outer) {
  const UvRaster raster = rasterise_uvs(atlas, result.coverage.width(), result.coverage.height());
  int count = 0;
  for_each_covered(result, [&](int i, int j, const Eigen::Vector3f& point, const Eigen::Vector3f&) {
    const float corner = atlas.positions[atlas.triangles[raster.at(i, j).triangle][0]].norm();
    const float own = corner > (1 + outer) / 2 ? outer : 1;
    // The high spheres' faces are 2e-4 beneath their corners at most, and Draco's steps 3.2e-5.
    count += std::abs(point.norm() - own) > 1e-3f;
  });
  return count;
}

TEST_F(MatchNames, TexelsOfASphereInASphereKeepToTheirOwn) {
  // Faces of the low spheres lie up to 0.1 within them, so those of the outer one are nearer to the inner one.
  constexpr float outer = 1.06f;
  const fs::path low =
      write("low.obj", {{"inner_low", shapes::icosphere(1)}, {"outer_low", shapes::icosphere(1, outer)}});
  const fs::path high =
      write("high.obj", {{"outer_high.001", shapes::icosphere(5, outer)}, {"INNER_High", shapes::icosphere(5)}});
  const TriangleMesh atlas = atlas_of(low);
  NormalsSettings settings = by_names();
  settings.seams = SeamChoice::keep;
  for (const int samples : {1, 4}) {
    settings.samples = samples;
    const NormalsResult named = run(low, high, settings);
    EXPECT_EQ(named.matched_parts, (std::vector<std::string>{"inner", "outer"}));
    EXPECT_EQ(strangers(named, atlas, outer), 0);
    EXPECT_EQ(named.buried_texels, 0u);  // in its own part, none is
    EXPECT_EQ(named.cage_source, "measured");
    // The distance of a face's middle, doubled: 1 - cos of half the angle that it spans.
    EXPECT_NEAR(named.cage_distance, 0.2, 0.1);
    if (samples > 1) continue;  // the map is fitted then
    for_each_covered(named, [](int, int, const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
      EXPECT_GT(point.normalized().dot(normal.normalized()), std::cos(0.03f));
    });
  }
  settings.match = MatchChoice::nearest;
  const NormalsResult nearest = run(low, high, settings);
  EXPECT_TRUE(nearest.matched_parts.empty());
  EXPECT_GT(strangers(nearest, atlas, outer), 200);
}

TEST_F(MatchNames, PartsThatTouchKeepTheirTriangles) {
  // Two cubes that share the corners of a side, which repair welds; each has its own two triangles of that side.
  const TriangleMesh cube = shapes::cube(1);
  const TriangleMesh fine = shapes::cube(16);
  const Eigen::Vector3f beside = Eigen::Vector3f::UnitX();
  ImportSettings keep;
  keep.keeps_backs = true;
  const fs::path low = write("low.obj", {{"left_low", cube}, {"right_low", cube, beside}});
  const fs::path high = write("high.obj", {{"left_high", fine}, {"right_high", fine, beside}});
  const ImportedMesh imported_low = import_mesh(low, keep), imported_high = import_mesh(high, keep);
  ASSERT_EQ(imported_low.mesh.triangles.size(), 24u);
  const PartPairs pairs = pair_parts(imported_low, imported_high);
  const TriangleMesh atlas = in_cells(imported_low.mesh);
  save_draco(path("atlas.drc"), atlas);
  const TriangleMesh saved = load_atlas(path("atlas.drc"));
  const std::vector<LowTriangle> sources = find_low_triangles(saved, imported_low.mesh, low);
  int of_right = 0;
  for (std::size_t t = 0; t < saved.triangles.size(); ++t) {
    const Triangle& triangle = saved.triangles[t];
    const float middle =
        (saved.positions[triangle[0]].x() + saved.positions[triangle[1]].x() + saved.positions[triangle[2]].x()) / 3;
    const float side = beside.x() / 2, out = area_normal(saved, triangle).normalized().x();
    // Two faces lie between the cubes; that of the right cube faces left.
    const bool is_right = middle > side + 1e-3f || (middle > side - 1e-3f && out < -0.9f);
    EXPECT_EQ(pairs.low_part[sources[t].triangle], is_right ? 1u : 0u);
    of_right += is_right;
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& source = imported_low.mesh.triangles[sources[t].triangle];
      EXPECT_LT((saved.positions[triangle[k]] - imported_low.mesh.positions[source[sources[t].corners[k]]]).norm(),
                1e-4f);
    }
  }
  EXPECT_EQ(of_right, 12);
}

TEST_F(MatchNames, NamesEndAtTheSuffix) {
  const auto low = [](std::string_view name) { return std::string(common_name(name, "_low")); };
  EXPECT_EQ(low("bolt_low"), "bolt");
  EXPECT_EQ(low("bolt_LOW"), "bolt");
  EXPECT_EQ(low("bolt_low_2"), "bolt");
  EXPECT_EQ(low("bolt_low.001"), "bolt");
  EXPECT_EQ(low("bolt_low2"), "bolt");
  EXPECT_EQ(low("bolt"), "bolt");
  EXPECT_EQ(low("bolt_lower"), "bolt_lower");
  EXPECT_EQ(low("bolt_lower_low"), "bolt_lower");
  EXPECT_EQ(low("bolt_high"), "bolt_high");
  EXPECT_EQ(std::string(common_name("Leg_high_high_top", "_high")), "Leg");
}

TEST_F(MatchNames, WhatHasNoPartnerIsNamed) {
  const TriangleMesh ball = shapes::icosphere(1);
  const Eigen::Vector3f right(3, 0, 0);
  const fs::path both = write("low.obj", {{"a_low", ball}, {"b_low", ball, right}});
  const auto says = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  std::string text = refusal(both, write("high.obj", {{"a_high", ball}, {"b_hgih", ball, right}}), by_names());
  for (const char* part : {"low.obj: has parts without a partner: 'b_low'", "high.obj", "'a_high', 'b_hgih'"})
    says(text, part);
  text = refusal(both, write("high.obj", {{"a_high", ball}, {"b_high", ball, right}, {"c_high", ball, -right}}),
                 by_names());
  for (const char* part : {"high.obj: has parts without a partner: 'c_high'", "'a_low', 'b_low'", "--match nearest"})
    says(text, part);
  says(refusal(both, write("high.obj", {{"", ball}}), by_names()), "high.obj: names no parts");
  says(refusal(write("plain.obj", {{"", ball}}), both, by_names()), "plain.obj: names no parts");
  text = refusal(both, write("high.obj", {{"", ball, -right}, {"a_high", ball}, {"b_high", ball, right}}), by_names());
  says(text, "without a partner: faces without a name");
  EXPECT_EQ(refusal(both, write("high.obj", {{"b", ball, right}, {"a_high", ball}, {"a_high_top", ball, -right}}),
                    by_names()),
            "");
  // The atlas is of another mesh.
  const TriangleMesh atlas = atlas_of(write("other.obj", {{"a_low", ball, {0, 0.1f, 0}}}));
  EXPECT_THROW(load_match_plan(by_names(), both, {}, atlas, import_mesh(both)), BadInput);
  // No file of a low mesh is known.
  EXPECT_THROW(load_match_plan(by_names(), "", {}, atlas, import_mesh(both)), WrongUsage);
}

TEST_F(MatchNames, PartsHaveCagesOfTheirOwn) {
  const TriangleMesh low_ball = shapes::icosphere(1), ball = shapes::icosphere(4);
  const Eigen::Vector3f right(3, 0, 0);
  const fs::path low = write("low.obj", {{"a_low", low_ball}, {"b_low", low_ball, right}});
  const fs::path high = write("high.obj", {{"a_high", ball}, {"b_high", ball, right}});
  NormalsSettings settings = by_names();
  settings.cage = 0.001;  // of 5.7: less than the faces are off by
  const double few = run(low, high, settings).found_by_ray_outwards;
  settings.part_cage = "B_low=0.05";
  const NormalsResult half = run(low, high, settings);
  EXPECT_LT(few, 0.3);
  EXPECT_NEAR(half.found_by_ray_outwards, 0.5 + few / 2, 0.05);
  EXPECT_NEAR(half.cage_distance, 0.05 * std::sqrt(25.0 + 4 + 4), 0.01);
  settings.part_cage = "c=0.05";
  EXPECT_NE(refusal(low, high, settings).find("found the part 'c'; expected one of a, b"), std::string::npos);
  for (const char* text : {"a", "a=", "=1", "a=2", "a=0", "a=0.1,", "a=0.1,b"})
    if (std::string(text) != "a=0.1,")
      EXPECT_THROW(parse_part_cages(text), WrongUsage) << text;
    else
      EXPECT_EQ(parse_part_cages(text).size(), 1u);
}

TEST_F(MatchNames, AThousandPartsAreSeenEachAlone) {
  // Squares one above the other: each part sees its own. Embree has no more than some hundreds of devices.
  constexpr std::uint32_t count = 1100;
  const TriangleMesh square = shapes::plane(1);
  TriangleMesh high;
  MatchPlan plan;
  plan.parts.resize(count);
  for (std::uint32_t part = 0; part < count; ++part) {
    const auto first = static_cast<std::uint32_t>(high.positions.size());
    for (const Eigen::Vector3f& p : square.positions)
      high.positions.emplace_back(p + Eigen::Vector3f(0, static_cast<float>(part), 0));
    for (const Triangle& t : square.triangles) {
      high.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      plan.high_part.push_back(part);
    }
  }
  const HighParts parts(high, plan);
  for (const std::uint32_t part : {0u, 1u, count - 1}) {
    const SurfacePoint hit = parts.scene(part).first_hit({0.1f, 2000, 0.2f}, {0, -1, 0}, 0, 3000);
    ASSERT_TRUE(hit.found());
    EXPECT_EQ(hit.triangle / 2, part);
    EXPECT_NEAR(hit.distance, 2000 - static_cast<float>(part), 1e-2f);
  }
}

TEST_F(MatchNames, OccludersAreAllPartsOrTheOwnOne) {
  // A cube a tenth of its side above a square: the middle of the square sees little of the sky, and all of it alone.
  const TriangleMesh square = shapes::plane(2), cube = shapes::cube(1);
  const Eigen::Vector3f above(0, 0.6f, 0);
  const fs::path low = write("low.obj", {{"square_low", square}, {"cube_low", cube, above}});
  const fs::path high = write("high.obj", {{"square_high", square}, {"cube_high", cube, above}});
  NormalsSettings settings = by_names(64);
  settings.maps.kinds = {MapKind::ambient_occlusion};
  settings.maps.directions = 256;
  const auto open_at_middle = [&](MapOccluders occluders) {
    settings.maps.occluders = occluders;
    const NormalsResult result = run(low, high, settings);
    std::vector<float> open;
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i) {
        const Eigen::Vector3f point = Eigen::Map<const Eigen::Vector3f>(result.position.pixel(i, j).data());
        if (result.coverage.at(i, j) != 0 && std::abs(point.y()) < 1e-3f && point.norm() < 0.15f)
          open.push_back(result.maps.at(0).values.at(i, j));
      }
    EXPECT_FALSE(open.empty());
    return open;
  };
  for (const float open : open_at_middle(MapOccluders::all)) EXPECT_LT(open, 0.15f);
  for (const float open : open_at_middle(MapOccluders::part)) EXPECT_GT(open, 0.97f);
}

/// A square of side 1 at height `height`, in front of which an artist's cage stands.
class Cage : public MatchNames {
 protected:
  Cage() : low_(write("low.obj", {{"", sheet_}})) {}

  /// Sets the cage: the low sheet moved by `offset`, by `more` times that at its right end.
  void put_cage(const Eigen::Vector3f& offset, float more = 1) {
    TriangleMesh cage = sheet_;
    for (Eigen::Vector3f& p : cage.positions) p += offset * (1 + (more - 1) * (p.x() + 0.5f));
    settings_.cage_mesh = write("cage.obj", {{"", cage}}).string();
  }

  static TriangleMesh sheet(float height, bool faces_down = false, float side = 3) {
    TriangleMesh mesh = shapes::plane(6, side, height);
    if (faces_down)
      for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
  }

  TriangleMesh sheet_ = sheet(0, false, 1);
  fs::path low_;
  NormalsSettings settings_{.size = Extent(64)};
};

TEST_F(Cage, RaysGoFromItToTheLowMeshAndAsFarBehind) {
  // A slanting cage: where a ray meets a sheet at height h, it is h / 0.4 of the offset beside the texel.
  const Eigen::Vector3f offset(0.2f, 0.4f, -0.1f);
  const auto expect_height = [&](const fs::path& high, float height, const char* what) {
    const NormalsResult result = run(low_, high, settings_);
    EXPECT_EQ(result.cage_source, "cage mesh") << what;
    EXPECT_NEAR(result.cage_distance, offset.norm(), 1e-4) << what;
    EXPECT_EQ(height >= 0 ? result.found_by_ray_outwards : result.found_by_ray_inwards, 1) << what;
    const TriangleMesh atlas = atlas_of(low_);
    const UvRaster raster = rasterise_uvs(atlas, 64, 64);
    for_each_covered(result, [&](int i, int j, const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
      const Eigen::Vector3f from = interpolate(atlas, atlas.positions, raster.at(i, j));
      EXPECT_LT((point - (from + height / 0.4f * offset)).norm(), 1e-4f) << what;
      EXPECT_GT(normal.y(), 0.999f) << what;
    });
  };
  put_cage(offset);
  expect_height(write("high.obj", {{"", sheet(0.05f)}}), 0.05f, "in front");
  expect_height(write("high.obj", {{"", sheet(-0.35f)}}), -0.35f, "behind");
  expect_height(write("high.obj", {{"", sheet(0.3f)}, {"", sheet(0.05f)}}), 0.3f, "the first of two");
  expect_height(write("high.obj", {{"", sheet(0.5f)}, {"", sheet(0.05f)}}), 0.05f, "one beyond the cage");
  expect_height(write("high.obj", {{"", sheet(0.3f, true)}, {"", sheet(0.05f)}}), 0.05f, "a back before a front");
}

TEST_F(Cage, ItsHeightDecidesFromPlaceToPlace) {
  // The cage rises from 0.1 at the left end to 0.4 at the right one; from 0.25 on it is above the upper sheet.
  put_cage({0, 0.1f, 0}, 4);
  for (const int samples : {1, 16}) {
    settings_.samples = samples;
    const NormalsResult result = run(low_, write("high.obj", {{"", sheet(0.25f)}, {"", sheet(0.05f)}}), settings_);
    int upper = 0;
    for_each_covered(result, [&](int, int, const Eigen::Vector3f& point, const Eigen::Vector3f&) {
      if (std::abs(point.x()) < 1e-3f) return;
      EXPECT_NEAR(point.y(), point.x() > 0 ? 0.25f : 0.05f, 1e-4f);
      upper += point.x() > 0;
    });
    EXPECT_GT(upper, 200);
  }
}

TEST_F(Cage, MustBeTheLowMeshPushedOutwards) {
  const fs::path high = write("high.obj", {{"", sheet(0.05f)}});
  put_cage({0, -0.1f, 0});
  EXPECT_NE(refusal(low_, high, settings_).find("lies inside the low mesh at 100 %"), std::string::npos);
  put_cage({0, 0, 0});
  EXPECT_NE(refusal(low_, high, settings_).find("does not differ from the low mesh"), std::string::npos);
  settings_.cage_mesh = write("cage.obj", {{"", shapes::icosphere(1)}}).string();
  const std::string text = refusal(low_, high, settings_);
  EXPECT_NE(text.find("cage.obj: has 80 faces; expected the 72 of "), std::string::npos) << text;
  put_cage({0, 0.1f, 0});
  EXPECT_EQ(refusal(low_, high, settings_), "");
  settings_.cage = 0.1;
  EXPECT_NE(refusal(low_, high, settings_).find("cage: found beside --cage-mesh"), std::string::npos);
}

TEST_F(Cage, OneThreadAndManyGiveTheSameBytes) {
  put_cage({0, 0.1f, 0}, 4);
  settings_.samples = 4;
  const fs::path high = write("high.obj", {{"", sheet(0.25f)}, {"", sheet(0.05f)}});
  const NormalsResult many = run(low_, high, settings_);
  const ThreadLimit limit(1);
  const NormalsResult one = run(low_, high, settings_);
  EXPECT_EQ(one.normal.values(), many.normal.values());
  EXPECT_EQ(one.position.values(), many.position.values());
}

}  // namespace test_match_names
}  // namespace kiln
