// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the picture that assets are compared with: points, paths and the difference of pictures.
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>

#include "mesh/surface_point.h"
#include "raycast/ray_scene.h"
#include "report/bounce_paths.h"
#include "report/direct_light.h"
#include "report/picture_difference.h"
#include "report/reference.h"
#include "report/scatter_paths.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_spec.h"
#include "sh/transfer.h"
#include "shapes.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/standards.h"

namespace kiln {
namespace test_reference {

/// Makes a unit sphere with exact normals, of `rings` by 2 * `rings` cells.
TriangleMesh sphere(int rings) {
  TriangleMesh mesh;
  const int columns = 2 * rings;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < columns; ++i) {
      const double polar = std::numbers::pi * j / rings, azimuth = 2 * std::numbers::pi * i / columns;
      mesh.positions.emplace_back(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                  -std::sin(polar) * std::sin(azimuth));
    }
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto at = [&](int row, int column) { return static_cast<std::uint32_t>(row * columns + column % columns); };
      if (j > 0) mesh.triangles.push_back({at(j, i), at(j + 1, i), at(j, i + 1)});
      if (j + 1 < rings) mesh.triangles.push_back({at(j, i + 1), at(j + 1, i), at(j + 1, i + 1)});
    }
  mesh.normals = mesh.positions;
  return mesh;
}

TEST(Reference, SphereInAFurnaceHasItsAlbedo) {
  const TriangleMesh mesh = sphere(64);
  ReferenceView view;
  view.width = view.height = 24;
  view.camera = make_camera(mesh.positions, {}, view.width, view.height);
  view.albedo = 0.6f;
  view.bands = 3;
  const LightSpec lights[] = {{.kind = LightSpec::Kind::ambient}};
  const ReferenceRays rays{.directions = 2 * 2048};
  const std::vector<ReferencePicture> pictures = reference_pictures(mesh, view, lights, rays);
  const Image<float> in_bands = mean_of(pictures[0].in_bands);
  int whole = 0;
  for (int j = 0; j < view.height; ++j)
    for (int i = 0; i < view.width; ++i) {
      if (in_bands.at(i, j, 3) < 0.9999f) continue;
      ++whole;
      // Exact but for the quadrature (2,048 directions: far below 1 %) and for facets that lie inside the sphere.
      EXPECT_NEAR(in_bands.at(i, j, 1), 0.6, 0.01);
    }
  EXPECT_GT(whole, 100);
  EXPECT_EQ(in_bands.at(0, 0, 3), 0);
  EXPECT_EQ(mean_of(pictures[0].in_full).values(), in_bands.values()) << "bands hold all of a furnace";
}

TEST(Reference, LightNearTheMeshIsThatOfEveryPoint) {
  const TriangleMesh mesh = sphere(64);
  ReferenceView view;
  view.width = view.height = 24;
  view.supersample = 1;
  view.camera = make_camera(mesh.positions, {}, view.width, view.height);
  view.albedo = 1;
  const LightSpec ball = parse_light_spec("sphere:0.5,1,2,0.1");
  const ReferenceRays rays{.directions = 2 * 2048};
  const Image<float> picture = mean_of(reference_pictures(mesh, view, std::span(&ball, 1), rays).front().in_bands);
  const RayScene scene(mesh);
  const ShBasis basis(5);
  double nearest = 0, largest = 0;
  for (int j = 0; j < view.height; ++j)
    for (int i = 0; i < view.width; ++i) {
      if (picture.at(i, j, 3) < 0.9999f) continue;
      const Eigen::Vector3f direction = view.camera.pixel_direction(i, j, view.width, view.height);
      const Eigen::Vector3f point =
          view.camera.position + scene.first_hit(view.camera.position, direction, 0, 100).distance * direction;
      const LightCoefficients light = windowed_light(ball, 5, LightWindow::hann, point.cast<double>());
      const double expected = dot_product(unoccluded_transfer(basis, point.normalized()), light.channels[0]);
      largest = std::max(largest, std::abs(picture.at(i, j, 0) - expected));
      nearest = std::max(nearest, expected);
    }
  // Quadrature of 2,048 directions, and facets that shade a little what the light just grazes.
  EXPECT_LT(largest, 0.02 * nearest);
  EXPECT_GT(nearest, 2);  // the near side has more than the origin would
}

