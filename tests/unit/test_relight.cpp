// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/errors.h"
#include "base/files.h"
#include "gpu/egl_context.h"
#include "image/gutter.h"
#include "image/image_file.h"
#include "lights/light_settings.h"
#include "mesh/camera.h"
#include "mesh/draco_file.h"
#include "mesh/uv_raster.h"
#include "prt_folders.h"
#include "render/output/picture.h"
#include "render/render_settings.h"
#include "runtime/decode/plane_weights.h"
#include "runtime/light/environment.h"
#include "scratch.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_spec.h"
#include "shapes.h"

namespace kiln {
namespace test_relight {

namespace fs = std::filesystem;
using namespace test;
using nlohmann::json;

// ---- lights ----

TEST(LightSpec, ReadsEveryForm) {
  const LightSpec plain = parse_light_spec("-60,20");
  EXPECT_EQ(plain.kind, LightSpec::Kind::directional);
  EXPECT_EQ(plain.azimuth_degrees, -60);
  EXPECT_EQ(plain.elevation_degrees, 20);
  EXPECT_EQ(plain.color, (std::array<float, 3>{1, 1, 1}));
  const LightSpec colored = parse_light_spec("directional:12.5,-3e1,1,0.9,0.25");
  EXPECT_EQ(colored.azimuth_degrees, 12.5);
  EXPECT_EQ(colored.elevation_degrees, -30);
  EXPECT_EQ(colored.color, (std::array<float, 3>{1, 0.9f, 0.25f}));
  EXPECT_EQ(parse_light_spec("ambient:2").color, (std::array<float, 3>{2, 2, 2}));
  EXPECT_EQ(parse_light_spec("ambient:1,2,3").kind, LightSpec::Kind::ambient);
  for (const char* text : {"45,30", "directional:-0.1,7,0.1,0.2,0.3", "ambient:0.7"})
    EXPECT_EQ(to_text(parse_light_spec(to_text(parse_light_spec(text)))), to_text(parse_light_spec(text)));
}

TEST(LightSpec, RefusesWhatIsNoLight) {
  for (const char* text : {"",         "45",         "45,30,1",     "45,30,1,1",    "45,30,1,1,1,1", "45;30",  "45,91",
                           "400,0",    "nan,0",      "inf,3",       "45,30,-1,0,0", "45,30 ",        "45,,30", "45,30,",
                           "ambient:", "ambient:-1", "ambient:1,2", "ambient:x",    "sun:1,2",       "1e999,0"})
    EXPECT_THROW(parse_light_spec(text), WrongUsage) << text;
}

TEST(LightSpec, SumsAndWindowsLights) {
  const std::vector<LightSpec> specs = {parse_light_spec("0,90,2,0,0"), parse_light_spec("ambient:0,3,0")};
  const LightCoefficients plain = light_coefficients(specs, 3, LightWindow::none);
  const LightCoefficients hann = light_coefficients(specs, 3, LightWindow::hann);
  // Red: pi * 2 * Y_1^-1(+Y) over what a surface that faces it would have, the sum of w_l A_l (2l + 1) / 4 pi, which is
  // 1/4 + w_1 / 2 + 5 w_2 / 16; hann's w_1 is (1 + cos(pi / 3)) / 2 and its w_2 (1 + cos(2 pi / 3)) / 2.
  EXPECT_NEAR(plain.channels[0][1], 2 * M_PI * 0.488603 / (0.25 + 0.5 + 0.3125), 1e-5);
  EXPECT_NEAR(hann.channels[0][1], 2 * M_PI * 0.488603 * 0.75 / (0.25 + 0.375 + 0.078125), 1e-5);
  // Green: 3 * sqrt(4 pi) in band 0 alone, which no window changes.
  EXPECT_NEAR(plain.channels[1][0], 3 * std::sqrt(4 * M_PI), 1e-5);
  EXPECT_EQ(hann.channels[1][0], plain.channels[1][0]);
  EXPECT_EQ(plain.channels[2], std::vector<float>(9, 0.f));
}

TEST(Environment, OfOneRadianceIsAmbientLight) {
  const Scratch scratch;
  const fs::path file = scratch.folder() / "grey.exr";
  write_exr(file, Image<float>(64, 32, 3, 0.75f));
  const LightCoefficients light = load_environment(file, 5, 33);
  const LightCoefficients expected = constant_light(5, std::array<float, 3>{0.75f, 0.75f, 0.75f});
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 25; ++i) EXPECT_NEAR(light.channels[c][i], expected.channels[c][i], 1e-6) << i;
}

TEST(Environment, TurnsByAzimuth) {
  const Scratch scratch;
  // A spot at +X (azimuth 90): u = 1/2, v = 1/2. Turned by 60 degrees it is at azimuth 150.
  Image<float> picture(2048, 1024, 3, 0.f);
  for (int j = 508; j < 516; ++j)
    for (int i = 1020; i < 1028; ++i) picture.at(i, j, 1) = 1000;
  const fs::path file = scratch.folder() / "spot.exr";
  write_exr(file, picture);
  const float solid_angle = 8.f * 8.f * static_cast<float>(2 * M_PI / 2048 * M_PI / 1024);
  for (const double rotation : {0.0, 60.0, -200.0}) {
    const LightCoefficients light = load_environment(file, 4, rotation);
    std::vector<double> basis(16);
    ShBasis(4).evaluate<double>(direction_from_angles(90 + rotation, 0).cast<double>(), basis);
    for (int i = 0; i < 16; ++i) {
      // The spot is 1.4 degrees wide, and 3 bands turn at most 3 times as fast as the light.
      EXPECT_NEAR(light.channels[1][i], 1000 * solid_angle * basis[i], 0.01) << rotation << " " << i;
      EXPECT_EQ(light.channels[0][i], 0);
    }
  }
}

TEST(Environment, TurnsPicturesOfFewPixels) {
  // Two halves of the sky, z < 0 and z > 0; by a quarter turn the bright one, around +Z, comes around +X.
  const Scratch scratch;
  const fs::path file = scratch.folder() / "halves.exr";
  Image<float> picture(2, 1, 3, 0.f);
  for (int c = 0; c < 3; ++c) picture.at(1, 0, c) = 2;
  write_exr(file, picture);
  const LightCoefficients light = load_environment(file, 6, 90);
  const LightCoefficients expected = cone_light(6, Eigen::Vector3f::UnitX(), M_PI / 2, std::array<float, 3>{2, 2, 2});
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(light.channels[1][i], expected.channels[1][i], 2e-6) << i;
}

TEST(Environment, RefusesWhatIsNoRadiance) {
  const Scratch scratch;
  const fs::path file = scratch.folder() / "bad.exr";
  const auto refusal = [&](float value) -> std::string {
    Image<float> picture(8, 4, 3, 1.f);
    picture.at(3, 2, 1) = value;  // the second row from the top
    write_exr(file, picture);
    try {
      load_environment(file, 3, 0);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(refusal(std::numeric_limits<float>::quiet_NaN()).find("nan in channel G of pixel (3, 1)"),
            std::string::npos);
  EXPECT_NE(refusal(std::numeric_limits<float>::infinity()).find("inf in channel G of pixel (3, 1)"),
            std::string::npos);
  EXPECT_NE(refusal(-0.25f).find("has -0.25 in channel G of pixel (3, 1)"), std::string::npos) << refusal(-0.25f);
  EXPECT_EQ(refusal(0), "none");
  EXPECT_THROW(load_environment(scratch.folder() / "none.hdr", 3, 0), BadInput);
}

// ---- assets ----

TEST(PrtAsset, GivesWhatWasWritten) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::plane(2);
  for (const int bits : {8, 16}) {
    write_asset(scratch.folder(), mesh, noise_stack(16, 8, 2, 3, bits));
    const PrtAsset asset = load_prt_asset(scratch.folder());
    EXPECT_EQ(asset.bands, 2);
    EXPECT_EQ(asset.channels, 3);
    EXPECT_EQ(asset.bits, bits);
    EXPECT_EQ(asset.width, 16);
    EXPECT_EQ(asset.height, 8);
    ASSERT_EQ(asset.planes.size(), 12u);
    EXPECT_EQ(asset.planes[7].channel, 1);
    EXPECT_EQ(asset.planes[7].coefficient, 3);
    EXPECT_EQ(asset.planes[2].range.lowest, asset.planes[2].range.highest);
    EXPECT_EQ(asset.mesh.triangles.size(), 8u);
    EXPECT_EQ(asset.pictures.index(), bits == 8 ? 0u : 1u);
  }
}

TEST(PrtAsset, RefusesMalformedFolders) {
  using Change = std::function<void(json&, const fs::path&)>;
  const auto set = [](const char* pointer, json value) -> Change {
    return [=](json& ranges, const fs::path&) { ranges[json::json_pointer(pointer)] = value; };
  };
  const auto drop = [](const char* key) -> Change { return [=](json& ranges, const fs::path&) { ranges.erase(key); }; };
  const auto text = [](const char* name, const char* content) -> Change {
    return [=](json&, const fs::path& folder) { std::ofstream(folder / name, std::ios::trunc) << content; };
  };
  struct Case {
    const char* name;
    Change change;
    const char* words;  // of the message
  };
  const std::vector<Case> cases = {
      {"no format", drop("format"), "has no format"},
      {"no version", drop("version"), "has no version"},
      {"no bands", drop("bands"), "has no bands"},
      {"no channels", drop("channels"), "has no channels"},
      {"no bits", drop("bits"), "has no bits"},
      {"no width", drop("width"), "has no width"},
      {"no height", drop("height"), "has no height"},
      {"no basis", drop("basis"), "has no basis"},
      {"no mesh", drop("mesh"), "has no mesh"},
      {"no planes", drop("planes"), "has no planes"},
      {"other format", set("/format", "png-stack"), "kiln-prt"},
      {"other basis", set("/basis", "complex"), "real-sh-orthonormal"},
      {"newer version", set("/version", 3), "version is 3"},
      {"bands as text", set("/bands", "2"), "bands is \"2\""},
      {"bands as real", set("/bands", 2.5), "bands is 2.5"},
      {"no bands at all", set("/bands", 0), "1 to 24"},
      {"too many bands", set("/bands", 99), "1 to 24"},
      {"huge bands", set("/bands", 18446744073709551615u), "1 to 24"},
      {"other bands", set("/bands", 3), "a list of 9 planes"},
      {"other channels", set("/channels", 2), "a list of 8 planes"},
      {"12 bits", set("/bits", 12), "8 or 16"},
      {"other bits", set("/bits", 16), "16 bits"},
      {"other width", set("/width", 32), "32 x 8"},
      {"other height", set("/height", 16), "16 x 16"},
      {"negative width", set("/width", -16), "width is -16"},
      {"planes no list", set("/planes", 4), "planes"},
      {"plane no object", set("/planes/1", 4), "planes[1] is 4"},
      {"plane twice", set("/planes/1/coefficient", 0), "coefficient 1 of channel 0"},
      {"plane of another channel", set("/planes/1/channel", 1), "planes[1].channel"},
      {"negative coefficient", set("/planes/3/coefficient", -1), "planes[3].coefficient"},
      {"no min", [](json& ranges, const fs::path&) { ranges["planes"][2].erase("min"); }, "planes[2].min"},
      {"min above max", set("/planes/1/min", 7), "min <= max"},
      {"max null", set("/planes/1/max", nullptr), "finite"},
      {"max beyond float", set("/planes/1/max", 1e200), "finite"},
      {"mesh absolute", set("/mesh", "/etc/passwd"), "inside the folder"},
      {"mesh outside", set("/mesh", "sub/../../atlas.drc"), "inside the folder"},
      {"mesh with zero", set("/mesh", std::string("atlas.drc\0x", 11)), "inside the folder"},
      {"mesh empty", set("/mesh", ""), "inside the folder"},
      {"mesh missing", set("/mesh", "other.drc"), "other.drc"},
      {"normals outside", set("/normals", "../normal.png"), "inside the folder"},
      {"file outside", set("/planes/0/file", "../coeff_0_00.png"), "inside the folder"},
      {"file a number", set("/planes/0/file", 4), "planes[0].file"},
      {"file missing", set("/planes/3/file", "coeff_0_99.png"), "coeff_0_99.png"},
      {"mesh no Draco", text("atlas.drc", "solid"), "atlas.drc"},
      {"mesh empty file", text("atlas.drc", ""), "atlas.drc"},
      {"PNG empty", text("coeff_0_02.png", ""), "coeff_0_02.png"},
      {"PNG no PNG", text("coeff_0_02.png", "GIF89a"), "coeff_0_02.png"},
      {"PNG truncated",
       [](json&, const fs::path& folder) {
         fs::resize_file(folder / "coeff_0_02.png", fs::file_size(folder / "coeff_0_02.png") / 2);
       },
       "coeff_0_02.png"},
      {"PNG in colour",
       [](json&, const fs::path& folder) { write_png(folder / "coeff_0_02.png", Image<std::uint8_t>(16, 8, 3)); },
       "3 channels"},
      {"mesh without uvs",
       [](json&, const fs::path& folder) { save_draco(folder / "atlas.drc", shapes::icosphere(0)); },
       "texture coordinates"},
      {"mesh without size",
       [](json&, const fs::path& folder) {
         TriangleMesh mesh = shapes::plane(1);
         for (Eigen::Vector3f& position : mesh.positions) position.setZero();
         save_draco(folder / "atlas.drc", mesh);
       },
       "atlas.drc"},
  };
  const Scratch scratch;
  const fs::path folder = scratch.folder() / "prt";
  for (const Case& test : cases) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    write_asset(folder, shapes::plane(2), noise_stack(16, 8, 2, 1, 8));
    ASSERT_NO_THROW(load_prt_asset(folder));
    json ranges = json::parse(read_text(folder / "ranges.json"));
    test.change(ranges, folder);
    std::ofstream(folder / "ranges.json") << ranges.dump();
    try {
      load_prt_asset(folder);
      ADD_FAILURE() << test.name << ": not refused";
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(test.words), std::string::npos) << test.name << ": " << error.what();
    }
  }
  for (const char* content : {"", "[1, 2", "[]", "null", "{\"bands\": 1e999}"}) {
    std::ofstream(folder / "ranges.json") << content;
    EXPECT_THROW(load_prt_asset(folder), BadInput) << content;
  }
  fs::remove(folder / "ranges.json");
  EXPECT_THROW(load_prt_asset(folder), BadInput);
  EXPECT_THROW(load_prt_asset(folder / "atlas.drc"), BadInput);
}

