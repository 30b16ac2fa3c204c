// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

#include "asset/write_asset.h"
#include "base/errors.h"
#include "base/outputs.h"
#include "image/srgb.h"
#include "prt_folders.h"
#include "render/film/film_lamps.h"
#include "render/lamps.h"
#include "scratch.h"
#include "shapes.h"
#include "spectrum/colorimetry.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/wavelengths.h"

namespace kiln {
namespace test_lamps {

/// An asset without shadows, in ambient light of radiance 1.
PrtAsset sphere(const Scratch& scratch) {
  const TriangleMesh mesh = shapes::cube_sphere(8);
  test::write_asset(scratch.folder(), mesh, test::unoccluded_stack(mesh, 96, 64, 3, 16));
  return load_prt_asset(scratch.folder());
}

LightSettings furnace() {
  LightSettings lights;
  lights.lights = {"ambient:1"};
  return lights;
}

/// Makes the scene of one asset.
LampScene lamp_scene(const PrtAsset& asset, const LightSettings& lights, const LampSettings& settings) {
  return SpectralAssets({&asset}, settings).under(lights, settings.lamps, 3);
}

/// Draws a scene by spectra; the pixel in the middle.
Eigen::Vector3d middle_of(const LampScene& scene, const SceneView& view,
                          Technique technique = Technique::textured_prt) {
  AssetRenderer renderer(*scene.assets[0], 1);
  renderer.set_colors(scene.colors[0]);
  const Image<float> picture = render_scene({{&renderer, {}, technique, nullptr}}, scene.lights, view);
  const int i = view.width / 2, j = view.height / 2;
  return {picture.at(i, j, 0), picture.at(i, j, 1), picture.at(i, j, 2)};
}

TEST(Lamps, DrawnColorsAreThoseOfTheSpectra) {
  const Scratch scratch;
  const PrtAsset asset = sphere(scratch);
  const auto context = test::software_context();
  const SceneView view = test::small_view(asset.mesh, 20, 12);
  const StandardSpectra standards;
  const SpectrumMatrix observer = standards.observer(Observer::cie_1931);
  const Eigen::Matrix3d to_xyz = RgbLift(standards).rgb_from_xyz().inverse();
  const NamedSpectrum red = standards.reflectances("CIE-TCS").at(8);
  std::ofstream file(scratch / "red.csv");
  for (int i = 0; i < wavelength_count; i += 5) file << wavelength_nm(i) << "," << red.values(i) << "\n";
  file.close();

  LampSettings settings;
  settings.reflectances = {scratch / "red.csv"};
  // Ten lamps are more than the functions of light, so they are its characteristic vectors.
  for (const std::vector<std::string>& lamps :
       {std::vector<std::string>{"F11"},
        {"D65"},
        {"P2000", "F2"},
        {"A", "D50", "D65", "F2", "F4", "F7", "F11", "F12", "P1900", "D25000"}}) {
    settings.lamps = lamps;
    LightSettings lights;
    Spectrum light = Spectrum::Zero(wavelength_count);
    for (const std::string& lamp : lamps) {
      lights.lights.push_back(lights.lights.empty() ? "ambient:1" : "ambient:0.5");
      light += (lights.lights.size() == 1 ? 1 : 0.5) * standards.light(lamp).values;
    }
    const Xyz truth = xyz_of(light * red.values, observer), white = xyz_of(light, observer);
    for (const Technique technique : {Technique::textured_prt, Technique::vertex_prt, Technique::phong}) {
      if (technique != Technique::textured_prt && lamps.size() == 1) continue;
      const Xyz drawn = to_xyz * middle_of(lamp_scene(asset, lights, settings), view, technique);
      EXPECT_LT(ciede2000(lab_of(drawn, white), lab_of(truth, white)), lamps.size() > 8 ? 0.05 : 0.01) << lamps[0];
    }
  }

  // Adapted to the lamp, white paper is white.
  settings.lamps = {"A"};
  settings.white = LampWhite::lamp;
  std::ofstream(scratch / "red.csv") << "400 1\n" + [] {
    std::string rows;
    for (int nm = 420; nm <= 700; nm += 20) rows += std::to_string(nm) + " 1\n";
    return rows;
  }();
  EXPECT_LT((middle_of(lamp_scene(asset, furnace(), settings), view) - Eigen::Vector3d::Ones()).norm(), 1e-3);
}

/// Draws a square with uvs of 0 to 1, whose pixels are its albedo's texels.
Image<float> drawn_square(const LampScene& scene, const Image<std::uint8_t>& albedo, bool is_deferred) {
  AssetRenderer renderer(*scene.assets[0], 1);
  renderer.set_colors(scene.colors[0]);
  const std::vector<SceneAsset> assets = {{&renderer, {}, Technique::textured_prt, nullptr}};
  light_scene(assets, scene.lights, {});
  const Frame frame(albedo.width(), albedo.height());
  const AppearanceFrame appearance(albedo.width(), albedo.height(), false);
  draw_scene(assets, Eigen::Matrix4d::Identity(), {0, 0, 1}, frame, is_deferred ? &appearance : nullptr);
  Image<float> picture(albedo.width(), albedo.height(), 4);
  glBindFramebuffer(GL_FRAMEBUFFER, frame.framebuffer().name());
  glReadPixels(0, 0, albedo.width(), albedo.height(), GL_RGBA, GL_FLOAT, picture.values().data());
  return picture;
}

TEST(Lamps, TexturesAreLiftedTexelByTexel) {
  const Scratch scratch;
  TriangleMesh square;
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.normals.assign(4, {0, 0, 1});
  square.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  test::write_asset(scratch.folder(), square, test::unoccluded_stack(square, 40, 25, 3, 16));
  PrtAsset asset = load_prt_asset(scratch.folder());
  asset.albedo = PrtAlbedo::of_picture("albedo.png");
  asset.albedo.picture = Image<std::uint8_t>(40, 25, 3);
  std::mt19937 random(1);
  for (std::uint8_t& value : asset.albedo.picture.values()) value = static_cast<std::uint8_t>(random() % 256);
  std::fill_n(asset.albedo.picture.values().begin(), 3, std::uint8_t{255});

  const StandardSpectra standards;
  const SpectrumMatrix observer = standards.observer(Observer::cie_1931);
  const RgbLift lift(standards);
  const Eigen::Matrix3d to_xyz = lift.rgb_from_xyz().inverse();
  const std::vector<NamedSpectrum> materials = {standards.reflectance("TCS12"), standards.reflectance("TCS09")};
  asset.albedo.measured_at = Image<std::uint8_t>(40, 25, 1);
  for (const NamedSpectrum& one : materials)
    asset.albedo.reflectances.push_back({one.name, first_wavelength_nm, 1, {one.values.begin(), one.values.end()}});
  Eigen::MatrixXd surfaces(wavelength_count, 1000);
  for (int k = 0; k < 1000; ++k) {
    Eigen::Vector3d albedo;
    for (int c = 0; c < 3; ++c)
      albedo(c) = linear_from_srgb(static_cast<float>(asset.albedo.picture.at(k % 40, k / 40, c)) / 255);
    surfaces.col(k) = lift.lift(albedo).spectrum().matrix();
    if (k % 7 != 3) continue;
    // Every seventh texel is of one of two materials that were measured.
    asset.albedo.measured_at.at(k % 40, k / 40, 0) = static_cast<std::uint8_t>(1 + k % 2);
    surfaces.col(k) = materials[static_cast<std::size_t>(k % 2)].values.matrix();
  }
  const auto context = test::software_context();
  const SpectralAssets assets({&asset}, {});
  const std::vector<std::vector<std::string>> choices = {
      {"D65"},
      {"A"},
      {"F11"},
      {"P1500"},  // the last is outside of sRGB
      {"A", "F11"},
      {"A", "F11", "D25000"},
      {"A", "F11", "F4", "D25000"},
      {"A", "D50", "D65", "F2", "F11"},
      {"A", "D50", "D65", "F2", "F11", "F12", "P1900"},
      {"A", "D50", "D65", "F2", "F4", "F7", "F11", "F12", "P1900", "D25000"}};
  for (const std::vector<std::string>& lamps : choices) {
    LightSettings lights;
    Spectrum light = Spectrum::Zero(wavelength_count);
    for (const std::string& lamp : lamps) {
      lights.lights.push_back("ambient:1");
      light += standards.light(lamp).values;
    }
    const LampScene scene = assets.under(lights, lamps, 3);
    const Image<float> shown = drawn_square(scene, asset.albedo.picture, lamps.size() == 3);
    const Xyz white = xyz_of(light, observer);
    double sum = 0, worst = 0, whitest = 0;
    for (int k = 0; k < 1000; ++k) {
      const Xyz drawn = to_xyz * Eigen::Vector3d(shown.at(k % 40, k / 40, 0), shown.at(k % 40, k / 40, 1),
                                                 shown.at(k % 40, k / 40, 2));
      const Xyz truth = xyz_of(light * surfaces.col(k).array(), observer);
      const double error = ciede2000(lab_of(drawn, white), lab_of(truth, white));
      sum += error;
      worst = std::max(worst, error);
      if (k == 0) whitest = (drawn - white).cwiseAbs().maxCoeff() / white.maxCoeff();
    }
    const bool is_outside = lamps[0] == "P1500";
    EXPECT_LT(sum / 1000, is_outside ? 0.2 : 0.12) << lamps[0];
    EXPECT_LT(worst, is_outside ? 2.5 : 1.2) << lamps[0];
    EXPECT_LT(whitest, 1e-4) << lamps[0];
  }
}

TEST(Lamps, AMeasuredReflectanceShipsAndIsRead) {
  const Scratch scratch;
  PrtAsset asset = sphere(scratch);
  const StandardSpectra standards;
  const NamedSpectrum blue = standards.reflectance("TCS12");
  asset.albedo = PrtAlbedo::of_constant({0.f, 0.2f, 0.4f});
  asset.albedo.reflectance = {blue.name, first_wavelength_nm, 1, {blue.values.begin(), blue.values.end()}};
  OutputSet outputs(scratch.folder());
  asset.albedo.picture = {};
  outputs.add_text("ranges.json", description_text(asset));
  outputs.commit();
  const PrtAsset read = load_prt_asset(scratch.folder());
  EXPECT_EQ(read.albedo.reflectance, asset.albedo.reflectance);

  LampSettings settings;
  settings.lamps = {"F11"};
  const LampScene own = lamp_scene(read, furnace(), settings);
  settings.reflectances = {"tcs12"};
  const PrtAsset plain = sphere(scratch);
  const LampScene given = lamp_scene(plain, furnace(), settings);
  EXPECT_EQ(own.colors[0]->readers, given.colors[0]->readers);
}

TEST(Lamps, ChannelsOfWavelengthsBecomeColors) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(8);
  const std::vector<float> tints = {0.9f, 0.8f, 0.5f, 0.3f, 0.6f, 0.7f};
  test::write_asset(scratch.folder(), mesh, test::unoccluded_stack(mesh, 96, 64, 3, 16, tints));
  const StandardSpectra standards;
  SpectralScene scene{{standards.light("A"), standards.light("F11")},
                      standards.reflectances("CIE-TCS"),
                      standards.observer(Observer::cie_1931)};
  const WavelengthSet set = find_wavelengths(scene, 6);
  PrtAsset asset = load_prt_asset(scratch.folder());
  PrtSpectrum& spectrum = asset.spectrum.emplace();
  spectrum.wavelengths_nm = set.wavelengths_nm;
  for (std::size_t l = 0; l < 2; ++l) {
    PrtSpectrum::Lamp& lamp = spectrum.lamps.emplace_back();
    lamp.name = scene.lights[l].name;
    for (const auto& row : set.readers[l].rowwise()) lamp.xyz_from_channels.emplace_back(row.begin(), row.end());
  }
  const auto context = test::software_context();
  const SceneView view = test::small_view(asset.mesh, 20, 12);
  const RgbLift lift(standards);
  const Eigen::Matrix3d to_xyz = lift.rgb_from_xyz().inverse();
  const auto expect_colors = [&](const LampSettings& settings, const auto& share_at, std::size_t lamps = 2) {
    for (std::size_t l = 0; l < lamps; ++l) {
      LampSettings of_lamp = settings;
      of_lamp.lamps = {l == 0 ? "a" : "F11"};
      Xyz truth = Xyz::Zero();
      for (std::size_t k = 0; k < tints.size(); ++k)
        truth += set.readers[l].col(static_cast<Eigen::Index>(k)) * tints[k] * share_at(set.wavelengths_nm[k]);
      const Xyz white = xyz_of(scene.lights[l].values, scene.observer);
      const Xyz drawn = to_xyz * middle_of(lamp_scene(asset, furnace(), of_lamp), view);
      EXPECT_LT(ciede2000(lab_of(drawn, white), lab_of(truth, white)), 0.05) << of_lamp.lamps[0];
    }
  };
  LampSettings settings;
  settings.reflectances = {"TCS09"};
  const Spectrum red = standards.reflectance("TCS09").values;
  expect_colors(settings, [&](int nm) { return red(nm - first_wavelength_nm); });
  settings.reflectances = {};
  asset.albedo = PrtAlbedo::of_constant({0.2f, 0.5f, 0.3f});
  const SmoothReflectance green = lift.lift({0.2, 0.5, 0.3});
  expect_colors(settings, [&](int nm) { return green.at(nm); });
  asset.albedo = PrtAlbedo::of_picture("albedo.png");
  asset.albedo.picture = Image<std::uint8_t>(96, 64, 3, 128);
  const double grey = linear_from_srgb(128 / 255.f);
  expect_colors(
      settings, [&](int) { return grey; }, 1);

