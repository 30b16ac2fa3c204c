// SPDX-License-Identifier: GPL-3.0-or-later
// Light that is computed at every vertex of the low mesh, and interpolated over its triangles.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "base/errors.h"
#include "prt_folders.h"
#include "runtime/draw/scene_renderer.h"
#include "scratch.h"
#include "sh/light_spec.h"
#include "shapes.h"

namespace kiln {
namespace test_vertex_light {

using namespace test;

/// Makes an asset of noise, with an albedo and an opacity of a few texels.
PrtAsset noisy_asset(const Scratch& scratch, const TriangleMesh& mesh, int channels) {
  write_asset(scratch.folder(), mesh, noise_stack(48, 32, 3, channels, 16));
  PrtAsset asset = load_prt_asset(scratch.folder());
  asset.albedo.known = true;
  asset.albedo.picture = Image<std::uint8_t>(48, 32, 3);
  asset.opacity = Image<std::uint8_t>(48, 32, 1);
  std::mt19937 random(5);
  for (std::uint8_t& value : asset.albedo.picture.values()) value = static_cast<std::uint8_t>(random() % 256);
  for (std::uint8_t& value : asset.opacity.values()) value = static_cast<std::uint8_t>(random() % 256);
  return asset;
}

/// Makes a compressed asset of three clusters, whose neighbouring texels differ in theirs, out of a plain one.
PrtAsset clustered(PrtAsset asset) {
  PrtClusters clusters;
  clusters.count = 3;
  clusters.components = static_cast<int>(asset.planes.size());
  clusters.length = static_cast<int>(asset.vector_length());
  std::mt19937 random(9);
  std::uniform_real_distribution<float> value(-0.2f, 0.2f);
  clusters.vectors.resize(static_cast<std::size_t>(clusters.count * (clusters.components + 1) * clusters.length));
  for (float& number : clusters.vectors) number = value(random);
  clusters.ids = Image<std::uint8_t>(asset.width, asset.height, 1);
  for (std::uint8_t& id : clusters.ids.values()) id = static_cast<std::uint8_t>(random() % 3);
  asset.clusters = std::move(clusters);
  return asset;
}

Image<float> picture_of_light(const PrtAsset& asset, int samples, const AssetLight& light, const SceneView& view,
                              Technique technique) {
  AssetRenderer renderer(asset, samples);
  SceneAsset drawn{&renderer, {}, technique};
  drawn.light = renderer.upload_asset_light(light, view.look);
  return render_scene({drawn}, {}, view);
}

TEST(VertexLight, TheSameEverywhereIsTheOrdinaryPicture) {
  const Scratch scratch;
  const auto context = software_context();
  const TriangleMesh mesh = shapes::cube_sphere(6);
  for (const int channels : {1, 3}) {
    const PrtAsset plain = noisy_asset(scratch, mesh, channels), compressed = clustered(plain);
    const SceneView view = small_view(plain.mesh, 25, 20);
    AssetLight one;
    one.samples = {light_coefficients(std::vector{parse_light_spec("30,40,1,0.6,0.3")}, 3, LightWindow::hann)};
    AssetLight many;
    many.samples.assign(plain.mesh.positions.size(), one.samples.front());
    for (const PrtAsset* asset : {&plain, &compressed})
      for (const Technique technique : {natural_technique(*asset), Technique::vertex_prt}) {
        const Image<float> expected = picture_of_light(*asset, 1, one, view, technique);
        const Image<float> found = picture_of_light(*asset, samples_at_vertices, many, view, technique);
        double largest = 0, brightest = 0;
        std::size_t seen = 0;
        for (std::size_t k = 0; k < expected.values().size(); ++k) {
          largest = std::max<double>(largest, std::abs(expected.values()[k] - found.values()[k]));
          brightest = std::max<double>(brightest, std::abs(expected.values()[k]));
          if (k % 4 == 3 && expected.values()[k] > 0) ++seen;
        }
        EXPECT_GT(seen, 2000u) << technique_name(technique);
        EXPECT_GT(brightest, 0.05) << technique_name(technique);
        // Shares of a triangle's corners add up to 1 up to rounding.
        EXPECT_LT(largest, 1e-5 * brightest) << technique_name(technique) << ", " << channels << " channels";
      }
  }
}

TEST(VertexLight, ThatGrowsLinearlyIsInterpolated) {
  const Scratch scratch;
  const auto context = software_context();
  const TriangleMesh mesh = shapes::cube_sphere(8);
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 3, 16));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const SceneView view = small_view(asset.mesh, -35, 25);
  const LightCoefficients ambient = constant_light(3, std::array{1.f, 0.5f, 2.f});
  AssetLight one, many;
  one.samples = {ambient};
  const Eigen::Vector3f slope(0.4f, -0.2f, 0.1f);
  for (const Eigen::Vector3f& vertex : asset.mesh.positions)
    many.samples.push_back(scale_light(ambient, 1 + slope.dot(vertex)));
  const Image<float> even = picture_of_light(asset, 1, one, view, Technique::textured_prt);
  for (const Technique technique : {Technique::textured_prt, Technique::vertex_prt}) {
    const Image<float> found = picture_of_light(asset, samples_at_vertices, many, view, technique);
    int compared = 0;
    for (int j = 0; j < view.height; ++j)
      for (int i = 0; i < view.width; ++i) {
        const Eigen::Vector3f ray = view.camera.pixel_direction(i, j, view.width, view.height);
        const float half_b = view.camera.position.dot(ray),
                    determinant = half_b * half_b - view.camera.position.squaredNorm() + 1;
        if (determinant < 0.2f) continue;
        const Eigen::Vector3f point = view.camera.position - (half_b + std::sqrt(determinant)) * ray;
        ++compared;
        // Facets lie up to 0.02 within the sphere.
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(found.at(i, j, c) / even.at(i, j, c), 1 + slope.dot(point), 0.012) << i << ", " << j;
      }
    EXPECT_GT(compared, 2000);
  }
}

