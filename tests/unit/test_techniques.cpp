// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/errors.h"
#include "base/files.h"
#include "image/image_file.h"
#include "lights/light_file.h"
#include "maps/detail_maps.h"
#include "mesh/tangent_space.h"
#include "prt_folders.h"
#include "render/output/contact_sheet.h"
#include "runtime/draw/scene_renderer.h"
#include "runtime/light/environment.h"
#include "scratch.h"
#include "sh/directions.h"
#include "sh/transfer.h"
#include "shapes.h"

namespace kiln {
namespace test_techniques {

namespace fs = std::filesystem;
using namespace test;

/// Visits the pixels that show the unit sphere well inside its outline, with the sphere's normal there.
template <class Visit>
void visit_sphere(const SceneView& view, Visit visit) {
  for (int j = 0; j < view.height; ++j)
    for (int i = 0; i < view.width; ++i) {
      const Eigen::Vector3f ray = view.camera.pixel_direction(i, j, view.width, view.height),
                            from = view.camera.position;
      const float half_b = from.dot(ray), determinant = half_b * half_b - from.squaredNorm() + 1;
      if (determinant > 0.1f) visit(i, j, Eigen::Vector3f(from - (half_b + std::sqrt(determinant)) * ray));
    }
}

/// Draws a picture of a sphere, of an asset written to `folder`.
Image<float> sphere_drawn(const PrtAsset& asset, Technique technique, const std::vector<std::string>& lights,
                          const SceneView& view) {
  AssetRenderer renderer(asset);
  SceneLights scene;
  for (const std::string& light : lights) scene.specs.push_back(parse_light_spec(light));
  scene.window = LightWindow::none;
  return render_scene({{&renderer, {}, technique}}, scene, view);
}

TEST(Technique, PhongIsLambertsCosineAndAHighlight) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(48);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 2, 8));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  SceneView view = small_view(mesh, -35, 25);
  view.look.albedo = std::array{0.8f, 0.5f, 0.1f};
  view.look.specular = 0.3f;
  view.look.shininess = 20;
  const Image<float> picture = sphere_drawn(asset, Technique::phong, {"-70,40", "ambient:0.25"}, view);
  const Eigen::Vector3f towards = direction_from_angles(-70, 40);
  visit_sphere(view, [&](int i, int j, const Eigen::Vector3f& normal) {
    const float cosine = normal.dot(towards);
    const Eigen::Vector3f mirrored = 2 * cosine * normal - towards,
                          to_eye = (view.camera.position - normal).normalized();
    const float highlight = cosine > 0 ? 0.3f * std::pow(std::max(0.f, mirrored.dot(to_eye)), 20.f) : 0.f;
    // Positions on facets lie up to 2e-4 too deep; where the light just grazes, the highlight starts with a jump.
    if (std::abs(cosine) < 0.01f) return;
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(picture.at(i, j, c), (*view.look.albedo)[c] * (std::max(0.f, cosine) + 0.25f) + highlight, 0.01)
          << i << ", " << j;
  });
}

TEST(Technique, PhongTakesBallsAtTheirPlace) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(48);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 2, 8));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  SceneView view = small_view(mesh, 30, 10);
  view.look.albedo = std::array{1.f, 1.f, 1.f};
  const Image<float> picture = sphere_drawn(asset, Technique::phong, {"sphere:1,2,2,0.1"}, view);
  const Eigen::Vector3f ball(1, 2, 2);
  visit_sphere(view, [&](int i, int j, const Eigen::Vector3f& normal) {
    const Eigen::Vector3f away = ball - normal;
    const float expected = std::max(0.f, normal.dot(away.normalized())) * 9 / away.squaredNorm();
    ASSERT_NEAR(picture.at(i, j, 0), expected, 0.01) << i << ", " << j;
  });
}