// ---- relighting ----

TEST(Relight, FurnaceGivesTheAlbedo) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(8);
  const auto context = software_context();
  const std::array<float, 3> albedo = {0.8f, 0.5f, 0.1f};
  for (const int bits : {8, 16}) {
    write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 96, 64, 5, bits));
    const PrtAsset asset = load_prt_asset(scratch.folder());
    SceneView view = small_view(mesh, 20, 12, 2);
    view.look.albedo = albedo;
    const Image<float> picture = drawn(asset, constant_light(5, std::array<float, 3>{1, 1, 1}), view);
    // t_0 is the same everywhere: min = max, so that nothing is lost to quantisation. What remains is float32.
    double covered = 0;
    for (int j = 0; j < picture.height(); ++j)
      for (int i = 0; i < picture.width(); ++i)
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(picture.at(i, j, c), albedo[c] * picture.at(i, j, 3), 1e-6) << i << ", " << j;
          covered += picture.at(i, j, 3) / 3;
        }
    // The sphere's outline is a circle about the view's axis; the facets (11 degrees each) cut a little of it.
    const double radius = std::tan(std::asin(1 / view.camera.position.norm()));
    const double share = M_PI * radius * radius / (4 * view.camera.half_width * view.camera.half_height);
    EXPECT_NEAR(covered / (160 * 120), share, 0.02 * share);
  }
}

