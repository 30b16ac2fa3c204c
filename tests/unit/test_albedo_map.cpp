// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/json.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "image/image_file.h"
#include "image/srgb.h"
#include "maps/detail_maps.h"
#include "normals/normals.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_albedo_map {

Eigen::Vector3f vector_at(const Image<float>& image, int i, int j) {
  return Eigen::Map<const Eigen::Vector3f>(image.pixel(i, j).data());
}

/// Computes a colour that changes slowly over the unit sphere.
Eigen::Vector3f smooth(const Eigen::Vector3f& p) {
  return {0.5f + 0.4f * std::sin(3 * p.x()), 0.5f + 0.4f * p.y(), 0.3f + 0.2f * p.x() * p.z()};
}

/// Colours squares black and white, with edges as sharp as the triangles of `high` are small.
Eigen::Vector3f checkered(const Eigen::Vector3f& p) {
  const float wave = std::sin(8 * p.x()) * std::sin(8 * p.y()) * std::sin(8 * p.z() + 0.5f);
  return Eigen::Vector3f::Constant(wave > 0 ? 0.9f : 0.1f);
}

template <class Color>
SurfaceAlbedo painted(const TriangleMesh& mesh, const Color& color) {
  std::vector<Eigen::Vector3f> colors;
  for (const Eigen::Vector3f& p : mesh.positions) colors.push_back(color(p));
  return SurfaceAlbedo::of_vertices(std::move(colors), mesh.triangles);
}

NormalsResult make(const TriangleMesh& high, const TriangleMesh& low, const NormalsSettings& settings,
                   const SurfaceAlbedo& albedo) {
  return make_normals(high, low, settings, {}, no_progress, {.albedo = albedo});
}

/// Tolerance: half a step of 1/255 in sRGB, times the steepest slope of its decoding, 1.055^-2.4 * 2.4 * 1.055^1.4 =
/// 2.275.
constexpr float half_step = 0.5f / 255 * 2.275f;

TEST(AlbedoMap, HoldsTheColorOfEveryTexelsPoint) {
  const TriangleMesh high = shapes::icosphere(6), low = shapes::cube_sphere(6);
  for (const int samples : {1, 16}) {
    SCOPED_TRACE(samples);
    const NormalsResult result =
        make(high, low, {.size = 128, .samples = samples, .seams = SeamChoice::keep}, painted(high, smooth));
    ASSERT_TRUE(result.albedo_map);
    const Image<float> decoded = linear_from_srgb_bytes(result.albedo_map->picture);
    for (int j = 0; j < 128; ++j)
      for (int i = 0; i < 128; ++i) {
        if (result.coverage.at(i, j) == 0) continue;
        // Edges of high triangles are up to 0.0205 long and the colour's second derivative is below 3.6, so that linear
        // interpolation over them is off by at most 3.6 / 8 * 0.0205^2 = 2e-4. A chart is 38 texels wide and 90
        // degrees, a texel at most 0.053; the best spline's coefficients are h^2 / 12 of that derivative off the
        // centres' values along an axis on which the colour bends, 8.4e-4.
        const Eigen::Vector3f difference = vector_at(decoded, i, j) - smooth(vector_at(result.position, i, j));
        EXPECT_LE(difference.cwiseAbs().maxCoeff(), half_step + 1.1e-3f) << i << ", " << j;
      }
    // Lookups between texels are a mean of roundings, some of them off by h^2 / 8 of that derivative.
    EXPECT_LT(result.albedo_map->error.rms, 0.5f * half_step);
  }
}