TEST(DirectLight, IsThatOfItsFormWhereNothingShadows) {
  // Receivers in free space, the light at all angles to them.
  const TriangleMesh far_away = shapes::icosphere(0);
  std::vector<Eigen::Vector3f> shifted = far_away.positions;
  for (Eigen::Vector3f& p : shifted) p += Eigen::Vector3f(1000, 0, 0);
  const RayScene scene(shifted, far_away.triangles);
  const std::vector<Eigen::Vector3f> normals = sample_directions(Sampling::fibonacci, 512, 3);
  const std::vector<Eigen::Vector3f> positions(normals.size(), Eigen::Vector3f::Zero());
  for (const char* text : {"30,40", "cone:30,40,25", "cone:-120,-5,60", "sphere:1,2,-1,0.8"}) {
    const LightSpec light = parse_light_spec(text);
    const auto radiance = direct_radiance(scene, {positions, normals}, light, 0, 0);
    // Irradiance in spherical harmonics: 40 bands, of which those beyond two are exact to (l)^-2.5.
    const LightCoefficients expected = irradiance(light_coefficients(light, 40));
    double worst = 0;
    for (std::size_t r = 0; r < normals.size(); ++r)
      worst =
          std::max(worst, std::abs(radiance[r][1] - evaluate_at(expected.channels[1], normals[r]) / std::numbers::pi));
    // A directional light's clamped cosine of 40 bands is right to 0.005. The others have 16 places of the light: a
    // receiver that sees part of it may be wrong by most of one, 1 / 16.
    EXPECT_LT(worst, 0.06) << text;
    EXPECT_GT(worst, 0) << text;
  }
}