TEST(Relight, DirectionalLightIsTheTruncatedCosine) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(48);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 384, 256, 5, 16));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const SceneView view = small_view(mesh, -35, 25);
  const Eigen::Vector3f towards = direction_from_angles(-70, 40);
  const Image<float> picture =
      drawn(asset, light_coefficients(std::vector<LightSpec>{parse_light_spec("-70,40")}, 5, LightWindow::none), view);
  int compared = 0;
  for (int j = 0; j < view.height; ++j)
    for (int i = 0; i < view.width; ++i) {
      const Eigen::Vector3f ray = view.camera.pixel_direction(i, j, view.width, view.height),
                            from = view.camera.position;
      const float half_b = from.dot(ray), determinant = half_b * half_b - from.squaredNorm() + 1;
      if (determinant < 0.05f) {
        // Outside, or at the silhouette, where facets and normals part.
        if (determinant < -0.01f) {
          ASSERT_EQ(picture.at(i, j, 3), 0) << i << ", " << j;
        }
        continue;
      }
      const Eigen::Vector3f normal = from - (half_b + std::sqrt(determinant)) * ray;
      // [Ramamoorthi 2001]: sum of A_l (2l+1)/(4 pi) P_l with A = pi, 2 pi/3, pi/4, 0, -pi/24; over what
      // faces the light, which then has radiance 1.
      constexpr double facing = 0.25 + 0.5 + 5.0 / 16 - 3.0 / 32;
      const double x = normal.dot(towards);
      const double legendre2 = (3 * x * x - 1) / 2, legendre4 = (35 * x * x * x * x - 30 * x * x + 3) / 8;
      const double expected = 0.8 * (0.25 + 0.5 * x + 5.0 / 16 * legendre2 - 3.0 / 32 * legendre4) / facing;
      ASSERT_EQ(picture.at(i, j, 3), 1);
      // A facet spans 0.04 radians, so that its middle lies 2e-4 too deep, which at a slant of 1:4 shifts the point by
      // 1e-3; the slope of the cosine is about 1. At the charts' borders (the cube's edges) half of a lookup is gutter,
      // which repeats a texel of 0.016 radians. A flipped axis would be off by up to 0.8.
      Eigen::Vector3f sides = normal.cwiseAbs();
      std::sort(sides.begin(), sides.end());
      const bool at_border = sides[1] > 0.96f * sides[2];
      ASSERT_NEAR(picture.at(i, j, 0), expected, at_border ? 8e-3 : 1.5e-3) << i << ", " << j;
      ++compared;
    }
  EXPECT_GT(compared, 2000);
}

