// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "base/errors.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/parallel.h"
#include "image/image_file.h"
#include "import/import_mesh.h"
#include "maps/asset_hints.h"
#include "maps/detail_maps.h"
#include "maps/texel_way.h"
#include "normals/normals.h"
#include "raycast/ray_scene.h"
#include "scratch.h"
#include "shapes.h"
#include "simplify/simplify.h"

namespace kiln {
namespace test_normals {

constexpr double degree = 3.14159265358979323846 / 180;

Eigen::Vector3f vector_at(const Image<float>& image, int i, int j) {
  return Eigen::Map<const Eigen::Vector3f>(image.pixel(i, j).data());
}

Eigen::Vector3f decoded_at(const Image<std::uint16_t>& image, int i, int j) {
  return Eigen::Vector3f(image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)) * (2 / 65535.0f) -
         Eigen::Vector3f::Ones();
}

void for_each_covered(const NormalsResult& result, const std::function<void(int, int)>& body) {
  int count = 0;
  for (int j = 0; j < result.coverage.height(); ++j)
    for (int i = 0; i < result.coverage.width(); ++i) {
      const int value = result.coverage.at(i, j);
      ASSERT_TRUE(value == 0 || value == 255);
      if (value == 0) continue;
      ++count;
      body(i, j);
    }
  EXPECT_EQ(count, result.covered_texels);
  EXPECT_GT(count, 0);
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  a.uvs.clear();
  return a;
}

TriangleMesh turned_over(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Eigen::Vector3f& n : mesh.normals) n = -n;
  return mesh;
}

TEST(Normals, SphereOverACoarseSphere) {
  // Triangles of an icosphere of 6 levels have edges of up to 0.0205 and lie below the sphere by at most the depth of a
  // cap of that circumradius: 0.0205^2 / 3 / 2 = 7e-5. Interpolated normals turn from the radius by less than that.
  const TriangleMesh high = shapes::icosphere(6), low = shapes::cube_sphere(4);
  const NormalsResult result = make_normals(high, low, {.size = 192, .seams = SeamChoice::keep});
  const UvRaster raster = rasterise_uvs(low, 192, 192);
  for_each_covered(result, [&](int i, int j) {
    const Eigen::Vector3f position = vector_at(result.position, i, j);
    EXPECT_NEAR(position.norm(), 1, 7.1e-5);
    EXPECT_LT((decoded_at(result.normal, i, j) - position.normalized()).norm(), 2e-4f);
    // The low mesh's normals are radii at its vertices and nearly so between; its points are at most 1 - cos(0.28) =
    // 0.04 below.
    EXPECT_LT((position.normalized() - interpolate(low, low.positions, raster.at(i, j)).normalized()).norm(), 0.01f);
  });
  EXPECT_EQ(result.found_by_nearest_point, 0);
  EXPECT_GT(result.found_by_ray_outwards, 0.95);  // a sphere's chords lie inside it, but for their ends
  EXPECT_NEAR(result.found_by_ray_outwards + result.found_by_ray_inwards, 1, 1e-12);
  EXPECT_EQ(result.disagreeing, 0);
  EXPECT_EQ(result.cage_source, "measured");
  // A 16-bit step is 3e-5 wide; half of one in each of three axes, 0.0015 degrees.
  EXPECT_LT(result.quantisation_degrees_largest, 0.0016);
}

TEST(Normals, TheWayIsTheSideOnWhichTheHighMeshLies) {
  const TriangleMesh low = shapes::cube_sphere(16);
  for (const float radius : {0.95f, 1.05f}) {
    const TriangleMesh high = shapes::icosphere(5, radius);
    const NormalsResult result = make_normals(high, low, {.size = 96, .cage = 0.1});
    EXPECT_EQ(radius > 1 ? result.found_by_ray_outwards : result.found_by_ray_inwards, 1);
    EXPECT_EQ(result.cage_source, "option");
    const double diagonal = bounding_box(high).diagonal();
    EXPECT_NEAR(result.cage_distance, 0.1 * diagonal, 1e-6);
    // 5 % of the radius, less the chord's depth of up to 0.0024 (radius 1, 16 cells over 90 degrees).
    EXPECT_NEAR(result.mean_distance * diagonal, 0.05, 0.0025);
    EXPECT_GE(result.largest_distance, result.mean_distance);
    EXPECT_LT(result.normal_deviation_degrees_mean, 0.1);
  }
}