  // Both lamps at once leave the wavelengths as channels.
  LampSettings both = settings;
  both.lamps = {"A", "F11"};
  both.reflectances = {"TCS09"};
  LightSettings two = furnace();
  two.lights.push_back("ambient:0.5");
  Xyz truth = Xyz::Zero();
  for (std::size_t k = 0; k < tints.size(); ++k)
    for (std::size_t l = 0; l < 2; ++l)
      truth += (l == 0 ? 1 : 0.5) * set.readers[l].col(static_cast<Eigen::Index>(k)) * tints[k] *
               red(set.wavelengths_nm[k] - first_wavelength_nm);
  const Xyz white = xyz_of(scene.lights[0].values + 0.5 * scene.lights[1].values, scene.observer);
  EXPECT_LT(ciede2000(lab_of(to_xyz * middle_of(lamp_scene(asset, two, both), view), white), lab_of(truth, white)),
            0.05);

  // What it cannot be, it refuses.
  settings.lamps = {"F2"};
  EXPECT_THROW(lamp_scene(asset, furnace(), settings), BadInput);  // no matrix for it
  settings.lamps = {"A"};
  asset.spectrum->lamps[0].xyz_from_channels[0][0] += 0.1;
  EXPECT_THROW(lamp_scene(asset, furnace(), settings), BadInput);  // white is not the lamp's
  AssetRenderer renderer(asset, 1);
  EXPECT_THROW(render_scene({{&renderer, {}, Technique::textured_prt, nullptr}}, scene_lights(furnace(), 3), view),
               BadInput);  // by RGB
}

/// Reads a scene whose only asset lies in a folder, lit by the lamps of its lights or of the settings.
Film lit_film(const Scratch& scratch, const std::string& lights, const LampSettings& settings) {
  std::ofstream(scratch / "scene.yaml") << "nodes: [{name: x, asset: .}]\n" << lights;
  Film film = load_film(scratch / "scene.yaml", 0);
  light_by_lamps(film, scratch / "scene.yaml", settings, {});
  return film;
}

/// Draws a scene at time 0, the pixels.
Image<float> drawn_film(const Film& film, const SceneView& view) {
  RenderSettings look;
  MovingScene scene = moving_scene(film, {{}, 1});
  FilmAssets assets(scene, film, look, 1);
  return render_scene(assets.now(view.look), scene.lights(), view);
}

TEST(Lamps, ASceneOfOneAssetIsThatAsset) {
  const Scratch scratch;
  const PrtAsset asset = sphere(scratch);
  const auto context = test::software_context();
  const SceneView view = test::small_view(asset.mesh, 16, 12);
  std::ofstream(scratch / "tube.csv") << "400 1\n420 1\n440 9\n460 1\n480 1\n500 1\n520 1\n540 9\n560 1\n580 1\n600 "
                                         "1\n620 9\n640 1\n660 1\n680 1\n700 1\n";
  LampSettings settings;
  settings.reflectances = {"TCS12"};
  const std::string scene =
      "lights: [{directional: [30, 40], lamp: F11}, {hemisphere: [0, 90], ground: 0.2, radiance: 0.5, lamp: tube.csv}, "
      "{ambient: 0.2, lamp: A}, {directional: [-60, 0], radius: 9, lamp: D75}]\n";
  const Film by_scene = lit_film(scratch, scene, settings);
  ASSERT_EQ(by_scene.lamps->lights.vectors.front().size(), 4);
  LightSettings lights;
  lights.lights = {"30,40", "hemisphere:0,90,0.5,0.5,0.5,0.2,0.2,0.2", "ambient:0.2", "cone:-60,0,9"};
  settings.lamps = {"F11", scratch / "tube.csv", "A", "D75"};
  const LampScene by_asset = lamp_scene(asset, lights, settings);
  const auto draw_alone = [&](const LampScene& lamps) {
    AssetRenderer renderer(*lamps.assets[0], 1);
    renderer.set_colors(lamps.colors[0]);
    return render_scene({{&renderer, {}, Technique::textured_prt, nullptr}}, lamps.lights, view);
  };
  const auto expect_same = [](const Image<float>& a, const Image<float>& b) {
    double brightest = 0;
    for (std::size_t k = 0; k < a.values().size(); ++k) {
      EXPECT_NEAR(a.values()[k], b.values()[k], 2e-5);
      brightest = std::max<double>(brightest, a.values()[k]);
    }
    EXPECT_GT(brightest, 0.3);
  };
  expect_same(drawn_film(by_scene, view), draw_alone(by_asset));
  // One for all, in place of those of the scene.
  settings.lamps = {"P2000"};
  expect_same(drawn_film(lit_film(scratch, scene, settings), view), draw_alone(lamp_scene(asset, lights, settings)));
}

TEST(Lamps, ScenesRefuseWhatLampsCannotLight) {
  const Scratch scratch;
  sphere(scratch);
  const auto refuses = [&](const std::string& lights, int line, const std::string& part) {
    try {
      lit_film(scratch, lights, {});
      ADD_FAILURE() << "not refused: " << lights;
    } catch (const BadInput& error) {
      EXPECT_TRUE(error.file().ends_with("scene.yaml:" + std::to_string(line))) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refuses("lights:\n  - {ambient: 1, lamp: F99}\n", 3, "the lamp 'F99'");
  refuses("lights:\n  - {ambient: 1, lamp: none.csv}\n", 3, "relative to the scene's folder");
  refuses("lights:\n  - {ambient: [1, 0.5, 1], lamp: A}\n", 3, "a light of a colour");
  refuses(
      "lights:\n  - {directional: [0, 0], lamp: A, animate: {keyframes: [{time: 0, radiance: [1, 0.5, 1]}, {time: 1, "
      "radiance: 1}]}}\n",
      3, "a light of a colour");
  EXPECT_FALSE(lit_film(scratch, "lights: [{ambient: [1, 0.5, 1]}]\n", {}).lamps);
  LampSettings two;
  two.lamps = {"A", "D65"};
  EXPECT_THROW(lit_film(scratch, "lights: [{ambient: 1}, {ambient: 1}]\n", two), WrongUsage);
  LampSettings surface;
  surface.reflectances = {"TCS01"};
  EXPECT_THROW(lit_film(scratch, "lights: [{ambient: 1}]\n", surface), WrongUsage);
}

TEST(Lamps, WhatCannotBeBySpectraIsRefused) {
  const Scratch scratch;
  PrtAsset asset = sphere(scratch);
  LampSettings settings;
  settings.lamps = {"D65", "A"};
  EXPECT_THROW(lamp_scene(asset, furnace(), settings), WrongUsage);  // two for one light
  settings.lamps = {"D65"};
  LightSettings lights = furnace();
  lights.lights = {"45,30,1,0.5,0"};
  EXPECT_THROW(lamp_scene(asset, lights, settings), WrongUsage);  // a colour of its own
  lights = furnace();
  lights.environment = "sky.hdr";
  EXPECT_THROW(lamp_scene(asset, lights, settings), WrongUsage);
  settings.reflectances = {"CIE-TCS"};
  EXPECT_THROW(lamp_scene(asset, furnace(), settings), BadInput);  // 15 of them
  settings.reflectances = {};
  asset.albedo = PrtAlbedo::of_transfer();
  EXPECT_THROW(lamp_scene(asset, furnace(), settings), BadInput);
  asset.albedo = {};
  asset.channels = 3;
  EXPECT_THROW(lamp_scene(asset, furnace(), settings), BadInput);
}

}  // namespace test_lamps
}  // namespace kiln