TEST(AlbedoMap, BothSidesOfSeamsAgree) {
  const TriangleMesh high = shapes::icosphere(6), low = shapes::cube_sphere(6);
  const SurfaceAlbedo albedo = painted(high, checkered);
  const AlbedoMap kept = *make(high, low, {.size = 128, .seams = SeamChoice::keep}, albedo).albedo_map;
  const AlbedoMap equal = *make(high, low, {.size = 128}, albedo).albedo_map;
  EXPECT_EQ(kept.seam_before.mean, kept.seam_after.mean);
  EXPECT_EQ(equal.seam_before.mean, kept.seam_after.mean);
  EXPECT_GT(kept.seam_after.mean, 0.015) << "the test needs seams that show";
  // The rest is about the rounding of bytes: half a step a side.
  EXPECT_LT(equal.seam_after.mean, 2 * half_step);
  EXPECT_LT(equal.seam_after.largest, 0.25 * kept.seam_after.largest);
}

TEST(AlbedoMap, SamplesFitSharpEdgesWithoutHalos) {
  const TriangleMesh high = shapes::icosphere(7), low = shapes::cube_sphere(6);
  const SurfaceAlbedo albedo = painted(high, checkered);
  const NormalsSettings one = {.size = 96, .seams = SeamChoice::keep};
  NormalsSettings many = one;
  many.samples = 16;
  const AlbedoMap centres = *make(high, low, one, albedo).albedo_map,
                  fitted = *make(high, low, many, albedo).albedo_map;
  EXPECT_GT(centres.error.rms, 0.05) << "the test needs edges";
  EXPECT_LT(fitted.error.rms, 0.95 * centres.error.rms);
  const auto [least, most] = std::minmax_element(fitted.picture.values().begin(), fitted.picture.values().end());
  EXPECT_GE(*least, byte_from_unit(srgb_from_linear(0.1f)));
  EXPECT_LE(*most, byte_from_unit(srgb_from_linear(0.9f)));
}

TEST(AlbedoMap, ErrorIsThatOfTheMap) {
  // A map of 0.5 on a surface of which half is 0.5 and half 0.8 in green alone.
  const TriangleMesh plane = shapes::plane(64);
  const SurfaceAlbedo albedo =
      painted(plane, [](const Eigen::Vector3f& p) { return Eigen::Vector3f(0.5f, p.x() < 0 ? 0.5f : 0.8f, 0.5f); });
  const AlbedoError error = measure_albedo_error({plane, plane, {}}, albedo, Image<float>(8, 8, 3, 0.5f), 50'000);
  // sqrt(0.3^2 / 2 / 3); the strip between the two halves is a 64th of the plane.
  EXPECT_NEAR(error.rms, 0.3 / std::sqrt(6), 0.002);
  EXPECT_NEAR(error.percentile_95, 0.3, 1e-6);
}

TEST(AlbedoMap, OneThreadAndManyGiveTheSameBytes) {
  const TriangleMesh high = shapes::icosphere(5), low = shapes::cube_sphere(4);
  const SurfaceAlbedo albedo = painted(high, checkered);
  const auto run = [&](int threads) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    return make(high, low, {.size = 96, .samples = 4}, albedo).albedo_map->picture.values();
  };
  EXPECT_EQ(run(1), run(4));
}

class AlbedoFolder : public testing::Test {
 protected:
  /// Writes the map as kiln-normals does.
  void save(const NormalsResult& result) {
    write_png(path("normal.png"), result.normal);
    write_exr(path("position.exr"), result.position);
    write_png(path("coverage.png"), result.coverage);
    if (result.albedo_map) write_png(path("albedo.png"), result.albedo_map->picture);
    Json record = result.to_json();
    record["settings"] = {{"space", "object"}};
    save_record(record);
  }
  void save_record(const Json& record) { std::ofstream(path("normals.json")) << record.dump(); }
  std::filesystem::path path(const std::string& name) const { return scratch_.folder() / name; }
  DetailMaps load() const { return load_detail_maps(scratch_.folder(), low_); }
  std::string refusal() const {
    try {
      load();
    } catch (const BadInput& error) {
      return error.what();
    }
    return "no error";
  }

  TriangleMesh high_ = shapes::icosphere(4), low_ = shapes::cube_sphere(4);

 private:
  Scratch scratch_;
};