TEST(Technique, NormalMapsOfBothSpacesGiveTheHighMeshsNormals) {
  const Scratch scratch;
  const TriangleMesh fine = shapes::cube_sphere(48);
  const auto context = software_context();
  // The normals of a sphere tilted by a wave, in a map of either space.
  const auto wavy = [](const Eigen::Vector3f& place) {
    return (place + 0.3f * std::sin(6 * place.y()) * Eigen::Vector3f::UnitY()).normalized();
  };
  const int width = 384, height = 256;
  const TriangleMesh mesh = [&] {  // as it is read back: tangent frames are of what is in the file
    write_asset(scratch.folder(), fine, unoccluded_stack(fine, width, height, 2, 8));
    return load_prt_asset(scratch.folder()).mesh;
  }();
  const UvRaster raster = rasterise_uvs(mesh, width, height);
  Image<float> normals(width, height, 3);
  for (std::size_t k = 0; k < raster.texels.size(); ++k) {
    if (!raster.texels[k].covered()) continue;
    const Eigen::Vector3f normal = wavy(interpolate(mesh, mesh.positions, raster.texels[k]).normalized());
    for (int c = 0; c < 3; ++c) normals.values()[3 * k + static_cast<std::size_t>(c)] = normal[c];
  }
  const SceneView view = small_view(mesh, -35, 25);
  const Eigen::Vector3f towards = direction_from_angles(-70, 40);
  for (const NormalSpace space : {NormalSpace::object, NormalSpace::tangent}) {
    write_png(scratch.folder() / "normal.png", quantise_normals(normal_map(normals, space, mesh, raster)));
    nlohmann::json ranges = nlohmann::json::parse(read_text(scratch.folder() / "ranges.json"));
    if (space == NormalSpace::tangent) ranges["normal_space"] = "tangent";
    std::ofstream(scratch.folder() / "ranges.json") << ranges.dump();
    const PrtAsset asset = load_prt_asset(scratch.folder());
    EXPECT_EQ(asset.normal_space, space);
    const Image<float> picture = sphere_drawn(asset, Technique::normal_map, {"-70,40"}, view);
    double largest = 0;
    visit_sphere(view, [&](int i, int j, const Eigen::Vector3f& place) {
      const float expected = 0.8f * std::max(0.f, wavy(place).dot(towards));
      largest = std::max<double>(largest, std::abs(picture.at(i, j, 0) - expected));
    });
    // A texel is 0.025 radians wide, the wave bends the normal by up to 2 per radian: bilinear lookup loses the square
    // of that, the place on a facet at a slant 5e-3.
    EXPECT_LT(largest, 0.015);
  }
}

TEST(Technique, VertexPrtInterpolatesLitVertices) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(24);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 192, 128, 4, 16, {1, 0.5f, 0.25f}));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  SceneView view = small_view(mesh, -35, 25);
  const std::vector<std::string> lights = {"-70,40,1,0.8,0.6", "ambient:0.2"};
  const Image<float> vertices = sphere_drawn(asset, Technique::vertex_prt, lights, view);
  const Image<float> texels = sphere_drawn(asset, Technique::textured_prt, lights, view);
  double largest = 0;
  visit_sphere(view, [&](int i, int j, const Eigen::Vector3f&) {
    for (int c = 0; c < 3; ++c)
      largest = std::max<double>(largest, std::abs(vertices.at(i, j, c) - texels.at(i, j, c)));
  });
  // Vertices are 0.065 radians apart; linear between them loses an eighth of the square of that times the radiance's
  // second derivative, some 10 with 4 bands, and a texel's lookup about as much.
  EXPECT_LT(largest, 0.012);
  EXPECT_GT(largest, 0);
}

TEST(Technique, DeferredIsForwardOfSeveralAssets) {
  const Scratch scratch;
  const auto context = software_context();
  const TriangleMesh mesh = shapes::cube_sphere(8);
  fs::create_directories(scratch.folder() / "a");
  fs::create_directories(scratch.folder() / "b");
  write_asset(scratch.folder() / "a", mesh, unoccluded_stack(mesh, 48, 32, 3, 16));
  write_asset(scratch.folder() / "b", mesh, unoccluded_stack(mesh, 48, 32, 4, 16, {1, 0.4f, 0.2f}));
  const PrtAsset a = load_prt_asset(scratch.folder() / "a"), b = load_prt_asset(scratch.folder() / "b");
  AssetRenderer first(a, 1), second(b, 6);
  const std::vector<SceneAsset> assets = {
      {&first, {}, Technique::textured_prt},
      {&second, parse_placement("place", "0.9,0.2,0.4,30,0.7"), Technique::textured_prt}};
  const SceneLights lights{
      {parse_light_spec("20,30"), parse_light_spec("sphere:2,2,2,0.2")}, std::nullopt, LightWindow::hann};
  RenderSettings settings;
  settings.width = 160;
  settings.height = 120;
  SceneView view = views_of(settings, scene_shape(assets)).front();
  const Image<float> forward = render_scene(assets, lights, view);
  view.shading = Shading::deferred;
  const Image<float> deferred = render_scene(assets, lights, view);
  ASSERT_EQ(deferred.values().size(), forward.values().size());
  // Contributions are kept in 16-bit floats, of 11 bits, and some are below 0, so that parts cancel: each is off by
  // half a unit in the last place at most, and light at the points, which stand within the mesh, is about that of the
  // picture.
  const IncidentSamples samples = place_incident_samples(mesh, 6);
  double largest_sum = 0, brightest = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    double sum = 0;
    for (std::size_t k = 0; k < 6; ++k) sum += std::abs(samples.contributions[6 * v + k]);
    largest_sum = std::max(largest_sum, sum);
  }
  for (const float value : forward.values()) brightest = std::max(brightest, double{value});
  const double bound = std::ldexp(largest_sum * brightest, -11);
  for (std::size_t k = 0; k < forward.values().size(); ++k)
    ASSERT_LT(std::abs(double{deferred.values()[k]} - forward.values()[k]), bound);
  double sides[2] = {0, 0};  // both are in the picture
  for (int i = 0; i < 160; ++i) sides[i / 80] += forward.at(i, 60, 3);
  EXPECT_GT(std::min(sides[0], sides[1]), 10);

  EXPECT_THROW(render_scene({{&first, {}, Technique::vertex_prt}}, lights, view), WrongUsage);
}