TEST(Normals, NearestPointWhereTheCageIsTooSmall) {
  const TriangleMesh high = shapes::plane(8, 1, 0.05f), low = shapes::plane(1, 1);
  const NormalsResult near = make_normals(high, low, {.size = 32, .cage = 0.01});
  EXPECT_EQ(near.found_by_nearest_point, 1);
  const NormalsResult far = make_normals(high, low, {.size = 32, .cage = 0.1});
  EXPECT_EQ(far.found_by_ray_outwards, 1);
  for (const NormalsResult* result : {&near, &far})
    for_each_covered(*result, [&](int i, int j) {
      // The margin of 0.1 and the side of 1 give x and z of a texel; float32 rounding.
      const float x = (((static_cast<float>(i) + 0.5f) / 32 - 0.1f) / 0.8f - 0.5f);
      const float z = (0.5f - ((static_cast<float>(j) + 0.5f) / 32 - 0.1f) / 0.8f);
      // uvs are rounded to 1/256 texel or finer by the rasteriser: 1/256/32/0.8.
      EXPECT_LT((vector_at(result->position, i, j) - Eigen::Vector3f(x, 0.05f, z)).norm(), 2e-4f);
      EXPECT_LT((decoded_at(result->normal, i, j) - Eigen::Vector3f::UnitY()).norm(), 3e-5f);
    });
  EXPECT_NEAR(near.mean_distance * bounding_box(high).diagonal(), 0.05, 1e-6);
}

TEST(Normals, TheOtherSideOfAThinSheetIsNotTaken) {
  // A sheet from y = -0.01 (facing down) to 0.01 (facing up), and the low mesh's upper side nearer to the sheet's lower
  // one.
  const TriangleMesh high = joined(shapes::plane(8, 1, 0.01f), turned_over(shapes::plane(8, 1, -0.01f)));
  for (const float height : {-0.005f, -0.015f, 0.02f}) {
    for (const double cage : {0.05, 0.01}) {
      const NormalsResult result = make_normals(high, shapes::plane(2, 0.9f, height), {.size = 32, .cage = cage});
      for_each_covered(result, [&](int i, int j) {
        EXPECT_NEAR(vector_at(result.position, i, j).y(), 0.01f, 1e-6);
        EXPECT_GT(decoded_at(result.normal, i, j).y(), 0.99f);
      });
    }
  }
}

TEST(Normals, RaysPastARimDoNotTakeWhatLiesFarBehind) {
  // The low mesh reaches 0.02 beyond the rim of a small square; inwards from there rays only meet a ground far below.
  const TriangleMesh high = joined(shapes::plane(4, 0.2f, 0), shapes::plane(4, 2, -0.3f));
  const NormalsResult result = make_normals(high, shapes::plane(2, 0.24f, 0.01f), {.size = 64, .cage = 0.5});
  for_each_covered(result, [&](int i, int j) { EXPECT_NEAR(vector_at(result.position, i, j).y(), 0, 1e-6); });
  // The rim's strip: 1 - (0.2 / 0.24)^2 = 0.306 of the area, to a texel's width (1/51 of a side) around.
  EXPECT_NEAR(result.found_by_nearest_point, 0.306, 0.05);
  EXPECT_EQ(result.disagreeing, 0);
}

TEST(Normals, ObliqueHitsGiveWayToStraightOnes) {
  // Above the low plane at 0.02 lies a surface tilted by 65 degrees, below it at 0.03 one that is parallel.
  TriangleMesh steep = shapes::plane(2, 1);
  const Eigen::AngleAxisf tilt(static_cast<float>(65 * degree), Eigen::Vector3f::UnitX());
  for (Eigen::Vector3f& p : steep.positions) p = tilt * p;
  for (Eigen::Vector3f& n : steep.normals) n = tilt * n;
  const TriangleMesh high = joined(steep, shapes::plane(2, 1, -0.03f));
  TriangleMesh low = shapes::plane(1, 0.001f);
  for (Eigen::Vector3f& p : low.positions) p.z() -= 0.02f / std::tan(static_cast<float>(65 * degree));
  const NormalsResult result = make_normals(high, low, {.size = 16, .cage = 0.1});
  for_each_covered(result, [&](int i, int j) { EXPECT_GT(decoded_at(result.normal, i, j).y(), 0.9f); });
}