TEST(DirectLight, HasTheSharpShadowThatBandsLose) {
  // A ball above a floor, the light overhead: in full, the floor beneath is dark and the rest has the radiance 1.
  TriangleMesh floor;
  floor.positions = {{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  floor.normals.assign(4, Eigen::Vector3f::UnitY());
  TriangleMesh ball = shapes::icosphere(3);
  for (Eigen::Vector3f& p : ball.positions) p += Eigen::Vector3f(0, 1.5f, 0);
  ReferenceView view;
  view.scene.add(floor);
  view.scene.add(ball);
  view.width = view.height = 32;
  view.supersample = 1;
  view.albedo = 1;
  CameraSettings above;
  above.azimuth_degrees = 0;
  above.elevation_degrees = 90;
  view.camera = make_camera(floor.positions, above, view.width, view.height);
  const LightSpec light = parse_light_spec("0,90");
  const ReferencePicture picture = reference_pictures(floor, view, std::span(&light, 1), {.directions = 2048}).front();
  const Image<float> in_full = mean_of(picture.in_full);
  int dark = 0, lit = 0;
  for (int j = 0; j < view.height; ++j)
    for (int i = 0; i < view.width; ++i) {
      if (in_full.at(i, j, 3) < 0.9999f) continue;
      (in_full.at(i, j, 0) < 0.5f ? dark : lit) += 1;
      const float value = in_full.at(i, j, 0);
      EXPECT_TRUE(value == 0 || std::abs(value - 1) < 1e-5f) << value;
    }
  // The shadow has pi / 64 of the floor; a pixel more or less around it.
  EXPECT_NEAR(static_cast<double>(dark) / (dark + lit), std::numbers::pi / 64, 0.012);
  EXPECT_GT(picture.in_bands[0].at(16, 16, 0), 0.1f) << "five bands do not darken it wholly";
}

TEST(Reference, SurfacesHaveTheirOwnAlbedo) {
  // Every vertex of the sphere has a colour that tells where it is; in a furnace of radiance 1 that is its radiance.
  const TriangleMesh mesh = sphere(64);
  const auto color_at = [](const Eigen::Vector3f& p) { return Eigen::Vector3f(0.5f * (p.array() + 1)); };
  std::vector<Eigen::Vector3f> colors;
  for (const Eigen::Vector3f& p : mesh.positions) colors.push_back(color_at(p));
  ReferenceView view;
  view.width = view.height = 24;
  view.camera = make_camera(mesh.positions, {}, view.width, view.height);
  view.supersample = 1;
  view.albedo = 0.5f;
  view.surface_albedo = SurfaceAlbedo::of_vertices(colors, mesh.triangles);
  view.bands = 3;
  const LightSpec lights[] = {{.kind = LightSpec::Kind::ambient}};
  const ReferenceRays rays{.directions = 2 * 2048};
  const Image<float> picture = mean_of(reference_pictures(mesh, view, lights, rays).front().in_bands);
  const RayScene scene(mesh);
  int whole = 0;
  for (int j = 0; j < view.height; ++j)
    for (int i = 0; i < view.width; ++i) {
      if (picture.at(i, j, 3) < 0.9999f) continue;
      ++whole;
      const Eigen::Vector3f direction = view.camera.pixel_direction(i, j, view.width, view.height);
      const SurfacePoint hit = scene.first_hit(view.camera.position, direction, 0, 100);
      const Eigen::Vector3f expected = 0.5f * color_at(view.camera.position + hit.distance * direction);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.at(i, j, c), expected[c], 0.01);  // quadrature and facets
    }
  EXPECT_GT(whole, 100);
}

TEST(PictureDifference, HasNoneOfTheReferencesNoise) {
  // A picture that is 1 % too bright, and two estimates of the truth with noise of 3 % each.
  constexpr int side = 200;
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.03f);
  Image<float> picture(side, side, 4, 1);
  PictureEstimates reference{picture, picture};
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      for (int c = 0; c < 3; ++c) {
        picture.at(i, j, c) = 1.01f;
        for (Image<float>& estimate : reference) estimate.at(i, j, c) = 1 + noise(random);
      }
  picture.at(0, 0, 3) = 0.5f;  // is left out
  picture.at(0, 0, 0) = 100;
  const PictureDifference difference = compare_pictures(picture, reference);
  EXPECT_EQ(difference.pixels, side * side - 1u);
  // The product of two noises has a standard error of 0.03^2 / sqrt(120,000), that of the mean noise .02 * .021 / 346:
  // 3 % of the square, so three standard errors are 5 % of the root.
  EXPECT_NEAR(difference.relative_l2, 0.01, 0.0005);
  EXPECT_NEAR(difference.reference_noise, 0.03 / std::sqrt(2), 0.0005);
  EXPECT_GT(difference.relative_l2_uncertainty, 0.00015);  // the standard error of this noise, and
  EXPECT_LT(difference.relative_l2_uncertainty, 0.002);    // more, since noise may be alike in a block
  EXPECT_GT(difference.largest, 0.05);
  // Against one noisy picture the noise counts as error.
  EXPECT_GT(compare_pictures(picture, reference[0]).relative_l2, 0.03);
}