TEST(Relight, GpuAndCpuAgree) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::plane(1);
  const auto context = software_context();
  const std::array<float, 3> albedo = {1, 0.6f, 0.3f};
  const std::vector<LightSpec> lights = {parse_light_spec("30,50,1,0.5,0.2"), parse_light_spec("-120,10,0,0.5,1"),
                                         parse_light_spec("ambient:0.3")};
  // 9 and 27 planes leave a layer of four partly empty, 16 and 48 do not.
  for (const int bands : {3, 4})
    for (const int bits : {8, 16})
      for (const int channels : {1, 3}) {
        write_asset(scratch.folder(), mesh, noise_stack(24, 20, bands, channels, bits));
        const PrtAsset asset = load_prt_asset(scratch.folder());
        SceneView view = small_view(asset.mesh, 10, 60);
        view.look.albedo = albedo;
        const LightCoefficients light = light_coefficients(lights, bands, LightWindow::hann);
        const Image<float> gpu = drawn(asset, light, view);
        const Image<float> cpu = relight_texels(asset, light, albedo);
        double largest = 0, brightest = 0;
        for (int j = 0; j < view.height; ++j)
          for (int i = 0; i < view.width; ++i) {
            const Eigen::Vector3f ray = view.camera.pixel_direction(i, j, view.width, view.height);
            const Eigen::Vector3f point = view.camera.position - view.camera.position.y() / ray.y() * ray;
            if (std::max(std::abs(point.x()), std::abs(point.z())) > 0.495f) continue;
            const float x = (0.1f + 0.8f * (point.x() + 0.5f)) * 24 - 0.5f,
                        y = (0.1f + 0.8f * (0.5f - point.z())) * 20 - 0.5f;
            const int column = static_cast<int>(x), row = static_cast<int>(y);
            const float s = x - static_cast<float>(column), t = y - static_cast<float>(row);
            for (int c = 0; c < 3; ++c) {
              const float expected = (1 - t) * ((1 - s) * cpu.at(column, row, c) + s * cpu.at(column + 1, row, c)) +
                                     t * ((1 - s) * cpu.at(column, row + 1, c) + s * cpu.at(column + 1, row + 1, c));
              largest = std::max<double>(largest, std::abs(expected - gpu.at(i, j, c)));
              brightest = std::max<double>(brightest, std::abs(expected));
            }
          }
        // A software renderer filters 8-bit textures in 8 bits, half a step off in each plane.
        EXPECT_LT(largest, (bits == 8 ? 0.01 : 1e-4) * brightest)
            << bands << " bands, " << bits << " bits, " << channels << " channels";
      }
}