TEST(VertexLight, DeferredShadingRefusesIt) {
  const Scratch scratch;
  const auto context = software_context();
  const TriangleMesh mesh = shapes::cube_sphere(4);
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 2, 8));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  SceneView view = small_view(asset.mesh, 0, 0);
  view.shading = Shading::deferred;
  AssetRenderer renderer(asset, samples_at_vertices);
  EXPECT_THROW(render_scene({{&renderer, {}, Technique::textured_prt}}, {}, view), WrongUsage);
}

TEST(VertexLight, OneAssetAtTwoPlacesKeepsTheLightOfEach) {
  const Scratch scratch;
  const auto context = software_context();
  const TriangleMesh mesh = shapes::cube_sphere(6);
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 3, 16));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  for (const Shading shading : {Shading::forward, Shading::deferred}) {
    AssetRenderer renderer(asset);
    std::vector<SceneAsset> both(2, {&renderer, {}, Technique::textured_prt});
    both[0].placement.translation.x() = -1.2;
    both[1].placement.translation.x() = 1.2;
    SceneView view = small_view(asset.mesh, 0, 0);
    CameraSettings camera;
    camera.azimuth_degrees = camera.elevation_degrees = 0;
    view.camera = make_camera(scene_shape(both), camera, 160, 120);
    view.shading = shading;
    for (std::size_t k = 0; k < 2; ++k) {
      AssetLight light;
      light.samples = {constant_light(3, k == 0 ? std::array{1.f, 0.f, 0.f} : std::array{0.f, 0.f, 1.f})};
      both[k].light = renderer.upload_asset_light(light, view.look);
    }
    const Image<float> picture = render_scene(both, {}, view);
    EXPECT_NEAR(picture.at(43, 60, 0), 0.8, 0.02);
    EXPECT_NEAR(picture.at(43, 60, 2), 0, 0.001);
    EXPECT_NEAR(picture.at(116, 60, 0), 0, 0.001);
    EXPECT_NEAR(picture.at(116, 60, 2), 0.8, 0.02);
  }
}

}  // namespace test_vertex_light
}  // namespace kiln
