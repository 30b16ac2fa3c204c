// SPDX-License-Identifier: GPL-3.0-or-later
// Baked assets under shaders of one's own: their light and their maps.
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "image/image_file.h"
#include "prt_folders.h"
#include "runtime/draw/scene_renderer.h"
#include "runtime/play/moving_scene.h"
#include "scratch.h"
#include "sh/directions.h"
#include "shading_stand.h"

namespace kiln {
namespace test_shaded_assets {

using namespace shading_stand;

/// Writes a normal map that is the same everywhere.
void write_normal_map(const std::filesystem::path& file, const Eigen::Vector3f& normal) {
  Image<std::uint16_t> map(5, 3, 3);
  for (std::size_t k = 0; k < map.values().size(); ++k)
    map.values()[k] = static_cast<std::uint16_t>(std::lround(65535 * (0.5f + 0.5f * normal[static_cast<int>(k % 3)])));
  write_png(file, map);
}

const std::string nothing_before = "void before_light(Surface surface, inout Appearance appearance) {}\n";

TEST(Shading, TransferIsTheLightOfNodesThatHaveIt) {
  const EglContext context("software");
  const Scratch scratch;
  const TriangleMesh fine = shapes::cube_sphere(24, 0.5f);
  test::write_asset(scratch.folder(), fine, test::unoccluded_stack(fine, 96, 64, 3, 16));
  write_normal_map(scratch / "normal.png", {0, 0, 1});
  const PrtAsset asset = load_prt_asset(scratch.folder());
  // Two of the asset, one turned, beside a mesh without planes, which gets the same light as irradiance.
  ShadedScene scene;
  scene.meshes = {{&asset.mesh, &asset}, {&fine, nullptr}};
  scene.materials = {{"light", {}}};
  for (int k = 0; k < 3; ++k) {
    ShadedNode node{k == 2 ? 1 : 0, 0, {}};
    node.placement.translation = Eigen::Vector3d(1.4 * k - 1.4, 0, 0);
    node.placement.rotation = Eigen::AngleAxisd(1.1 * k, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    scene.nodes.push_back(node);
  }
  scene.lights.specs = {parse_light_spec("hemisphere:70,40,0.9,0.8,0.7,0.1,0.2,0.3")};
  const std::string text =
      "void before_light(Surface surface, inout Appearance appearance) {}\n"
      "vec3 after_light(Surface surface, Appearance appearance, Light light) { return light.diffuse; }\n";
  std::vector<Eigen::Vector3f> shape;
  for (const ShadedNode& node : scene.nodes)
    for (const Eigen::Vector3f& place : fine.positions)
      shape.push_back(node.placement.to_scene(place.cast<double>()).cast<float>());
  const Camera camera = make_camera(shape, {}, 240, 80);
  const Eigen::Vector3f front = direction_from_angles(70, 40);
  for (const ShadingWay way : {ShadingWay::factored, ShadingWay::forward}) {
    ShadingSettings settings;
    settings.way = way;
    settings.samples = 1;
    ShadedRenderer renderer(scene, {parse_shader(text, "light.glsl")}, settings);
    const Image<float> picture = shaded_picture(renderer, camera, 240, 80);
    int seen[3] = {0, 0, 0};
    for (int j = 0; j < 80; ++j)
      for (int i = 0; i < 240; ++i)
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector3f ray = camera.pixel_direction(i, j, 240, 80),
                                to = scene.nodes[static_cast<std::size_t>(k)].placement.translation.cast<float>() -
                                     camera.position;
          const float along = to.dot(ray.normalized()), squared = to.squaredNorm() - along * along;
          if (squared > 0.8f * 0.25f) continue;
          const Eigen::Vector3f normal = ((along - std::sqrt(0.25f - squared)) * ray.normalized() - to).normalized();
          // A hemisphere has two bands (hemisphere_light): the mean, and half the difference times the cosine, of which
          // a white surface keeps 2/3.
          for (int c = 0; c < 3; ++c) {
            const float high = 0.9f - 0.1f * static_cast<float>(c), low = 0.1f + 0.1f * static_cast<float>(c);
            const float expected = 0.5f * (high + low) + (high - low) * normal.dot(front) / 3;
            ASSERT_NEAR(picture.at(i, j, c), expected, 0.01) << k << ": " << i << ", " << j;
          }
          ++seen[k];
        }
    for (const int count : seen) EXPECT_GT(count, 500);
  }
}

TEST(Shading, LightVectorsOfNodesThatMoveAreThoseOfPicturesByTransfer) {
  const EglContext context("software");
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(8, 0.5f);
  test::write_asset(scratch.folder(), mesh, test::unoccluded_stack(mesh, 48, 32, 4, 8));
  write_normal_map(scratch / "normal.png", {0, 0, 1});
  const PrtAsset asset = load_prt_asset(scratch.folder());
  // A small ball passes between a large one and its light.
  SceneDescription description;
  description.assets = {"ball"};
  for (const char* name : {"large", "small"}) {
    SceneItem item;
    item.name = name;
    item.asset = 0;
    description.items.push_back(item);
  }
  description.items[1].rest = {Eigen::Matrix3d::Identity(), 0.4, {0.6, 0.7, 0.3}};
  description.lights.push_back({parse_light_spec("cone:40,50,8,1,0.9,0.7"), {}});
  description.lights.push_back({parse_light_spec("hemisphere:0,90,0.3,0.4,0.5,0.1,0.1,0.1"), {}});
  ShadedScene scene;
  scene.meshes = {{&asset.mesh, &asset}};
  scene.materials = {{"white", {}}};
  scene.nodes.resize(2);
  const std::vector<SurfaceShader> shaders = {
      parse_shader(nothing_before + "vec3 after_light(Surface surface, Appearance appearance, Light light) {\n"
                                    "  return asset_albedo(surface) * light.diffuse;\n}\n",
                   "white.glsl")};
  SceneView view;
  view.width = 120;
  view.height = 90;
  view.supersample = 1;  // in the middle of the pixel, as one sample of the shaded picture
  for (const int samples : {1, 3, samples_at_vertices}) {
    MovingScene moving(description, {&asset}, {{.directions = 128}, samples});
    std::vector<NodeLight> light;
    AssetRenderer renderer(asset, samples);
    std::vector<SceneAsset> assets;
    for (int item = 0; item < 2; ++item) {
      const AssetLight at_node = moving.light(item);
      light.push_back(at_node.samples);
      scene.nodes[static_cast<std::size_t>(item)].placement = moving.pose(item);
      assets.push_back({&renderer, moving.pose(item)});
      assets.back().light = renderer.upload_asset_light(at_node, {});
    }
    scene.lights = moving.lights();
    view.camera = make_camera(scene_shape(assets), {}, view.width, view.height);
    const Image<float> expected = render_scene(assets, moving.lights(), view);
    for (const ShadingWay way : {ShadingWay::factored, ShadingWay::forward}) {
      ShadingSettings settings;
      settings.way = way;
      settings.samples = 1;
      settings.direct = DirectLightBy::transfer;
      settings.incident_samples = samples;
      settings.shadow_size = 64;
      ShadedRenderer shaded(scene, shaders, settings);
      shaded.set_node_light(light);
      // The same sums in another order. Places come from depths there, and from them shares of corners: to 1e-5 of
      // them.
      EXPECT_LE(largest_difference(shaded_picture(shaded, view.camera, view.width, view.height), expected), 0.02)
          << samples;
      EXPECT_THROW(shaded.set_node_light({light[0], {}}), std::invalid_argument);
      // Without what others shadow it is another picture.
      shaded.set_node_light({});
      EXPECT_GT(largest_difference(shaded_picture(shaded, view.camera, view.width, view.height), expected), 10);
    }
  }
}

TEST(Shading, MapsOfAssetsAreThereForShaders) {
  const EglContext context("software");
  const TriangleMesh mesh = shapes::cube_sphere(8, 0.5f);
  const Scratch scratch;
  std::vector<PrtAsset> assets;
  for (const char* name : {"first", "second"}) {
    const std::filesystem::path folder = scratch / name;
    std::filesystem::create_directory(folder);
    test::write_asset(folder, mesh, test::unoccluded_stack(mesh, 24, 16, 2, 8));
    write_normal_map(folder / "normal.png", assets.empty() ? Eigen::Vector3f(0, 0.6f, 0.8f) : Eigen::Vector3f(1, 0, 0));
    assets.push_back(load_prt_asset(folder));
  }
  // Pictures of different sizes share an array. The left half is red in the first and green in the second, which is
  // clear in the upper half.
  for (int k = 0; k < 2; ++k) {
    Image<std::uint8_t> picture(k == 0 ? 8 : 32, k == 0 ? 4 : 48, 3);
    for (int j = 0; j < picture.height(); ++j)
      for (int i = 0; i < picture.width(); ++i) picture.at(i, j, (i < picture.width() / 2) == (k == 0) ? 0 : 1) = 255;
    assets[static_cast<std::size_t>(k)].albedo = PrtAlbedo::of_picture("albedo.png");
    assets[static_cast<std::size_t>(k)].albedo.picture = picture;
  }
  assets[1].opacity = Image<std::uint8_t>(2, 16, 1, 255);
  for (int j = 8; j < 16; ++j)
    for (int i = 0; i < 2; ++i) assets[1].opacity.at(i, j) = 0;
  ShadedScene scene;
  scene.meshes = {{&assets[0].mesh, &assets[0]}, {&assets[1].mesh, &assets[1]}, {&mesh, nullptr}};
  scene.materials = {{"maps", {}}};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int k = 0; k < 3; ++k) scene.nodes.push_back({k, 0, {turn, 1 + 0.1 * k, {1.4 * k, 0, 0}}});
  scene.lights.specs = {parse_light_spec("0,90"), parse_light_spec("ambient:0.2")};
  CameraSettings settings;
  settings.target = Eigen::Vector3d(1.4, 0, 0);
  settings.azimuth_degrees = settings.elevation_degrees = 0;
  settings.distance = 3.5;
  const int width = 180, height = 60;
  const Camera camera = make_camera(std::vector<Eigen::Vector3f>{{-1, -1, -1}, {4, 1, 1}}, settings, width, height);
  const auto drawn = [&](ShadingWay way, const std::string& color) {
    ShadingSettings shading;
    shading.way = way;
    shading.samples = 1;
    const std::string after = "vec3 after_light(Surface surface, Appearance appearance, Light light) { return ";
    ShadedRenderer renderer(scene, {parse_shader(nothing_before + after + color + "; }\n", "maps.glsl")}, shading);
    return shaded_picture(renderer, camera, width, height);
  };
  const Image<float> uvs = drawn(ShadingWay::factored, "vec3(surface.uv, 0.0)");
  for (const ShadingWay way : {ShadingWay::factored, ShadingWay::forward}) {
    const Image<float> albedo = drawn(way, "asset_albedo(surface)"), normals = drawn(way, "surface.normal"),
                       kept = drawn(way, "vec3(dot(surface.mesh_normal, surface.mesh_normal), light.visibility, 0.0)");
    int seen[3] = {0, 0, 0};
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        if (albedo.at(i, j, 3) < 1) continue;
        const std::size_t k = i < 68 ? 0 : i < 112 ? 1 : 2;  // the balls are 45 pixels apart
        const float u = uvs.at(i, j, 0), v = uvs.at(i, j, 1);
        if (k == 1) {
          ASSERT_LT(v, 0.53f) << i << ", " << j;  // half a texel of the opacity's 16
        }
        if (k < 2 && std::abs(u - 0.5f) > 0.13f) {  // of the albedo's least, 8 texels
          const int channel = (u < 0.5f) == (k == 0) ? 0 : 1;
          ASSERT_NEAR(albedo.at(i, j, channel), 1, 1e-3f) << i << ", " << j;
          ASSERT_NEAR(albedo.at(i, j, 1 - channel), 0, 1e-3f) << i << ", " << j;
        }
        const Eigen::Vector3f normal(normals.at(i, j, 0), normals.at(i, j, 1), normals.at(i, j, 2));
        if (k < 2) {
          const Eigen::Vector3f stored = k == 0 ? Eigen::Vector3f(0, 0.6f, 0.8f) : Eigen::Vector3f(1, 0, 0);
          ASSERT_LT((normal - turn.cast<float>() * stored).norm(), 1e-3f) << i << ", " << j;
        } else {
          ASSERT_EQ(albedo.at(i, j, 2), 1) << i << ", " << j;  // a mesh without asset is white
          ASSERT_NEAR(normal.norm(), 1, 1e-4f);
        }
        ASSERT_NEAR(kept.at(i, j, 0), 1, 1e-3f);
        ++seen[k];
      }
    EXPECT_GT(seen[0], 300);
    EXPECT_GT(seen[1], 100);
    EXPECT_LT(seen[1], seen[2]);
    EXPECT_GT(seen[2], 300);
  }
}

}  // namespace test_shaded_assets
}  // namespace kiln