TEST_F(AlbedoFolder, IsReadBack) {
  const NormalsResult result = make(high_, low_, {.size = 64}, painted(high_, smooth));
  save(result);
  const DetailMaps maps = load();
  EXPECT_EQ(maps.albedo.values(), linear_from_srgb_bytes(result.albedo_map->picture).values());
  EXPECT_EQ(maps.albedo_at(20, 30), vector_at(maps.albedo, 20, 30));

  // A constant needs no picture, and a stale one does not count.
  const NormalsResult grey =
      make(high_, low_, {.size = 64}, SurfaceAlbedo::constant(Eigen::Vector3f(0.1f, 0.25f, 0.5f)));
  EXPECT_FALSE(grey.albedo_map);
  save(grey);
  EXPECT_TRUE(load().albedo.values().empty());
  EXPECT_EQ(load().albedo_at(20, 30), Eigen::Vector3f(0.1f, 0.25f, 0.5f));

  save_record({{"settings", {{"space", "object"}}}});
  EXPECT_EQ(load().albedo_at(20, 30), Eigen::Vector3f::Ones()) << "a record from before there was albedo";
}

TEST_F(AlbedoFolder, APictureOfItsOwnSizeIsMadeFromItsOwnTexels) {
  NormalsSettings settings;
  settings.size = 64;
  const NormalsResult same = make(high_, low_, settings, painted(high_, checkered));
  settings.albedo_size = Extent(256, 192);
  const NormalsResult own = make(high_, low_, settings, painted(high_, checkered));
  EXPECT_EQ(own.albedo_map->picture.width(), 256);
  EXPECT_EQ(own.albedo_map->picture.height(), 192);
  EXPECT_LT(own.albedo_map->error.rms, 0.5 * same.albedo_map->error.rms);
  EXPECT_EQ(own.normal.values(), same.normal.values());

  // The bake takes means over its own texels.
  save(own);
  const DetailMaps maps = load();
  EXPECT_EQ(maps.albedo_width, 256);
  EXPECT_EQ(maps.albedo.width(), 64);
  double squares = 0;
  int count = 0;
  const Image<float> others = linear_from_srgb_bytes(same.albedo_map->picture);
  for (std::size_t texel = 0; texel < maps.covered.size(); ++texel)
    for (std::size_t c = 0; c < 3 && maps.covered[texel] != 0; ++c, ++count)
      squares += std::pow(static_cast<double>(maps.albedo.values()[3 * texel + c] - others.values()[3 * texel + c]), 2);
  // Means blur edges that centres see on one side: of values of .1 and .9, at edges in a third of the texels.
  EXPECT_LT(std::sqrt(squares / count), 0.2);
}

TEST_F(AlbedoFolder, WhatDoesNotFitIsRefused) {
  save(make(high_, low_, {.size = 64}, painted(high_, smooth)));
  write_png(path("albedo.png"), Image<std::uint8_t>(32, 64, 3));
  EXPECT_NE(refusal().find("albedo.png: 32 x 64 texels of 3 channels; expected 64 x 64"), std::string::npos);
  write_png(path("albedo.png"), Image<std::uint8_t>(64, 64, 1));
  EXPECT_NE(refusal().find("1 channel;"), std::string::npos);
  std::filesystem::remove(path("albedo.png"));
  EXPECT_NE(refusal().find("albedo.png: no such file"), std::string::npos);
  for (const char* albedo :
       {R"({"source": "constant", "constant": [1, 1]})", R"({"source": "constant", "constant": 1})",
        R"({"source": "constant", "constant": [1, 1, 2]})", "3", R"({"constant": [1, 1, 1]})"}) {
    save_record({{"settings", {{"space", "object"}}}, {"albedo", Json::parse(albedo)}});
    EXPECT_NE(refusal().find("normals.json"), std::string::npos) << albedo;
  }
}

}  // namespace test_albedo_map
}  // namespace kiln