TEST(PictureDifference, DoesNotDependOnTheRaysOfTheReference) {
  // A sphere above a floor; the picture is the reference of many rays, 2 % brighter.
  SceneMesh scene;
  TriangleMesh mesh = sphere(24);
  scene.add(mesh);
  TriangleMesh floor;
  floor.positions = {{-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  floor.normals.assign(4, Eigen::Vector3f::UnitY());
  scene.add(floor);
  ReferenceView view;
  view.scene = scene;
  view.width = view.height = 48;
  view.camera = make_camera(mesh.positions, {}, view.width, view.height);
  const LightSpec light = parse_light_spec("20,10");
  const auto reference = [&](int directions, std::uint64_t seed) {
    return reference_pictures(mesh, view, std::span(&light, 1), {directions, seed}).front().in_bands;
  };
  Image<float> picture = mean_of(reference(16384, 9));
  for (std::size_t k = 0; k < picture.values().size(); ++k)
    if (k % 4 != 3) picture.values()[k] *= 1.02f;
  constexpr int seeds = 12;
  double square = 0, noise_square = 0;
  int covered = 0;  // seeds whose uncertainty holds the truth
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const PictureEstimates estimates = reference(96, seed);
    const PictureDifference coarse = compare_pictures(picture, estimates);
    square += std::pow(coarse.relative_l2, 2) / seeds;
    noise_square += std::pow(coarse.reference_noise, 2) / seeds;
    covered += coarse.relative_l2 + coarse.relative_l2_uncertainty >= 0.02 ? 1 : 0;
    // A picture without an error is not known to have none.
    EXPECT_GT(compare_pictures(mean_of(estimates), estimates).relative_l2_uncertainty, 0.002);
  }
  EXPECT_GE(covered, seeds - 1);
  // The noise of 48 directions is alike in many pixels: a seed's square is off by some 2 * 0.02 * 0.015, the mean of
  // twelve by 0.0002. Noise counted as error would add its own square.
  EXPECT_GT(noise_square, 0.0009);
  EXPECT_NEAR(square, 0.02 * 0.02, 0.0005);
}

/// Returns the inside of a sphere without its top, which has the share `open` of its area.
TriangleMesh open_sphere(double open) {
  TriangleMesh mesh = sphere(128);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]).y() / 3 > 1 - 2 * open;
  });
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
  return mesh;
}

TEST(BouncePaths, InAnOpenSphereHaveTheirGeometricSeries) {
  // From every point of a sphere's inside, the share of the weighted sky that a part of the sphere covers is its share
  // of the area. With a share f open, n bounces off an albedo rho give f times the sum of (rho (1 - f))^k, k = 0 to n.
  constexpr double open = 0.25, unoccluded = 0.282095;
  const TriangleMesh mesh = open_sphere(open);
  SceneMesh surface;
  surface.add(mesh, SurfaceAlbedo::constant({0.5f, 0.9f, 0}));
  const RayScene scene(surface.mesh);
  std::vector<Eigen::Vector3f> positions, normals;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 61) {
    const SurfacePoint place{static_cast<std::uint32_t>(t), 0.3f, 0.3f, 0};
    positions.push_back(position_at(mesh, place));
    normals.push_back(face_normal(mesh, place.triangle));
  }
  const Receivers receivers{positions, normals};
  const auto directions = sample_directions(Sampling::fibonacci, 2048, 1);
  for (const int bounces : {1, 4, 100}) {
    SCOPED_TRACE(bounces);
    std::vector<TransferVectors> channels(3, TransferVectors(receivers.size(), 4));
    BouncePaths(scene, surface, bounces, 1e-5f).add(receivers, directions, 7, channels);
    for (int c = 0; c < 3; ++c) {
      double mean = 0;
      for (const float value : channels[c].plane(0)) mean += value / static_cast<double>(receivers.size());
      const double rho = surface.albedos[0].constant_value()[c];
      double series = 0;
      for (int k = 1; k <= bounces; ++k) series += std::pow(rho * (1 - open), k);
      // Some 400 receivers of a thousand paths have a standard error below 0.3 % of the first bounce; facets add 0.3 %.
      EXPECT_NEAR(mean, unoccluded * open * series, 0.01 * unoccluded * open * (series + 0.1));
    }
  }
}

/// Returns a reflectance that is of one value up to a wavelength and of another from the next on.
Spectrum step_at(int nm, double below, double above) {
  Spectrum spectrum = Spectrum::Constant(wavelength_count, above);
  spectrum.head(nm - first_wavelength_nm + 1) = below;
  return spectrum;
}