TEST(Relight, ChannelsAreColors) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::plane(1);
  const LightCoefficients white = constant_light(2, std::array<float, 3>{1, 1, 1});
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 16, 16, 2, 8, {1, 0.5f, 0.25f}));
  const Image<float> colors = relight_texels(load_prt_asset(scratch.folder()), white, {1, 1, 1});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(colors.at(8, 8, c), std::pow(0.5, c), 1e-6);
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 16, 16, 2, 8, {1, 1, 1, 1}));
  EXPECT_THROW(relight_texels(load_prt_asset(scratch.folder()), white, {1, 1, 1}), BadInput);
}

TEST(Relight, TilesMakeOnePicture) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(8);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 3, 16));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const LightCoefficients light =
      light_coefficients(std::vector<LightSpec>{parse_light_spec("70,10")}, 3, LightWindow::hann);
  // The same samples in tiles of 2,045 and of 2,048 a side.
  SceneView view = small_view(mesh, 20, 12, 5);
  view.width = 600;
  view.height = 450;
  const Image<float> filtered = drawn(asset, light, view);
  view.width = 3000;
  view.height = 2250;
  view.supersample = 1;
  const Image<float> samples = drawn(asset, light, view);
  int different = 0;
  double covered = 0;
  for (int j = 0; j < filtered.height(); ++j)
    for (int i = 0; i < filtered.width(); ++i) {
      double radiance = 0, coverage = 0;
      for (int k = 0; k < 25; ++k) {
        radiance += samples.at(5 * i + k % 5, 5 * j + k / 5, 0) / 25;
        coverage += samples.at(5 * i + k % 5, 5 * j + k / 5, 3) / 25;
      }
      covered += coverage;
      different += std::abs(filtered.at(i, j, 3) - coverage) > 1e-5 || std::abs(filtered.at(i, j, 0) - radiance) > 1e-3;
    }
  EXPECT_GT(covered, 30000);
  // Rounding moves vertices by up to 1/256 sample, and so a sample at an edge now and then to the other side of it.
  EXPECT_LT(different, 100);
}