TEST(Technique, RefusesWhatTheFolderHasNot) {
  const Scratch scratch;
  write_asset(scratch.folder(), shapes::plane(1), noise_stack(8, 8, 2, 1, 8));
  PrtAsset asset = load_prt_asset(scratch.folder());
  EXPECT_NO_THROW(require_technique(Technique::textured_prt, asset));
  EXPECT_THROW(require_technique(Technique::compressed, asset), WrongUsage);
  asset.normals_file.clear();
  EXPECT_THROW(require_technique(Technique::normal_map, asset), WrongUsage);
  asset.vertex_transfer = {1};
  EXPECT_EQ(natural_technique(asset), Technique::vertex_prt);
  EXPECT_THROW(require_technique(Technique::textured_prt, asset), WrongUsage);
}

TEST(Technique, MemoryCountsWhatIsUploaded) {
  const Scratch scratch;
  const auto context = software_context();
  write_asset(scratch.folder(), shapes::plane(1), noise_stack(64, 32, 5, 1, 8));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  AssetRenderer renderer(asset);
  for (const Technique technique : {Technique::phong, Technique::vertex_prt, Technique::textured_prt})
    renderer.prepare(technique);
  // 25 planes in 7 layers of 4 bytes; a vertex of Phong has a position and a normal, as in [Chapter 2010], table 6.2.
  EXPECT_EQ(renderer.memory(Technique::textured_prt).per_mesh, 64u * 32 * 7 * 4);
  EXPECT_EQ(renderer.memory(Technique::phong).per_vertex, 24u);
  EXPECT_EQ(renderer.memory(Technique::vertex_prt).per_vertex, 12u + 28 * 4);
}

TEST(Technique, TheAssetsOwnAlbedoIsInEvery) {
  // A sphere in a furnace of radiance 1, unshadowed: every technique shows the albedo itself.
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(8);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 3, 8));
  Image<std::uint8_t> map(48, 32, 3);
  for (std::size_t k = 0; k < map.values().size(); k += 3) {
    map.values()[k] = 255;
    map.values()[k + 1] = 188;  // 0.503 in linear light: IEC 61966-2-1
  }
  write_png(scratch.folder() / "albedo.png", map);
  write_png(scratch.folder() / "normal.png", Image<std::uint16_t>(48, 32, 3, 65535));
  nlohmann::json ranges = nlohmann::json::parse(read_text(scratch.folder() / "ranges.json"));
  ranges["albedo"] = "albedo.png";
  std::ofstream(scratch.folder() / "ranges.json") << ranges.dump();
  const PrtAsset asset = load_prt_asset(scratch.folder());
  SceneView view = small_view(mesh, 20, 12);
  for (const Technique technique :
       {Technique::phong, Technique::normal_map, Technique::vertex_prt, Technique::textured_prt})
    for (const Shading shading : {Shading::forward, Shading::deferred}) {
      if (shading == Shading::deferred && technique != Technique::textured_prt) continue;
      view.shading = shading;
      view.look = {};
      const Image<float> natural = sphere_drawn(asset, technique, {"ambient:1"}, view);
      view.look.albedo = std::array{0.5f, 0.5f, 0.5f};
      const Image<float> halved = sphere_drawn(asset, technique, {"ambient:1"}, view);
      view.look.own_albedo = false;
      const Image<float> grey = sphere_drawn(asset, technique, {"ambient:1"}, view);
      visit_sphere(view, [&](int i, int j, const Eigen::Vector3f&) {
        const float expected[3] = {1, 0.503f, 0};
        for (int c = 0; c < 3; ++c) {
          // Tables that decode sRGB in 8 bits, and harmonics of float32.
          ASSERT_NEAR(natural.at(i, j, c), expected[c], 2e-3) << technique_name(technique);
          ASSERT_NEAR(halved.at(i, j, c), 0.5f * expected[c], 1e-3) << technique_name(technique);
          ASSERT_NEAR(grey.at(i, j, c), 0.5f, 1e-3) << technique_name(technique);
        }
      });
    }
}

