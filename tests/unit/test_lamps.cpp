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

/// Draws a scene by spectra: the sum of its lamps, as RGB; the pixel in the middle.
Eigen::Vector3d middle_of(const LampScene& scene, const SceneView& view) {
  Image<float> sum;
  for (const LampLit& lit : scene.lamps) {
    AssetRenderer renderer(lit.assets[0], 1);
    add_radiance(render_scene({{&renderer, {}, Technique::textured_prt, nullptr}}, lit.lights, view),
                 lit.rgb_from_channels, sum);
  }
  const int i = view.width / 2, j = view.height / 2;
  return {sum.at(i, j, 0), sum.at(i, j, 1), sum.at(i, j, 2)};
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
  for (const std::vector<std::string>& lamps : {std::vector<std::string>{"F11"}, {"D65"}, {"P2000", "F2"}}) {
    settings.lamps = lamps;
    LightSettings lights = furnace();
    Spectrum light = standards.light(lamps[0]).values;
    if (lamps.size() == 2) {
      lights.lights.push_back("ambient:0.5");
      light += 0.5 * standards.light(lamps[1]).values;
    }
    const Xyz truth = xyz_of(light * red.values, observer), white = xyz_of(light, observer);
    const Xyz drawn = to_xyz * middle_of(lamp_scene({asset}, lights, 3, settings), view);
    EXPECT_LT(ciede2000(lab_of(drawn, white), lab_of(truth, white)), 0.01) << lamps[0];
  }

  // Adapted to the lamp, white paper is white.
  settings.lamps = {"A"};
  settings.white = LampWhite::lamp;
  std::ofstream(scratch / "red.csv") << "400 1\n" + [] {
    std::string rows;
    for (int nm = 420; nm <= 700; nm += 20) rows += std::to_string(nm) + " 1\n";
    return rows;
  }();
  EXPECT_LT((middle_of(lamp_scene({asset}, furnace(), 3, settings), view) - Eigen::Vector3d::Ones()).norm(), 1e-3);
}

TEST(Lamps, TexturesAreLiftedTexelByTexel) {
  const Scratch scratch;
  PrtAsset asset = sphere(scratch);
  asset.albedo = PrtAlbedo::of_picture("albedo.png");
  asset.albedo.picture = Image<std::uint8_t>(40, 25, 3);
  std::mt19937 random(1);
  for (std::uint8_t& value : asset.albedo.picture.values()) value = static_cast<std::uint8_t>(random() % 256);

  const StandardSpectra standards;
  const SpectrumMatrix observer = standards.observer(Observer::cie_1931);
  const RgbLift lift(standards);
  const Eigen::Matrix3d to_xyz = lift.rgb_from_xyz().inverse();
  LampSettings settings;
  settings.lamps = {"D65", "A", "F11", "P1500"};  // the last is outside of the channels that serve others
  LightSettings lights;
  lights.lights = {"ambient:1", "ambient:1", "ambient:1", "ambient:1"};
  const LampScene scene = lamp_scene({asset}, lights, 3, settings);
  for (std::size_t l = 0; l < scene.lamps.size(); ++l) {
    const LampLit& lit = scene.lamps[l];
    const Image<std::uint8_t>& shown = lit.assets[0].albedo.picture;
    const Spectrum light = standards.light(settings.lamps[l]).values;
    const Xyz white = xyz_of(light, observer);
    double sum = 0, worst = 0;
    for (int j = 0; j < shown.height(); ++j)
      for (int i = 0; i < shown.width(); ++i) {
        Eigen::Vector3d albedo, channels;
        for (int c = 0; c < 3; ++c) {
          albedo(c) = linear_from_srgb(static_cast<float>(asset.albedo.picture.at(i, j, c)) / 255);
          channels(c) = lit.lights.specs[0].color[static_cast<std::size_t>(c)] *
                        linear_from_srgb(static_cast<float>(shown.at(i, j, c)) / 255);
        }
        const Xyz drawn = to_xyz * (lit.rgb_from_channels.cast<double>() * channels);
        const Xyz truth = xyz_of(light * lift.lift(albedo).spectrum(), observer);
        const double error = ciede2000(lab_of(drawn, white), lab_of(truth, white));
        sum += error;
        worst = std::max(worst, error);
      }
    // What bytes leave: 0.2 on average and 1.2 in dark texels, and twice that in X, Y and Z.
    EXPECT_LT(sum / 1000, l == 3 ? 0.5 : 0.25) << settings.lamps[l];
    EXPECT_LT(worst, l == 3 ? 3 : 1.4) << settings.lamps[l];
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
  const LampScene own = lamp_scene({read}, furnace(), 3, settings);
  settings.reflectances = {"tcs12"};
  const LampScene given = lamp_scene({sphere(scratch)}, furnace(), 3, settings);
  EXPECT_EQ(own.lamps[0].assets[0].albedo.constant, given.lamps[0].assets[0].albedo.constant);
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
      const Xyz drawn = to_xyz * middle_of(lamp_scene({asset}, furnace(), 3, of_lamp), view);
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

  // What it cannot be, it refuses.
  settings.lamps = {"F2"};
  EXPECT_THROW(lamp_scene({asset}, furnace(), 3, settings), BadInput);  // no matrix for it
  settings.lamps = {"A"};
  asset.spectrum->lamps[0].xyz_from_channels[0][0] += 0.1;
  EXPECT_THROW(lamp_scene({asset}, furnace(), 3, settings), BadInput);  // white is not the lamp's
  AssetRenderer renderer(asset, 1);
  EXPECT_THROW(render_scene({{&renderer, {}, Technique::textured_prt, nullptr}}, scene_lights(furnace(), 3), view),
               BadInput);  // by RGB
}

TEST(Lamps, WhatCannotBeBySpectraIsRefused) {
  const Scratch scratch;
  PrtAsset asset = sphere(scratch);
  LampSettings settings;
  settings.lamps = {"D65", "A"};
  EXPECT_THROW(lamp_scene({asset}, furnace(), 3, settings), WrongUsage);  // two for one light
  settings.lamps = {"D65"};
  LightSettings lights = furnace();
  lights.lights = {"45,30,1,0.5,0"};
  EXPECT_THROW(lamp_scene({asset}, lights, 3, settings), WrongUsage);  // a colour of its own
  lights = furnace();
  lights.environment = "sky.hdr";
  EXPECT_THROW(lamp_scene({asset}, lights, 3, settings), WrongUsage);
  settings.reflectances = {"CIE-TCS"};
  EXPECT_THROW(lamp_scene({asset}, furnace(), 3, settings), BadInput);  // 15 of them
  settings.reflectances = {};
  asset.albedo = PrtAlbedo::of_transfer();
  EXPECT_THROW(lamp_scene({asset}, furnace(), 3, settings), BadInput);
  asset.albedo = {};
  asset.channels = 3;
  EXPECT_THROW(lamp_scene({asset}, furnace(), 3, settings), BadInput);
}

}  // namespace test_lamps
}  // namespace kiln