TEST(Relight, ManyPlanesGoThrough) {
  // 24 bands of three channels: 1,728 layers, of the 2,048 that every GL 4.5 device has.
  const Scratch scratch;
  const TriangleMesh mesh = shapes::plane(1);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, noise_stack(4, 4, 24, 3, 8));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  LightCoefficients light = constant_light(24, std::array<float, 3>{0, 0, 0});
  light.channels[2][575] = 1;  // the last plane of all
  SceneView view = small_view(asset.mesh, 0, 60);
  view.look.albedo = std::array{1.f, 1.f, 1.f};
  const Image<float> gpu = drawn(asset, light, view);
  const Image<float> cpu = relight_texels(asset, light, {1, 1, 1});
  const auto [low, high] = std::minmax_element(cpu.values().begin(), cpu.values().end());
  EXPECT_GT(*high, 0.01f);
  const std::span<const float> middle = gpu.pixel(80, 60);
  EXPECT_EQ(middle[0], 0);
  EXPECT_NE(middle[2], 0);
  EXPECT_GE(middle[2], *low);
  EXPECT_LE(middle[2], *high);
}

// ---- pictures ----

TEST(Picture, CurvesExposureAndBackground) {
  Image<float> radiance(2, 1, 4, 0.f);
  const std::array<float, 4> half_covered = {0.25f, 0.1f, -0.1f, 0.5f};  // radiance 0.5, 0.2, -0.2 times coverage
  std::copy(half_covered.begin(), half_covered.end(), radiance.pixel(1, 0).begin());
  PictureSettings settings;
  const Image<std::uint8_t> transparent = picture_from_radiance(radiance, settings);
  // sRGB of linear 0.5 is 0.7354, of 0.2 is 0.4845 (IEC 61966-2-1).
  EXPECT_EQ(std::vector<int>(transparent.pixel(1, 0).begin(), transparent.pixel(1, 0).end()),
            (std::vector<int>{188, 124, 0, 128}));
  EXPECT_EQ(transparent.at(0, 0, 3), 0);
  settings.tone = ToneCurve::linear;
  settings.exposure_stops = 1;
  EXPECT_EQ(picture_from_radiance(radiance, settings).at(1, 0, 1), 102);  // 2 * 0.2 * 255
  settings.background = {{0.2f, 0.4f, 1}};
  const Image<std::uint8_t> opaque = picture_from_radiance(radiance, settings);
  EXPECT_EQ(opaque.channels(), 3);
  EXPECT_EQ(opaque.at(0, 0, 1), 102);
  EXPECT_EQ(opaque.at(1, 0, 0), 153);  // (2 * 0.25 + 0.5 * 0.2) * 255
  EXPECT_EQ(opaque.at(1, 0, 2), 128);  // ringing below 0 takes nothing from the background
}