TEST(BouncePaths, CarryWavelengthsThatSurfacesReflectEachByItself) {
  // A sphere of two measured materials, of a colour, which is lifted, and of one albedo at all wavelengths.
  constexpr double open = 0.25, unoccluded = 0.282095;
  const TriangleMesh mesh = open_sphere(open);
  const std::vector<int> wavelengths = {450, 520, 580, 650, 700};
  SurfaceAlbedo::Textured textured;
  textured.materials.resize(2);
  for (SurfaceAlbedo::Material& material : textured.materials)
    material.measured = {"step", std::make_shared<const Spectrum>(step_at(550, 0.2, 0.9))};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    textured.material_of.push_back(static_cast<std::uint32_t>(t % 2));
  const Eigen::Vector3f orange(0.7f, 0.3f, 0.05f);
  const RgbLift lift{StandardSpectra()};
  const SmoothReflectance lifted = lift.lift(orange.cast<double>());
  struct Case {
    SurfaceAlbedo albedo;
    std::vector<double> reflected;
  };
  Case cases[] = {{SurfaceAlbedo::of_materials(textured, SurfaceAlbedo::Source::materials), {0.2, 0.2, 0.9, 0.9, 0.9}},
                  {SurfaceAlbedo::constant(orange), {}},
                  {SurfaceAlbedo::measured({1, 0, 0}, step_at(500, 0.5, 0)), {0.5, 0, 0, 0, 0}}};
  for (const int nm : wavelengths) cases[1].reflected.push_back(lifted.at(nm));
  std::vector<Eigen::Vector3f> positions, normals;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 997) {
    const SurfacePoint place{static_cast<std::uint32_t>(t), 0.3f, 0.3f, 0};
    positions.push_back(position_at(mesh, place));
    normals.push_back(face_normal(mesh, place.triangle));
  }
  const Receivers receivers{positions, normals};
  const auto directions = sample_directions(Sampling::fibonacci, 256, 1);
  for (const Case& each : cases) {
    SceneMesh surface;
    surface.add(mesh, each.albedo);
    const RayScene scene(surface.mesh);
    std::vector<TransferVectors> channels(5, TransferVectors(receivers.size(), 1));
    BouncePaths(scene, surface, 3, 1e-5f, wavelengths).add(receivers, directions, 7, channels);
    for (std::size_t c = 0; c < 5; ++c) {
      double mean = 0, series = 0;
      for (const float value : channels[c].plane(0)) mean += value / static_cast<double>(receivers.size());
      const double rho = each.reflected[c];
      for (int k = 1; k <= 3; ++k) series += std::pow(rho * (1 - open), k);
      EXPECT_NEAR(mean, unoccluded * open * series, 0.03 * unoccluded * open * (series + 0.1)) << wavelengths[c];

      // Along the very same paths, a grey surface of that albedo.
      SceneMesh grey;
      grey.add(mesh, SurfaceAlbedo::constant(Eigen::Vector3f::Constant(static_cast<float>(rho))));
      std::vector<TransferVectors> alone(3, TransferVectors(receivers.size(), 1));
      BouncePaths(scene, grey, 3, 1e-5f).add(receivers, directions, 7, alone);
      for (std::size_t r = 0; r < receivers.size(); ++r)
        EXPECT_NEAR(channels[c].plane(0)[r], alone[0].plane(0)[r], 1e-6f);
    }
  }
}

