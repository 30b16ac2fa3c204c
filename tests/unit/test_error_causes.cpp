// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

#include "asset/prt_asset.h"
#include "image/srgb.h"
#include "mesh/uv_raster.h"
#include "raycast/ray_scene.h"
#include "raycast/ray_transfer.h"
#include "report/bounce_paths.h"
#include "report/error_causes.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_prior.h"
#include "sh/ray_offset.h"
#include "spectrum/spectrum.h"

namespace kiln {
namespace {

constexpr int size = 64;
constexpr int bands = 4;

/// A floor of 2 x 2 with uvs, as low and high mesh, under a wall that shadows it, and what a bake makes of them.
struct Floor {
  TriangleMesh low, high;
  SceneMesh scene;
  DetailMaps detail;
  PrtAsset asset;
  std::vector<Eigen::Vector3f> directions;

  /// `depth`: how far the high mesh lies beneath the low one.
  explicit Floor(int direction_count = 1024, int bits = 16, float depth = 0) {
    low.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    low.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    low.normals.assign(4, Eigen::Vector3f::UnitY());
    low.triangles = {{0, 1, 2}, {0, 2, 3}};
    high = low;
    for (Eigen::Vector3f& p : high.positions) p.y() = -depth;
    TriangleMesh wall;
    wall.positions = {{-0.5f, 0.2f, -0.5f}, {0.5f, 0.2f, -0.5f}, {0.5f, 1, -0.5f}, {-0.5f, 1, -0.5f}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
    scene.add(high);
    scene.add(wall);
    const UvRaster raster = rasterise_uvs(low, size, size);
    detail.width = detail.height = size;
    detail.covered = coverage_of(raster);
    detail.position = detail.normal_object = Image<float>(size, size, 3);
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const Eigen::Vector3f position = interpolate(low, low.positions, raster.at(i, j));
        for (int c = 0; c < 3; ++c) {
          detail.position.at(i, j, c) = c == 1 ? -depth : position[c];
          detail.normal_object.at(i, j, c) = c == 1 ? 1.f : 0.f;
        }
      }
    directions = sample_directions(Sampling::fibonacci, direction_count, 5);
    store(directions, bits);
  }

  /// Bakes the planes over some directions.
  void store(const std::vector<Eigen::Vector3f>& over, int bits) { store(over, bits, scene, detail, 1); }

  /// Bakes the planes at the points of `maps` under the shadows of `shadows`, times `factor`.
  void store(const std::vector<Eigen::Vector3f>& over, int bits, const SceneMesh& shadows, const DetailMaps& maps,
             float factor) {
    std::vector<Eigen::Vector3f> positions, normals(std::size_t{size} * size, Eigen::Vector3f::UnitY());
    for (int k = 0; k < size * size; ++k) {
      const auto p = maps.position.pixel(k % size, k / size);
      positions.emplace_back(p[0], p[1], p[2]);
    }
    const RayScene rays(shadows.mesh);
    TransferVectors transfer =
        transfer_by_rays(rays, {positions, normals}, over, bands, rounding_offset(shadows.mesh.positions));
    for (float& value : transfer.values) value *= factor;
    asset.bands = bands;
    asset.channels = 1;
    asset.bits = bits;
    asset.width = asset.height = size;
    asset.planes.clear();
    std::vector<Image<std::uint16_t>> wide;
    std::vector<Image<std::uint8_t>> narrow;
    for (int i = 0; i < transfer.coefficients; ++i) {
      const auto [least, most] = std::ranges::minmax(transfer.plane(i));
      PrtPlane plane;
      plane.coefficient = i;
      plane.bits = bits;
      plane.range = {least, most};
      Image<std::uint16_t> picture(size, size, 1);
      for (int k = 0; k < size * size; ++k)
        picture.values()[k] = static_cast<std::uint16_t>(plane.range.store(transfer.plane(i)[k], bits));
      asset.planes.push_back(plane);
      Image<std::uint8_t>& bytes = narrow.emplace_back(size, size, 1);
      std::ranges::transform(picture.values(), bytes.values().begin(),
                             [](std::uint16_t value) { return static_cast<std::uint8_t>(value); });
      wide.push_back(std::move(picture));
    }
    if (bits == 16)
      asset.pictures = std::move(wide);
    else
      asset.pictures = std::move(narrow);
  }