TEST(Picture, ExrKeepsTheRadiance) {
  const Scratch scratch;
  Image<float> radiance(3, 2, 4, 0.f);
  for (std::size_t k = 0; k < radiance.values().size(); ++k) radiance.values()[k] = 0.3f * static_cast<float>(k) - 1;
  PictureSettings settings;
  settings.exposure_stops = 3;
  write_picture(scratch.folder() / "radiance.exr", radiance, settings);
  EXPECT_EQ(read_float_image(scratch.folder() / "radiance.exr").values(), radiance.values());
  EXPECT_THROW(require_picture_name("picture.jpg"), WrongUsage);
}

TEST(RenderSettings, DefaultsAreTheCameras) {
  const TriangleMesh mesh = shapes::cube_sphere(2);
  const RenderSettings settings;
  const SceneView view = views_of(settings, mesh.positions).front();
  const Camera expected = make_camera(mesh.positions, CameraSettings{}, view.width, view.height);
  EXPECT_EQ(view.camera.position, expected.position);
  EXPECT_EQ(view.camera.half_height, expected.half_height);
}

TEST(RenderSettings, RefusesWhatIsNoView) {
  const std::vector<Eigen::Vector3f> shape = shapes::plane(1).positions;
  for (const char* camera : {"", "20", "20,91", "20,12,3", "a,b"}) {
    RenderSettings settings;
    settings.camera = camera;
    EXPECT_THROW(views_of(settings, shape), WrongUsage) << camera;
  }
  RenderSettings settings;
  settings.albedo = "1.5";
  EXPECT_THROW(views_of(settings, shape), WrongUsage);
  settings.background = "0.1,0.2";
  EXPECT_THROW(picture_of(settings), WrongUsage);
  LightSettings lights;
  EXPECT_EQ(light_specs(lights).size(), 1u);
  lights.ambient = "1";
  EXPECT_EQ(light_specs(lights).size(), 1u);
  lights.ambient = "much";
  EXPECT_THROW(light_specs(lights), WrongUsage);
}

TEST(RenderSettings, TurntableKeepsTargetAndDistanceAndShowsAll) {
  std::vector<Eigen::Vector3f> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back((k & 1) != 0 ? 4.f : 0.f, (k & 2) != 0 ? 1.f : 0.f, (k & 4) != 0 ? 2.f : 0.f);
  RenderSettings settings;
  settings.frames = 12;
  double most = 0;
  std::vector<SceneView> views = views_of(settings, corners);
  ASSERT_EQ(views.size(), 12u);
  const double distance = (views[0].camera.position.cast<double>() - views[0].camera.target).norm();
  for (const SceneView& view : views) {
    EXPECT_LT((view.camera.target - Eigen::Vector3d(2, 0.5, 1)).norm(), 1e-6);
    EXPECT_NEAR((view.camera.position.cast<double>() - view.camera.target).norm(), distance, 1e-5);
    for (const Eigen::Vector3f& vertex : corners) {
      const Eigen::Vector4f clip = view.camera.clip_from_object() * vertex.homogeneous();
      most = std::max<double>({most, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
    }
  }
  EXPECT_NEAR(most, 1 / 1.05, 1e-3) << "the frame that needs the most just fits";
  settings.framing.distance = "20";
  settings.framing.target = "1,0,0";
  for (const SceneView& view : views_of(settings, corners))
    EXPECT_NEAR((view.camera.position - Eigen::Vector3f(1, 0, 0)).norm(), 20, 1e-4);
}

}  // namespace test_relight
}  // namespace kiln