/// Returns a large square at a height, facing up or down.
TriangleMesh square(float side, float height, bool up) {
  TriangleMesh mesh;
  mesh.positions = {{-side, height, side}, {side, height, side}, {side, height, -side}, {-side, height, -side}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (!up)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  mesh.normals.assign(4, up ? Eigen::Vector3f::UnitY() : Eigen::Vector3f(0, -1, 0));
  return mesh;
}

TEST(Reference, ShowsWavelengthsAsTheLampsMatrixReadsThem) {
  // A plane in the open under ambient light sends out what it reflects of each wavelength.
  const TriangleMesh plane = square(1, 0, true);
  ReferenceView view;
  view.camera = make_camera(plane.positions, {.elevation_degrees = 70, .target = {}}, 8, 8);
  view.width = view.height = 8;
  view.surface_albedo = SurfaceAlbedo::measured({1, 1, 1}, step_at(550, 0.2, 0.9));
  view.albedo = 0.5f;
  SpectralView& spectral = view.spectral.emplace();
  spectral.wavelengths_nm = {450, 520, 580, 650};
  spectral.rgb_from_wavelengths = Eigen::Matrix3Xf(3, 4);
  spectral.rgb_from_wavelengths << 0, 0, 0.25f, 0.75f, 0.1f, 0.6f, 0.3f, 0, 1.2f, -0.2f, 0, 0;
  const LightSpec lights[] = {parse_light_spec("ambient:2"), parse_light_spec("0,90")};
  const std::vector<ReferencePicture> pictures = reference_pictures(plane, view, lights, {.directions = 2048});
  for (std::size_t l = 0; l < 2; ++l) {
    // A directional light's radiance is that of a white surface which faces it.
    const float radiance = 0.5f * (l == 0 ? 2.f : 1.f);
    for (const PictureEstimates* estimates : {&pictures[l].in_bands, &pictures[l].in_full}) {
      const Image<float> picture = mean_of(*estimates);
      EXPECT_NEAR(picture.at(4, 4, 0), radiance * 0.9f, 0.01f) << l;
      EXPECT_NEAR(picture.at(4, 4, 1), radiance * (0.7f * 0.2f + 0.3f * 0.9f), 0.01f) << l;
      EXPECT_NEAR(picture.at(4, 4, 2), radiance * 0.2f, 0.01f) << l;
    }
  }
}

/// Returns the numbers of receivers from the `first` on.
std::vector<std::uint64_t> numbers_from(std::uint64_t first, std::size_t count) {
  std::vector<std::uint64_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

TEST(ScatterPaths, PlateHasTheIntegralsOfItsProfile) {
  // Through a plate light leaves on the upper side that entered there, the total of the profile, and that entered
  // below: the integral of 2 pi r R(sqrt(r^2 + h^2)).
  constexpr double thickness_mm = 1.5, mm_per_unit = 10;
  SceneMesh plate;
  plate.add(square(100, 0, true));
  plate.add(square(100, -thickness_mm / mm_per_unit, false));
  plate.mesh.normals.assign(8, Eigen::Vector3f::UnitY());
  for (std::size_t k = 4; k < 8; ++k) plate.mesh.normals[k] = {0, -1, 0};
  const ScatterProfile profiles[] = {ScatterProfile::dipole(0.7, 0.0014, 1.3), ScatterProfile::dipole(2.6, 0.004, 1.5),
                                     ScatterProfile::diffusion(0.6, 1)};
  const ScatterPaths paths(plate.mesh, profiles, mm_per_unit);
  const std::vector<Eigen::Vector3f> positions(500, Eigen::Vector3f::Zero());
  const std::vector<Eigen::Vector3f> normals(500, Eigen::Vector3f::UnitY());
  const ScatterEntries entries = paths.entries({positions, normals}, 256, numbers_from(0, 500));
  ASSERT_EQ(entries.ends.size(), 500u);
  Eigen::Vector3d above = Eigen::Vector3d::Zero(), below = above;
  for (std::size_t k = 0; k < entries.positions.size(); ++k)
    (entries.positions[k].y() < -0.01f ? below : above) += entries.weights[k].cast<double>() / 500;
  for (int c = 0; c < 3; ++c) {
    double through = 0;
    constexpr double step = 0.002;  // mm; what lies beyond 200 mm is less than 1e-4
    for (double r = step / 2; r < 200; r += step)
      through += 2 * std::numbers::pi * r * step * profiles[c].density(std::hypot(r, thickness_mm));
    // R is cut at 99.9 % of its light, and 128,000 lines have a standard error below half a percent.
    EXPECT_NEAR(above[c], profiles[c].total(), 0.015 * profiles[c].total()) << c;
    EXPECT_NEAR(below[c], through, 0.02 * through + 0.001) << c;
  }
}

TEST(ScatterPaths, PlaneInTheOpenHasThatMuchOfItsTransfer) {
  const TriangleMesh plane = square(100, 0, true);
  SceneMesh surface;
  surface.add(plane);
  const RayScene scene(surface.mesh);
  const ScatterProfile profile = ScatterProfile::diffusion(0.5, 2);
  const std::vector<Eigen::Vector3f> positions(400, Eigen::Vector3f::Zero());
  const std::vector<Eigen::Vector3f> normals(400, Eigen::Vector3f::UnitY());
  const std::vector<std::uint64_t> numbers = numbers_from(3, 400);
  const ScatterEntries entries =
      ScatterPaths(plane, std::span(&profile, 1), 10).entries({positions, normals}, 64, numbers);
  std::vector<TransferVectors> all(3, TransferVectors(400, 9)), direct = all;
  add_scattered(entries, PathWalker(scene, surface, 0, 1e-4f), numbers, all, direct);
  const std::vector<float> expected = unoccluded_transfer(ShBasis(3), Eigen::Vector3f::UnitY());
  for (int i = 0; i < 9; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      double mean = 0;
      for (const float value : all[c].plane(i)) mean += value / 400.0;
      // 25,600 paths: a standard error of about 0.4 % of the largest coefficient.
      EXPECT_NEAR(mean, 0.5 * expected[static_cast<std::size_t>(i)], 0.004) << i;
      EXPECT_EQ(all[c].plane(i)[7], direct[c].plane(i)[7]) << "nothing bounces off a plane";
    }
}

TEST(ScatterPaths, DarkMaterialSendsNothing) {
  const TriangleMesh plane = square(1, 0, true);
  const ScatterProfile profile = ScatterProfile::diffusion(0, 2);
  const std::vector<Eigen::Vector3f> positions(3, Eigen::Vector3f::Zero()), normals(3, Eigen::Vector3f::UnitY());
  const ScatterEntries entries =
      ScatterPaths(plane, std::span(&profile, 1), 10).entries({positions, normals}, 8, numbers_from(0, 3));
  EXPECT_EQ(entries.ends, std::vector<std::size_t>(3, 0));
}

TEST(Reference, LightBouncesAsOftenAsTheViewSays) {
  // Half of what a floor sees is a wall of albedo 1, lit by the other half of the sky: a furnace but for the light that
  // the floor would send back.
  TriangleMesh mesh;
  const float far = 1000;
  mesh.positions = {{0, 0, -far}, {0, 0, far}, {far, 0, far}, {far, 0, -far},
                    {0, 0, -far}, {0, 0, far}, {0, far, far}, {0, far, -far}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 7, 6}, {4, 6, 5}};
  for (int k = 0; k < 8; ++k) mesh.normals.push_back(k < 4 ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitX());
  ReferenceView view;
  view.width = view.height = 4;
  view.supersample = 2;
  CameraSettings from_above;
  from_above.azimuth_degrees = 90;
  from_above.elevation_degrees = 85;
  view.camera = make_camera(std::vector<Eigen::Vector3f>{{0.5f, 0, 0.5f}, {1.5f, 0, 1.5f}, {1, 0.1f, 1}}, from_above,
                            view.width, view.height);
  view.albedo = 1;
  view.bands = 2;
  const LightSpec lights[] = {{.kind = LightSpec::Kind::ambient}};
  const ReferenceRays rays{.directions = 2 * 8192};
  const float direct = mean_of(reference_pictures(mesh, view, lights, rays).front().in_bands).at(2, 2, 0);
  view.scene.add(mesh, SurfaceAlbedo::constant({1, 1, 1}));
  view.bounces = 1;
  const float once = mean_of(reference_pictures(mesh, view, lights, rays).front().in_bands).at(2, 2, 0);
  view.bounces = 50;
  const float often = mean_of(reference_pictures(mesh, view, lights, rays).front().in_bands).at(2, 2, 0);
  // Near the corner of two half planes a floor sees half of the sky, by the cosine; one bounce adds half of the half
  // that the wall covers, and all bounces make it whole. 2,048 directions a sample of either estimate, half as many
  // paths.
  EXPECT_NEAR(direct, 0.5, 0.02);
  EXPECT_NEAR(once, 0.75, 0.03);
  EXPECT_NEAR(often, 1, 0.04);
}

}  // namespace test_reference
}  // namespace kiln