TEST(Normals, CageComesFromTheHintOrFromMeasuring) {
  const TriangleMesh high = shapes::plane(8, 1, 0.05f), low = shapes::plane(1, 1);
  const NormalsResult hinted = make_normals(high, low, {.size = 16}, {.hausdorff_distance = 0.06});
  EXPECT_EQ(hinted.cage_source, "simplify.json");
  EXPECT_DOUBLE_EQ(hinted.cage_distance, 0.12);
  const NormalsResult measured = make_normals(high, low, {.size = 16});
  EXPECT_EQ(measured.cage_source, "measured");
  EXPECT_NEAR(measured.cage_distance, 0.1, 1e-6);
  EXPECT_EQ(measured.found_by_ray_outwards, 1);
  // A mesh that is its own simplification gets a small cage, but one.
  const NormalsResult same = make_normals(low, low, {.size = 16});
  EXPECT_GT(same.cage_distance, 0);
  EXPECT_EQ(same.found_by_nearest_point, 0);
  EXPECT_EQ(make_normals(high, low, {}, {.width = 48, .height = 48}).coverage.width(), 48);
  EXPECT_EQ(make_normals(high, low, {.size = 24}, {.width = 48, .height = 48}).coverage.width(), 24);
}

TEST(Normals, BilinearLookupsInsideChartsSeeOnlyTheSphere) {
  const int size = 96;
  const TriangleMesh high = shapes::icosphere(6), low = shapes::cube_sphere(6);
  for (const NormalSpace space : {NormalSpace::object, NormalSpace::tangent}) {
    const NormalsResult result = make_normals(high, low, {.space = space, .size = size});
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform;
    int interior = 0, ring = 0;
    for (int k = 0; k < 20'000; ++k) {
      // The source is a point of the low mesh, corners and edges of charts included.
      const Triangle& t = low.triangles[random() % low.triangles.size()];
      float u = uniform(random), v = uniform(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (k % 3 == 0) v = 0;
      const Eigen::Vector2f uv = (1 - u - v) * low.uvs[t[0]] + u * low.uvs[t[1]] + v * low.uvs[t[2]];
      const Eigen::Vector3f wanted =
          ((1 - u - v) * low.positions[t[0]] + u * low.positions[t[1]] + v * low.positions[t[2]]).normalized();
      const Eigen::Vector2f texel = uv * static_cast<float>(size) - Eigen::Vector2f::Constant(0.5f);
      const int i = static_cast<int>(std::floor(texel.x())), j = static_cast<int>(std::floor(texel.y()));
      const float s = texel.x() - static_cast<float>(i), r = texel.y() - static_cast<float>(j);
      const auto lookup = [&](const auto& at) -> Eigen::Vector3f {
        return (1 - r) * ((1 - s) * at(i, j) + s * at(i + 1, j)) + r * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1));
      };
      // A chart is 28 texels wide and 90 degrees: a texel is 0.056 to 0.075 of the radius. A ring texel holds the mean
      // of texels up to one and a half away. Between four covered texels the sphere's curvature, a texel's square over
      // 8 along each axis, is 0.0014, the match of SphereOverACoarseSphere within 0.01, and what makes seams equal
      // moves the texels next to them: 0.0146 at most, as measured.
      bool is_interior = true;
      for (const int x : {i, i + 1})
        for (const int y : {j, j + 1}) is_interior = is_interior && result.coverage.at(x, y) != 0;
      (is_interior ? interior : ring) += 1;
      const float most = is_interior ? 0.017f : 0.12f;
      const Eigen::Vector3f position = lookup([&](int x, int y) { return vector_at(result.position, x, y); });
      EXPECT_LT((position - wanted).norm(), most);
      const Eigen::Vector3f normal = lookup([&](int x, int y) { return decoded_at(result.normal, x, y); });
      if (space == NormalSpace::object) {
        EXPECT_LT((normal - wanted).norm(), most);
      } else {
        EXPECT_GT(normal.z(), 0.98f);  // low and high normal are the radius, up to the low mesh's interpolation
      }
    }
    EXPECT_GT(interior, 10'000);
    EXPECT_GT(ring, 500);
  }
}