TEST(LightFile, ReadsWhatTheCommandLineTakes) {
  const Scratch scratch;
  const fs::path file = scratch.folder() / "lights.json";
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_light_file(file);
  };
  const LightSettings settings =
      read(R"({"lights": ["45,30", "sphere:1,2,3,0.1"], "ambient": 0.2, "window": "lanczos", "environment": "sky.hdr",
               "environment-rotation": 30})");
  EXPECT_EQ(settings.lights.size(), 2u);
  EXPECT_EQ(settings.ambient, "0.2");
  EXPECT_EQ(settings.window, LightWindow::lanczos);
  EXPECT_EQ(settings.environment, scratch.folder() / "sky.hdr");
  EXPECT_EQ(settings.environment_rotation_degrees, 30);
  for (const char* text :
       {"", "[]", R"({"lights": "45,30"})", R"({"lights": ["north"]})", R"({"lights": [1]})", R"({"sun": 1})",
        R"({"window": "square"})", R"({"ambient": "much"})", R"({"ambient": [1, 2]})", R"({"environment": 3})"})
    EXPECT_THROW(read(text), BadInput) << text;
}

TEST(Environment, CubeMapsAreLatitudeLongitudePictures) {
  const Scratch scratch;
  // Radiance 1 + x + 2 y - z in both forms.
  const auto radiance = [](const Eigen::Vector3d& s) { return static_cast<float>(4 + s.x() + 2 * s.y() - s.z()); };
  const Eigen::Vector3d axes[6][3] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                      {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};
  const char* names[6] = {"px", "nx", "py", "ny", "pz", "nz"};
  const int size = 32;
  for (int k = 0; k < 6; ++k) {
    Image<float> face(size, size, 3);
    for (int row = 0; row < size; ++row)  // from the top
      for (int i = 0; i < size; ++i) {
        const double s = 2 * (i + 0.5) / size - 1, t = 2 * (row + 0.5) / size - 1;
        const Eigen::Vector3d direction = (axes[k][0] + s * axes[k][1] + t * axes[k][2]).normalized();
        for (int c = 0; c < 3; ++c) face.at(i, size - 1 - row, c) = radiance(direction);
      }
    write_exr(scratch.folder() / (std::string(names[k]) + ".exr"), face);
  }
  for (const double turn : {0.0, 90.0}) {
    const LightCoefficients light = load_environment(scratch.folder(), 3, turn);
    // Light from azimuth a then comes from a + turn: +Z (azimuth 0) goes to +X.
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
      const Eigen::Vector3d before =
          turn == 0 ? direction : Eigen::Vector3d(-direction.z(), direction.y(), direction.x());
      EXPECT_NEAR(evaluate_at(light.channels[0], direction.cast<float>()), radiance(before), 0.01) << turn;
    }
  }
  fs::remove(scratch.folder() / "ny.exr");
  EXPECT_THROW(load_environment(scratch.folder(), 3, 0), BadInput);
  write_exr(scratch.folder() / "ny.exr", Image<float>(8, 8, 3));
  EXPECT_THROW(load_environment(scratch.folder(), 3, 0), BadInput);
}

TEST(ContactSheet, HoldsEveryPictureAndItsCaption) {
  Image<std::uint8_t> red(40, 30, 4, 0), green(40, 30, 3, 0);
  for (int j = 0; j < 30; ++j)
    for (int i = 0; i < 40; ++i) {
      red.at(i, j, 0) = red.at(i, j, 3) = 255;
      green.at(i, j, 1) = 255;
    }
  const Image<std::uint8_t> bare = contact_sheet({{red, {""}}, {green, {""}}}),
                            captioned = contact_sheet({{red, {"Red"}}, {green, {""}}});
  int reds = 0, greens = 0, text = 0;
  for (int j = 0; j < bare.height(); ++j)
    for (int i = 0; i < bare.width(); ++i) {
      reds += bare.at(i, j, 0) == 255 && bare.at(i, j, 1) == 0;
      greens += bare.at(i, j, 1) == 255 && bare.at(i, j, 0) == 0;
      text += bare.at(i, j, 2) != captioned.at(i, j, 2);
    }
  EXPECT_EQ(reds, 40 * 30);
  EXPECT_EQ(greens, 40 * 30);
  EXPECT_GT(text, 20);  // pixels of three letters
}

}  // namespace test_techniques
}  // namespace kiln