  SplitInput input(const PrtAsset* compressed = nullptr) const {
    return {.high = high,
            .low = low,
            .scene = scene,
            .asset = asset,
            .compressed = compressed,
            .detail = &detail,
            .bake_directions = directions};
  }

  /// Returns an input of fewer pixels, where those need not be many.
  SplitInput coarse_input() const {
    SplitInput coarse = input();
    coarse.sampling.pixels = 1000;
    return coarse;
  }

  ErrorSplit split(const PrtAsset* compressed = nullptr) const { return error_causes(input(compressed)); }
};

double cause(const ErrorSplit& split, const std::string& name) {
  const auto found = std::ranges::find(split.causes, name, &ErrorCause::name);
  EXPECT_NE(found, split.causes.end()) << name;
  return found == split.causes.end() ? -1 : found->error;
}

TEST(ErrorCauses, AreZeroWhereNothingDiffers) {
  const ErrorSplit split = Floor().split();
  EXPECT_GT(split.samples, 3000u);
  EXPECT_LT(cause(split, "geometry"), 1e-5);    // roundings of two ways to the same point
  EXPECT_LT(cause(split, "bits"), 2e-5);        // 16 bits
  EXPECT_LT(cause(split, "visibility"), 1e-6);  // what is stored was made by the same rays
  EXPECT_LT(cause(split, "seams"), 1e-6);
  EXPECT_GT(cause(split, "bands"), 0.01);
  EXPECT_GT(cause(split, "texels"), 1e-4);
}

TEST(ErrorCauses, OfWavelengthsAreMeasuredForEachOfThem) {
  // Four wavelengths bounce off the wall, which reflects each otherwise: as they are stored, and two of them exchanged.
  Floor floor(256);
  const std::vector<int> wavelengths = {450, 520, 580, 650};
  const std::vector<float> reflected = {0.1f, 0.3f, 0.6f, 0.9f};
  Spectrum wall = Spectrum::Constant(wavelength_count, 0.3);
  for (std::size_t k = 0; k < 4; ++k) wall(wavelengths[k] - first_wavelength_nm) = double{reflected[k]};
  floor.scene.albedos = {SurfaceAlbedo::constant(Eigen::Vector3f::Zero()), SurfaceAlbedo::measured({1, 1, 1}, wall)};
  std::vector<Eigen::Vector3f> positions, normals(std::size_t{size} * size, Eigen::Vector3f::UnitY());
  for (int k = 0; k < size * size; ++k)
    positions.push_back(Eigen::Map<const Eigen::Vector3f>(floor.detail.position.pixel(k % size, k / size).data()));
  const RayScene rays(floor.scene.mesh);
  const float offset = rounding_offset(floor.scene.mesh.positions);
  const TransferVectors direct = transfer_by_rays(rays, {positions, normals}, floor.directions, bands, offset);
  // The floor is black, so light bounces once: at a wavelength it is what a white wall sends, times its reflectance.
  SceneMesh white = floor.scene;
  white.albedos[1] = SurfaceAlbedo::constant(Eigen::Vector3f::Ones());
  std::vector<TransferVectors> bounced(3, TransferVectors(positions.size(), direct.coefficients));
  BouncePaths(rays, white, 1, offset)
      .add({positions, normals}, sample_directions(Sampling::fibonacci, 1024, 77), 0, bounced);
  const auto error_of = [&](const std::vector<float>& stored) {
    PrtAsset asset;
    asset.bands = bands;
    asset.channels = 4;
    asset.bits = 16;
    asset.width = asset.height = size;
    asset.spectrum.emplace().wavelengths_nm = wavelengths;
    std::vector<Image<std::uint16_t>> pictures;
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < direct.coefficients; ++i) {
        std::vector<float> values;
        for (std::size_t r = 0; r < positions.size(); ++r)
          values.push_back(direct.plane(i)[r] + stored[static_cast<std::size_t>(c)] * bounced[0].plane(i)[r]);
        PrtPlane& plane = asset.planes.emplace_back();
        plane.channel = c;
        plane.coefficient = i;
        plane.bits = 16;
        plane.range = range_of(values);
        Image<std::uint16_t>& picture = pictures.emplace_back(size, size, 1);
        std::ranges::transform(values, picture.values().begin(), [&](float value) {
          return static_cast<std::uint16_t>(plane.range.store(double{value}, 16));
        });
      }
    asset.pictures = std::move(pictures);
    SplitInput input = {.high = floor.high,
                        .low = floor.low,
                        .scene = floor.scene,
                        .asset = asset,
                        .detail = &floor.detail,
                        .bake_directions = floor.directions,
                        .bounces = 1};
    input.sampling.pixels = 512;
    return error_causes(input);
  };
  const ErrorSplit right = error_of(reflected), wrong = error_of({0.1f, 0.9f, 0.6f, 0.3f});
  EXPECT_LT(cause(right, "bounces"), 0.01) << "noise";
  EXPECT_GT(cause(wrong, "bounces"), 4 * cause(right, "bounces"));
  EXPECT_GT(cause(wrong, "bounces"), 0.02);
}

TEST(ErrorCauses, AddUpInSquares) {
  const ErrorSplit split = Floor(256, 8, 0.02f).split();
  EXPECT_NEAR(split.root_sum(), split.total, 0.1 * split.total);
}

TEST(ErrorCauses, DirectionsAreThoseOfTheBakeAlone) {
  const double few = cause(Floor(64).split(), "directions"), many = cause(Floor(4096).split(), "directions");
  EXPECT_GT(few, 5 * many);  // quadrature falls faster than the root of 64
}

TEST(ErrorCauses, BitsAreRoundingsOfEvenDistribution) {
  const Floor floor(1024, 8);
  const ErrorSplit split = floor.split();
  // A value rounded to steps has an error of step / sqrt(12), and a bilinear lookup of four keeps 4/9 of its square.
  double expected = 0, norm = 0;
  const std::vector<double> prior = lighting_prior(bands);
  std::vector<std::uint32_t> all(std::size_t{size} * size);
  std::iota(all.begin(), all.end(), 0u);
  std::vector<float> stored(all.size() * floor.asset.planes.size());
  decode_transfer(floor.asset, all, stored);
  for (std::size_t k = 0; k < stored.size(); ++k) {
    const std::size_t i = k % floor.asset.planes.size();
    const double weight = prior[static_cast<std::size_t>(band_of(static_cast<int>(i)))];
    const double step = floor.asset.planes[i].range.step(8);
    expected += weight * step * step / 12 * 4 / 9;
    norm += weight * stored[k] * stored[k];
  }
  EXPECT_NEAR(cause(split, "bits"), std::sqrt(expected / norm), 0.15 * std::sqrt(expected / norm));
}

TEST(ErrorCauses, GeometryIsWhereTheViewerSeesAnotherPoint) {
  const ErrorSplit split = Floor(1024, 16, 0.05f).split();
  EXPECT_GT(cause(split, "geometry"), 0.005);
  EXPECT_LT(cause(split, "visibility"), 1e-6);
}

TEST(ErrorCauses, WhatTheEngineDoesOtherwiseIsVisibility) {
  Floor floor;
  floor.store(sample_directions(Sampling::fibonacci, 1024, 77), 16);  // not the directions that the record names
  const ErrorSplit split = floor.split();
  EXPECT_GT(cause(split, "visibility"), 1e-4);
  EXPECT_LT(cause(split, "seams"), cause(split, "visibility")) << "the floor's border is a small part of it";
}

TEST(ErrorCauses, AreNoNumbersWhereNothingIsSeen) {
  Floor floor;
  for (Triangle& t : floor.high.triangles) std::swap(t[1], t[2]);  // the high mesh shows its back
  for (Eigen::Vector3f& normal : floor.high.normals) normal = -normal;
  const ErrorSplit split = floor.split();
  EXPECT_EQ(split.samples, 0u);
  EXPECT_TRUE(std::isnan(split.total));  // 0 would keep every budget
}

TEST(ErrorCauses, CompressionIsWhatCompressionChanges) {
  const Floor floor;
  PrtAsset changed = floor.asset;
  for (PrtPlane& plane : changed.planes) {
    plane.range.lowest *= 1.02;
    plane.range.highest *= 1.02;
  }
  const ErrorSplit split = floor.split(&changed);
  EXPECT_NEAR(cause(split, "compression"), 0.02, 0.001);  // everything is 2 % too long
}

TEST(ErrorCauses, OneColorWithinCancels) {
  Floor floor(256, 8, 0.02f);
  const ErrorSplit white = error_causes(floor.coarse_input());
  EXPECT_EQ(cause(white, "albedo"), 0);
  floor.store(floor.directions, 8, floor.scene, floor.detail, 0.4f);
  const SurfaceAlbedo grey = SurfaceAlbedo::constant(Eigen::Vector3f::Constant(0.4f));
  floor.detail.constant_albedo = Eigen::Vector3f::Constant(0.4f);
  SplitInput input = floor.coarse_input();
  input.albedo = &grey;
  input.albedo_within = true;
  const ErrorSplit split = error_causes(input);
  EXPECT_LT(cause(split, "albedo"), 1e-6);
  EXPECT_NEAR(split.total, white.total, 1e-3 * white.total);
  EXPECT_NEAR(cause(split, "bits"), cause(white, "bits"), 0.02 * cause(white, "bits"));
}

TEST(ErrorCauses, AlbedoWithinIsThatOfTheMaps) {
  Floor floor(256, 16);
  floor.store(floor.directions, 16, floor.scene, floor.detail, 0.44f);
  const SurfaceAlbedo grey = SurfaceAlbedo::constant(Eigen::Vector3f::Constant(0.4f));
  floor.detail.constant_albedo = Eigen::Vector3f::Constant(0.44f);  // a tenth too bright
  SplitInput input = floor.coarse_input();
  input.albedo = &grey;
  input.albedo_within = true;
  const ErrorSplit split = error_causes(input);
  EXPECT_NEAR(cause(split, "albedo"), 0.1, 0.006) << "of the points inside the chart, which are most";
  EXPECT_LT(cause(split, "visibility"), 1e-6);
  EXPECT_NEAR(split.root_sum(), split.total, 0.1 * split.total);
}

TEST(ErrorCauses, AlbedoInAMapIsLookedUpInColor) {
  Floor floor(256, 16);
  // Red falls from one side to the other, linearly: bytes of sRGB round it, and the lookup between them is exact.
  const float green = linear_from_srgb(188 / 255.f);  // a whole byte
  std::vector<Eigen::Vector3f> corners = {{0.9f, green, 0}, {0.1f, green, 0}, {0.1f, green, 0}, {0.9f, green, 0}};
  const SurfaceAlbedo albedo = SurfaceAlbedo::of_vertices(corners, floor.high.triangles);
  Image<float> picture(size, size, 3);
  for (int k = 0; k < size * size; ++k) {
    const float x = (static_cast<float>(k % size) + 0.5f) / size;
    picture.at(k % size, k / size, 0) = 0.9f - 0.8f * x;
    picture.at(k % size, k / size, 1) = green;
  }
  floor.asset.albedo = PrtAlbedo::of_picture("albedo.png");
  floor.asset.albedo.picture = srgb_bytes(picture);
  SplitInput input = floor.coarse_input();
  input.albedo = &albedo;
  const ErrorSplit exact = error_causes(input);
  EXPECT_LT(cause(exact, "albedo"), 0.004) << "a step of a byte is a hundredth of a dark red";

  for (float& value : picture.values()) value *= 0.9f;
  floor.asset.albedo.picture = srgb_bytes(picture);
  const ErrorSplit darker = error_causes(input);
  EXPECT_NEAR(cause(darker, "albedo"), 0.1, 0.003);
  EXPECT_NEAR(darker.root_sum(), darker.total, 0.1 * darker.total);
}

TEST(ErrorCauses, ReceiversAreWhatStandsOnTheLowMesh) {
  Floor floor(1024, 16, 0.05f);
  DetailMaps on_low = floor.detail;
  for (int k = 0; k < size * size; ++k) on_low.position.at(k % size, k / size, 1) = 0;
  const LowReceivers same{floor.scene, &floor.detail}, above{floor.scene, &on_low};
  SplitInput input = floor.coarse_input();
  const double without = error_causes(input).total;
  input.on_low = &same;
  const ErrorSplit none = error_causes(input);
  EXPECT_EQ(cause(none, "receivers"), 0);
  EXPECT_DOUBLE_EQ(none.total, without);

  floor.store(floor.directions, 16, floor.scene, on_low, 1);
  input.on_low = &above;
  const ErrorSplit split = error_causes(input);
  EXPECT_GT(cause(split, "receivers"), 0.005) << "the wall's foot is nearer";
  EXPECT_LT(cause(split, "visibility"), 1e-6);
  SceneMesh open;
  open.add(floor.low);
  floor.store(floor.directions, 16, open, on_low, 1);
  const LowReceivers unshadowed{open, &on_low};
  input.on_low = &unshadowed;
  const ErrorSplit lit = error_causes(input);
  EXPECT_GT(cause(lit, "receivers"), 3 * cause(split, "receivers")) << "no wall shadows them";
  EXPECT_LT(cause(lit, "visibility"), 1e-6);
}

TEST(ErrorCauses, LightBeneathTheSurfaceIsThatOfPaths) {
  // Light scatters less far than a texel, so the transfer is the reflectance of a plane times that of light that
  // arrives.
  const ScatterProfile profile = ScatterProfile::diffusion(0.6, 1);
  Floor floor(1024, 16);
  const auto reflectance = static_cast<float>(profile.total());
  SplitInput input = floor.coarse_input();
  input.scattering = {profile};
  input.sampling.pixels = 2048;  // a quarter of them is taken
  floor.store(floor.directions, 16, floor.scene, floor.detail, reflectance);
  const ErrorSplit exact = error_causes(input);
  EXPECT_LT(cause(exact, "subsurface"), 0.02) << "what is left is noise";
  EXPECT_LT(cause(exact, "bits"), 2e-5);
  floor.store(floor.directions, 16, floor.scene, floor.detail, 1.2f * reflectance);
  const ErrorSplit brighter = error_causes(input);
  EXPECT_NEAR(cause(brighter, "subsurface"), 0.2, 0.02);
  EXPECT_NEAR(brighter.root_sum(), brighter.total, 0.1 * brighter.total);
}

/// Bakes a floor of so many vertices along a side under the wall of Floor, and splits its error.
ErrorSplit split_of_vertices(int side) {
  Floor floor(1024, 16);
  TriangleMesh grid;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      grid.positions.emplace_back(-1 + 2.f * static_cast<float>(i) / static_cast<float>(side - 1), 0.f,
                                  1 - 2.f * static_cast<float>(j) / static_cast<float>(side - 1));
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * side + i); };
  for (int j = 0; j + 1 < side; ++j)
    for (int i = 0; i + 1 < side; ++i) {
      grid.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      grid.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  grid.normals.assign(grid.positions.size(), Eigen::Vector3f::UnitY());
  const TransferVectors transfer =
      transfer_by_rays(RayScene(floor.scene.mesh), {grid.positions, grid.normals}, floor.directions, bands,
                       rounding_offset(floor.scene.mesh.positions));
  PrtAsset asset;
  asset.bands = bands;
  asset.channels = 1;
  asset.bits = 16;
  asset.vertices = side * side;
  asset.vertex_transfer.resize(transfer.values.size());
  for (int i = 0; i < transfer.coefficients; ++i) {
    const auto [least, most] = std::ranges::minmax(transfer.plane(i));
    PrtPlane plane;
    plane.coefficient = i;
    plane.bits = 16;
    plane.range = {least, most};
    asset.planes.push_back(plane);
    for (std::size_t r = 0; r < transfer.receivers; ++r)
      asset.vertex_transfer[r * static_cast<std::size_t>(transfer.coefficients) + static_cast<std::size_t>(i)] =
          transfer.plane(i)[r];
  }
  return error_causes({.high = floor.high,
                       .low = grid,
                       .scene = floor.scene,
                       .asset = asset,
                       .bake_directions = floor.directions,
                       .sampling = {.pixels = 1000}});
}