class DetailMapsFolder : public ::testing::Test {
 protected:
  /// Writes the maps as main does.
  void save(const NormalsResult& result) const {
    OutputSet outputs(folder_);
    write_png(outputs.add("normal.png"), result.normal);
    write_exr(outputs.add("position.exr"), result.position);
    write_png(outputs.add("coverage.png"), result.coverage);
    outputs.add_text("normals.json", Json{{"settings", {{"space", result.to_json()["space"]}}}}.dump());
    outputs.commit();
  }

  void expect_refusal(const TriangleMesh& atlas, const std::string& words) const {
    try {
      load_detail_maps(folder_, atlas);
      ADD_FAILURE() << "accepted, where a message with '" << words << "' was expected";
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  const Scratch scratch_;
  const std::filesystem::path& folder_ = scratch_.folder();
};

/// Makes a sphere with dents, whose normals differ from the low sphere's by up to 40 degrees.
TriangleMesh dented_sphere() {
  TriangleMesh mesh = shapes::icosphere(6);
  for (Eigen::Vector3f& p : mesh.positions)
    p *= 1 + 0.03f * std::sin(20 * p.x()) * std::sin(17 * p.y()) * std::cos(15 * p.z());
  compute_vertex_normals(mesh);
  return mesh;
}

TEST_F(DetailMapsFolder, BothSpacesHoldTheSameNormals) {
  const TriangleMesh high = dented_sphere(), low = shapes::cube_sphere(6);
  const NormalsResult object = make_normals(high, low, {.size = 128, .seams = SeamChoice::keep});
  save(object);
  const DetailMaps from_object = load_detail_maps(folder_, low);
  const NormalsResult tangent =
      make_normals(high, low, {.space = NormalSpace::tangent, .size = 128, .seams = SeamChoice::keep});
  save(tangent);
  const DetailMaps from_tangent = load_detail_maps(folder_, low);

  ASSERT_EQ(from_object.width, 128);
  ASSERT_EQ(from_object.height, 128);
  EXPECT_EQ(from_object.position.values(), object.position.values());
  EXPECT_EQ(from_object.covered, from_tangent.covered);
  EXPECT_GT(object.normal_deviation_degrees_largest, 20) << "the test needs normals that deviate";
  EXPECT_NEAR(object.normal_deviation_degrees_mean, tangent.normal_deviation_degrees_mean, 0.001);
  for_each_covered(object, [&](int i, int j) {
    EXPECT_EQ(from_object.covered[static_cast<std::size_t>(j) * 128 + i], 1);
    const Eigen::Vector3f a = vector_at(from_object.normal_object, i, j),
                          b = vector_at(from_tangent.normal_object, i, j);
    EXPECT_NEAR(a.norm(), 1, 1e-6);
    // Half a 16-bit step, 1.5e-5, per axis and map; the frames, not being orthonormal, stretch it a little.
    EXPECT_LT((a - b).norm(), 8e-5f);
  });
  // Tangent-space maps look up everywhere: blue, whatever side of the sphere.
  for_each_covered(tangent, [&](int i, int j) { EXPECT_GT(decoded_at(tangent.normal, i, j).z(), 0.5f); });
  // Outside the charts normals are unit vectors too.
  for (int j = 0; j < 128; ++j)
    for (int i = 0; i < 128; ++i) {
      EXPECT_NEAR(vector_at(from_object.normal_object, i, j).norm(), 1, 1e-5);
      EXPECT_NEAR(vector_at(from_tangent.normal_object, i, j).norm(), 1, 1e-5);
    }
}

TEST_F(DetailMapsFolder, WhatDoesNotBelongTogetherIsRefused) {
  const TriangleMesh low = shapes::cube_sphere(4), high = shapes::icosphere(4);
  const NormalsResult result = make_normals(high, low, {.size = 64});
  save(result);
  EXPECT_EQ(load_detail_maps(folder_, low).width, 64);
  expect_refusal(shapes::plane(4), "not the atlas mesh's");

  write_png(folder_ / "normal.png", Image<std::uint16_t>(64, 32, 3));
  expect_refusal(low, "64 x 32");
  write_png(folder_ / "normal.png", Image<std::uint8_t>(64, 64, 3));
  expect_refusal(low, "8 bits");
  std::filesystem::remove(folder_ / "normal.png");
  expect_refusal(low, "normal.png");
  save(result);
  write_exr(folder_ / "position.exr", Image<float>(64, 64, 4));
  expect_refusal(low, "4 channels");
  write_exr(folder_ / "position.exr", Image<float>(64, 64, 3, std::nanf("")));
  expect_refusal(low, "finite");
  save(result);
  for (const char* text : {"", "{", "[1]", "{}", R"({"settings": 3})", R"({"settings": {"space": "world"}})"}) {
    std::ofstream(folder_ / "normals.json") << text;
    expect_refusal(low, "normals.json");
  }
  std::filesystem::remove_all(folder_);
  expect_refusal(low, "no such folder");
}

TEST_F(DetailMapsFolder, HintsOfEarlierStages) {
  EXPECT_EQ(read_asset_hints(folder_).width, 0);
  EXPECT_EQ(read_asset_hints(folder_).hausdorff_distance, 0);
  std::ofstream(folder_ / "atlas.json") << R"({"stage": "atlas", "settings": {"size": 256}})";
  std::ofstream(folder_ / "simplify.json") << R"({"hausdorff": 0.01, "hausdorff_distance": 2.5})";
  EXPECT_EQ(read_asset_hints(folder_).width, 256);
  EXPECT_EQ(read_asset_hints(folder_).height, 256);
  EXPECT_EQ(read_asset_hints(folder_).hausdorff_distance, 2.5);
  std::ofstream(folder_ / "simplify.json") << "{ \"hausdorff";
  EXPECT_THROW(read_asset_hints(folder_), BadInput);
}

TEST(Normals, AThinEarKeepsItsSides) {
  // Flat as an ear, with dents, and a low mesh of 96 triangles that crosses it: rays along its normals pass the rim,
  // and either side is nearer to the other than the low surface to its own.
  const auto flatten = [](TriangleMesh mesh) {
    for (Eigen::Vector3f& p : mesh.positions) p.z() *= 0.02f;
    for (Eigen::Vector3f& n : mesh.normals) n = n.cwiseProduct(Eigen::Vector3f(1, 1, 50)).normalized();
    return mesh;
  };
  TriangleMesh high = flatten(dented_sphere());
  compute_vertex_normals(high);
  const TriangleMesh low = flatten(shapes::cube_sphere(4));
  const UvRaster raster = rasterise_uvs(low, 128, 128);
  for (const int samples : {1, 16}) {
    const NormalsResult result = make_normals(high, low, {.size = 128, .samples = samples});
    EXPECT_EQ(result.disagreeing, 0);
    int sides = 0;
    for_each_covered(result, [&](int i, int j) {
      const Eigen::Vector3f low_normal = interpolate(low, low.normals, raster.at(i, j)).normalized();
      // Texels on the faces, not the rim, count.
      if (std::abs(low_normal.z()) < 0.9f) return;
      ++sides;
      EXPECT_GT(decoded_at(result.normal, i, j).z() * low_normal.z(), 0);
    });
    EXPECT_GT(sides, 1000);
  }
}

/// Makes the bunny of so few triangles that its ears intersect, each triangle in a square of its own of 32 * 32.
TriangleMesh bunny_of_single_charts(const TriangleMesh& high) {
  const TriangleMesh low = simplify(high, {.faces = 300}).mesh;
  TriangleMesh charts;
  for (std::size_t t = 0; t < low.triangles.size(); ++t) {
    const Eigen::Vector2f corner(static_cast<float>(t % 32), static_cast<float>(t / 32));
    const auto first = static_cast<std::uint32_t>(charts.positions.size());
    for (const std::uint32_t vertex : low.triangles[t]) {
      charts.positions.push_back(low.positions[vertex]);
      charts.normals.push_back(low.normals[vertex]);
    }
    for (const Eigen::Vector2f& place : {Eigen::Vector2f(0.1f, 0.1f), {0.9f, 0.1f}, {0.1f, 0.9f}})
      charts.uvs.push_back((corner + place) / 32);
    charts.triangles.push_back({first, first + 1, first + 2});
  }
  return charts;
}

TEST(Normals, TheBunnysEarsKeepTheirSides) {
  const TriangleMesh high = load_mesh("/usr/share/glmark2/models/bunny.obj");
  const TriangleMesh low = bunny_of_single_charts(high);
  const BoundingBox box = bounding_box(low);
  const RayScene scene(high);
  const UvRaster raster = rasterise_uvs(low, 512, 512);
  for (const int samples : {1, 16}) {
    const NormalsResult result = make_normals(high, low, {.size = 512, .samples = samples, .seams = SeamChoice::keep});
    int on_ears = 0, nearest_on_the_other_side = 0;
    for_each_covered(result, [&](int i, int j) {
      const TexelSource& source = raster.at(i, j);
      const Eigen::Vector3f low_point = interpolate(low, low.positions, source);
      // The ears are the uppermost quarter.
      if (low_point.y() < box.lowest.y() + 0.75f * (box.highest.y() - box.lowest.y())) return;
      ++on_ears;
      const Eigen::Vector3f low_normal = interpolate(low, low.normals, source).normalized();
      EXPECT_GT(decoded_at(result.normal, i, j).dot(low_normal), 0) << i << ' ' << j;
      // Rays go as far as the cage, and where they disagree a point is sought within four times that.
      EXPECT_LE((vector_at(result.position, i, j) - low_point).norm(), result.cage_distance) << i << ' ' << j;
      const SurfacePoint nearest = scene.closest_point(low_point, std::numeric_limits<float>::infinity());
      const Triangle& t = high.triangles[nearest.triangle];
      const Eigen::Vector3f a = high.positions[t[0]];
      nearest_on_the_other_side +=
          (high.positions[t[1]] - a).cross(high.positions[t[2]] - a).dot(low_normal) < 0 ? 1 : 0;
    });
    EXPECT_GT(on_ears, 2500);
    // The subject of the test: the nearest point is often on the other side.
    EXPECT_GT(nearest_on_the_other_side, 0);
    EXPECT_EQ(result.disagreeing, 0);
  }
}

TEST(Normals, ASphereThroughABoxKeepsToItself) {
  // Near their intersection the box is as close as the sphere; its normals differ by 34 degrees and more.
  TriangleMesh high = shapes::joined(shapes::icosphere(5, 0.6f), shapes::cube(8), {0, 0, 0});
  compute_vertex_normals(high);
  const TriangleMesh low = shapes::cube_sphere(6, 0.6f);
  const NormalsResult result = make_normals(high, low, {.size = 192});
  const Image<float> normal = dequantise_normals(result.normal);
  int covered = 0;
  for (int j = 0; j < 192; ++j)
    for (int i = 0; i < 192; ++i) {
      if (result.coverage.at(i, j) == 0) continue;
      ++covered;
      const Eigen::Vector3f n(normal.at(i, j, 0), normal.at(i, j, 1), normal.at(i, j, 2));
      const Eigen::Vector3f p(result.position.at(i, j, 0), result.position.at(i, j, 1), result.position.at(i, j, 2));
      // 1.8 degrees between facets of the sphere, and what equalising seams turns.
      EXPECT_GT(n.dot(p.normalized()), 0.995f) << "texel " << i << ", " << j;
    }
  EXPECT_GT(covered, 10000);
}

TEST(Normals, ThePictureOfWaysAgreesWithTheShares) {
  const TriangleMesh high = dented_sphere(), low = shapes::cube_sphere(6);
  const NormalsResult result = make_normals(high, low, {.size = 96, .cage = 0.004});
  std::array<int, texel_way_colors.size()> counts{};
  for (int j = 0; j < 96; ++j)
    for (int i = 0; i < 96; ++i)
      for (std::size_t way = 0; way < counts.size(); ++way)
        if (std::equal(texel_way_colors[way].color.begin(), texel_way_colors[way].color.end(),
                       result.match.pixel(i, j).begin())) {
          ++counts[way];
          EXPECT_EQ(way != 0, result.coverage.at(i, j) != 0);
        }
  EXPECT_EQ(counts[0] + counts[1] + counts[2] + counts[3] + counts[4], 96 * 96);
  const auto texels = static_cast<double>(result.covered_texels);
  EXPECT_GT(counts[1], 0);
  EXPECT_GT(counts[2], 0);
  EXPECT_GT(counts[3], 0) << "the test needs a cage that is too small for some texels";
  EXPECT_DOUBLE_EQ(counts[1] / texels, result.found_by_ray_outwards);
  EXPECT_DOUBLE_EQ(counts[2] / texels, result.found_by_ray_inwards);
  EXPECT_DOUBLE_EQ((counts[3] + counts[4]) / texels, result.found_by_nearest_point);
  EXPECT_DOUBLE_EQ(counts[4] / texels, result.disagreeing);
}

TEST(Normals, SamplesFitWhatLookupsShow) {
  // Dents a few texels wide: lookups between texels' centres miss some of it, and the fit makes up for it.
  const TriangleMesh high = dented_sphere(), low = shapes::cube_sphere(6);
  const NormalsResult one = make_normals(high, low, {.size = 96});
  EXPECT_GT(one.map_error.mean_degrees, 0.5);
  NormalsSettings fitted;
  fitted.size = 96;
  fitted.fit = true;
  EXPECT_LT(make_normals(high, low, fitted).map_error.mean_degrees, 0.97 * one.map_error.mean_degrees);
  for (const int samples : {4, 16, 64}) {
    const NormalsResult many = make_normals(high, low, {.size = 96, .samples = samples});
    EXPECT_EQ(many.position.values(), one.position.values()) << "the receivers are the centres' points";
    EXPECT_LT(many.map_error.mean_degrees, 0.95 * one.map_error.mean_degrees);
    for_each_covered(many, [&](int i, int j) { EXPECT_NEAR(decoded_at(many.normal, i, j).norm(), 1, 1e-4); });
  }
  // Detail that bilinear lookups can show exactly is kept: a plane's single normal.
  const TriangleMesh plane = shapes::plane(4);
  const NormalsResult flat = make_normals(plane, plane, {.size = 32, .samples = 16});
  for_each_covered(flat, [&](int i, int j) {
    EXPECT_LT((decoded_at(flat.normal, i, j) - Eigen::Vector3f::UnitY()).norm(), 3e-5f);  // a 16-bit step
  });
  EXPECT_LT(flat.map_error.largest_degrees, 0.002);
}

TEST(Normals, ErrorOfTheMapIsTheAngleToTheHighNormals) {
  // A map that says +Y, of a high mesh whose normals lean by 10 degrees on one half and by 30 on the other.
  TriangleMesh high = shapes::plane(8);
  const TriangleMesh atlas = shapes::plane(2);
  for (std::size_t k = 0; k < high.positions.size(); ++k) {
    const double lean = (high.positions[k].x() < 0 ? 10 : 30) * degree;
    high.normals[k] = {static_cast<float>(std::sin(lean)), static_cast<float>(std::cos(lean)), 0};
  }
  Image<float> map(16, 16, 3);
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) map.at(i, j, 1) = 1;
  const MapError error = measure_map_error({high, atlas, {}}, map, NormalSpace::object, 50'000);
  // Between the last vertex of the first half and the first of the other, an eighth of the plane before x = 0, normals
  // turn from 10 to 30: 3/8 at 10, 1/8 at 20 in the mean, 4/8 at 30.
  EXPECT_NEAR(error.mean_degrees, 0.375 * 10 + 0.125 * 20 + 0.5 * 30, 0.05);
  EXPECT_NEAR(error.percentile_95_degrees, 30, 0.01);
  EXPECT_NEAR(error.largest_degrees, 30, 0.01);
}

TEST(Normals, OneThreadAndManyGiveTheSameBytes) {
  const TriangleMesh high = dented_sphere(), low = shapes::cube_sphere(6);
  const auto run = [&](int threads) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    return make_normals(high, low, {.space = NormalSpace::tangent, .size = 128, .samples = 4});
  };
  NormalsResult one = run(1), many = run(4);
  one.measuring_seconds = many.measuring_seconds = 0;
  EXPECT_EQ(one.normal.values(), many.normal.values());
  EXPECT_EQ(one.position.values(), many.position.values());
  EXPECT_EQ(one.coverage.values(), many.coverage.values());
  EXPECT_EQ(one.to_json(), many.to_json());
}

TEST(Normals, WhatCannotBeDoneIsSaid) {
  const TriangleMesh high = shapes::icosphere(2);
  TriangleMesh low = shapes::cube_sphere(1);
  // A chart from 0.45 to 0.55 lies between the centres of two texels, 0.25 and 0.75.
  EXPECT_THROW(make_normals(high, shapes::plane(1, 1, 0, 0.45f), {.size = 2}), WrongUsage);
  EXPECT_THROW(make_normals({}, low, {}), std::invalid_argument);
  low.normals.clear();
  EXPECT_THROW(make_normals(high, low, {}), std::invalid_argument);
}

}  // namespace test_normals
}  // namespace kiln