TEST(ErrorCauses, VerticesAreLookedUpInPlaceOfTexels) {
  const ErrorSplit coarse = split_of_vertices(9), fine = split_of_vertices(33);
  EXPECT_LT(cause(coarse, "visibility"), 2e-5) << "what is stored was made by the same rays, not rounded";
  EXPECT_EQ(cause(coarse, "seams"), 0);
  EXPECT_GT(cause(coarse, "vertices"), 2 * cause(fine, "vertices"));
  EXPECT_NEAR(coarse.root_sum(), coarse.total, 0.1 * coarse.total);
}

/// Returns a floor of 2 x 2 under a plate of so many across, with uvs.
TriangleMesh floor_under_plate(float plate) {
  TriangleMesh mesh;
  const float half = plate / 2;
  mesh.positions = {{-1, 0, 1},          {1, 0, 1},          {1, 0, -1},          {-1, 0, -1},
                    {-half, 0.5f, half}, {half, 0.5f, half}, {half, 0.5f, -half}, {-half, 0.5f, -half}};
  mesh.uvs = {{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}, {0.6f, 0.6f}, {1, 0.6f}, {1, 1}, {0.6f, 1}};
  mesh.normals.assign(8, Eigen::Vector3f::UnitY());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return mesh;
}

TEST(ErrorSamples, ShowOutlinesAsOftenAsAViewerSeesThem) {
  const TriangleMesh low = floor_under_plate(0.5f), high = floor_under_plate(0.51f);
  DetailMaps detail;
  detail.width = detail.height = size;
  detail.covered.assign(std::size_t{size} * size, 1);
  const ErrorSamples samples = make_error_samples(high, low, &detail, {.pixels = 2000});
  double outline = 0, all = 0;
  int found = 0;
  for (std::size_t k = 0; k < samples.pixels(); ++k) {
    const bool apart = samples.seen_positions[k].y() > 0.25f && samples.stood_positions[k].y() < 0.25f;
    (apart ? outline : all) += samples.pixel_weights[k];
    found += apart ? 1 : 0;
  }
  all += outline;

  // Counts views that leave the floor beside the low plate and meet the high one's rim, among all that meet no plate.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  double rim = 0, seen = 0;
  for (int k = 0; k < 400000; ++k) {
    const bool on_plate = (number(random) + 1) / 2 < 0.25 / 4.25;
    const double reach = on_plate ? 0.25 : 1, x = reach * number(random), z = reach * number(random);
    double across = number(random), along = number(random);
    while (across * across + along * along >= 1) across = number(random), along = number(random);
    const double up = std::sqrt(1 - across * across - along * along);  // a disc's points lifted: by the cosine
    const double px = x + 0.5 * across / up, pz = z + 0.5 * along / up, distance = std::max(std::abs(px), std::abs(pz));
    if (!on_plate && distance < 0.25) continue;
    seen += 1;
    if (!on_plate && distance < 0.255) rim += 1;
  }
  EXPECT_NEAR(outline / all, rim / seen, 0.2 * rim / seen) << "some 60 of them were found";
  EXPECT_GT(found, 5 * 2000 * rim / seen);
}

}  // namespace
}  // namespace kiln
