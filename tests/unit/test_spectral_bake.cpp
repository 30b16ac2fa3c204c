// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

#include "bake/spectral_channels.h"
#include "base/errors.h"
#include "bounce_stand.h"
#include "image/srgb.h"
#include "material/measured_reflectance.h"
#include "material/wavelength_albedo.h"
#include "scratch.h"
#include "shapes.h"
#include "spectrum/colorimetry.h"
#include "spectrum/wavelengths.h"

namespace kiln {
namespace test_spectral_bake {

SurfaceAlbedo measured(const std::string& name) {
  MeasuredReflectance found = load_reflectance(name);
  return SurfaceAlbedo::measured(found.albedo, std::move(found.spectrum.values));
}

TriangleMesh square(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v) {
  TriangleMesh mesh;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  compute_vertex_normals(mesh);
  return mesh;
}

/// A floor and two walls that meet in a corner, and places on the floor near it.
BounceStand corner_of(const std::vector<SurfaceAlbedo>& albedos) {
  BounceStand stand;
  stand.occluders = join_occluders({square({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), square({0, 0, 0}, {0, 1, 0}, {0, 0, 1}),
                                    square({0, 0, 0}, {1, 0, 0}, {0, 1, 0})},
                                   albedos);
  for (const float along : {0.04f, 0.1f, 0.2f, 0.4f}) {
    stand.positions.emplace_back(along, 0, along);
    stand.normals.emplace_back(0, 1, 0);
  }
  stand.settings.directions = 512;
  stand.settings.bounce_edge = 0.06;
  stand.settings.bounces.count = 3;
  return stand;
}

const std::vector<int> eight = {420, 445, 470, 500, 540, 575, 610, 650};

TEST(SpectralBake, EachWavelengthIsAsIfItWereAlone) {
  const std::vector<std::string> names = {"TCS05", "TCS09", "TCS12"};
  std::vector<SurfaceAlbedo> surfaces;
  for (const std::string& name : names) surfaces.push_back(measured(name));
  BounceStand stand = corner_of(surfaces);
  stand.occluders.reflectance.emplace(stand.occluders, eight);
  const BakeResult baked = stand.bake();
  ASSERT_EQ(baked.channels.size(), eight.size());
  ASSERT_EQ(baked.bounces->energy.size(), 3u);
  for (std::size_t k = 0; k < eight.size(); ++k) {
    std::vector<SurfaceAlbedo> greys;
    for (const SurfaceAlbedo& surface : surfaces)
      greys.push_back(SurfaceAlbedo::constant(
          Eigen::Vector3f::Constant(static_cast<float>((*surface.reflectance())(eight[k] - first_wavelength_nm)))));
    const BakeResult alone = corner_of(greys).bake();
    ASSERT_EQ(alone.channels.size(), 1u);
    for (std::size_t r = 0; r < stand.positions.size(); ++r)
      EXPECT_NEAR(baked.channels[k].plane(0)[r], alone.channels[0].plane(0)[r], 1e-6f) << eight[k] << " nm, " << r;
  }
}

TEST(SpectralBake, LampsShowWhatFineWavelengthsShow) {
  const StandardSpectra standards;
  SpectralScene scene{{}, standards.reflectances("CIE-TCS"), standards.observer(Observer::cie_1931)};
  for (const char* lamp : {"D65", "A", "F11"}) scene.lights.push_back(standards.light(lamp));
  const WavelengthSet set = find_wavelengths(scene, 8);
  std::vector<int> fine;
  for (int nm = 380; nm <= 780; nm += 10) fine.push_back(nm);

  const std::vector<std::vector<std::string>> rooms = {{"TCS05", "TCS09", "TCS12"}, {"TCS12", "TCS13", "TCS10"}};
  for (const std::vector<std::string>& names : rooms) {
    std::vector<SurfaceAlbedo> surfaces;
    for (const std::string& name : names) surfaces.push_back(measured(name));
    const auto transfer_at = [&](const std::vector<int>& wavelengths) {
      BounceStand stand = corner_of(surfaces);
      stand.occluders.reflectance.emplace(stand.occluders, wavelengths);
      return stand.bake().channels;
    };
    const std::vector<TransferVectors> few = transfer_at(set.wavelengths_nm), many = transfer_at(fine);
    const Spectrum& floor = *surfaces[0].reflectance();
    for (std::size_t r = 0; r < few[0].receivers; ++r) {
      SampledSpectrum sampled;
      for (std::size_t k = 0; k < fine.size(); ++k) {
        sampled.wavelengths_nm.push_back(fine[k]);
        sampled.values.push_back(many[k].plane(0)[r] / 0.282095);
      }
      const Spectrum received = resample(sampled);
      for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const Spectrum& lamp = scene.lights[l].values;
        const Xyz white = xyz_of(lamp, scene.observer), truth = xyz_of(lamp * received * floor, scene.observer);
        Xyz shown = Xyz::Zero();
        for (std::size_t k = 0; k < few.size(); ++k)
          shown += set.readers[l].col(static_cast<Eigen::Index>(k)) * (few[k].plane(0)[r] / 0.282095) *
                   floor(set.wavelengths_nm[k] - first_wavelength_nm);
        // What docs/spectral.md has for eight wavelengths after three reflections.
        EXPECT_LT(ciede2000(lab_of(shown, white), lab_of(truth, white)), 1.7)
            << names[0] << " at " << r << " under " << scene.lights[l].name;
      }
    }
  }
}

TEST(SpectralBake, AlbedosAreLiftedWhereNothingWasMeasured) {
  std::vector<int> tens;
  for (int nm = 380; nm <= 780; nm += 10) tens.push_back(nm);
  WavelengthAlbedo albedo(tens);
  albedo.prepare_table();
  const StandardSpectra standards;
  const Spectrum lamp = standards.light("A").values;
  const SpectrumMatrix observer = standards.observer(Observer::cie_1931);
  const auto color_of = [&](const std::vector<float>& shares) {
    Xyz color = Xyz::Zero();
    for (std::size_t w = 0; w < tens.size(); ++w) {
      const Eigen::Index at = tens[w] - first_wavelength_nm;
      color += 10 * lamp(at) * static_cast<double>(shares[w]) * observer.row(at).transpose();
    }
    return color;
  };
  const Xyz white = color_of(std::vector<float>(tens.size(), 1.f));
  std::mt19937 random(1);
  double sum = 0, worst = 0;
  std::vector<float> found(tens.size());
  for (int k = 0; k < 300; ++k) {
    Eigen::Vector3f color;
    for (int c = 0; c < 3; ++c) color[c] = linear_from_srgb(static_cast<float>(random() % 256) / 255);
    albedo.look_up(color, found);
    const double error = ciede2000(lab_of(color_of(found), white), lab_of(color_of(albedo.of(color)), white));
    sum += error;
    worst = std::max(worst, error);
  }
  EXPECT_LT(sum / 300, 0.08);
  EXPECT_LT(worst, 1);
  for (const float grey : {0.f, 0.5f, 1.f}) {
    albedo.look_up(Eigen::Vector3f::Constant(grey), found);
    for (const float reflectance : found) EXPECT_NEAR(reflectance, grey, 2e-3f);
  }

  // A scene of a measured surface and of colours: where nothing differs, colours have their own lifted reflectance.
  BounceStand stand = corner_of(
      {measured("TCS09"), SurfaceAlbedo::constant({0.7f, 0.2f, 0.1f}),
       SurfaceAlbedo::of_vertices(std::vector<Eigen::Vector3f>(4, {0.7f, 0.2f, 0.1f}), {{0, 1, 2}, {0, 2, 3}})});
  const SceneReflectance reflectance(stand.occluders, eight);
  const std::vector<float> lifted = WavelengthAlbedo(eight).of(Eigen::Vector3f(0.7f, 0.2f, 0.1f));
  const Spectrum red = *measured("TCS09").reflectance();
  for (std::size_t first = 0; first < eight.size(); first += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t w = std::min(first + k, eight.size() - 1);
      const auto at = static_cast<Eigen::Index>(k);
      EXPECT_FLOAT_EQ(reflectance.at(stand.occluders, 0, 0.2f, 0.2f, first)[at],
                      static_cast<float>(red(eight[w] - first_wavelength_nm)));
      EXPECT_FLOAT_EQ(reflectance.at(stand.occluders, 2, 0.2f, 0.2f, first)[at], lifted[w]);
      EXPECT_NEAR(reflectance.at(stand.occluders, 4, 0.2f, 0.2f, first)[at], lifted[w], 0.005f);
    }
}

TEST(SpectralBake, BasesThatAreNoneAreRefused) {
  const Scratch scratch;
  const auto refusal = [&](const std::string& text) -> std::string {
    std::ofstream(scratch / "basis.json") << text;
    try {
      read_spectral_channels(scratch / "basis.json");
    } catch (const BadInput& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string head = R"({"format": "kiln-spectrum", "version": 1, "lights": [{"name": "A"}], "channels": )";
  const std::string row = "[1, 2, 3, 4]", matrix = "[" + row + "," + row + "," + row + "]";
  EXPECT_EQ(refusal(head + R"({"wavelengths_nm": [430, 500, 560, 620], "xyz_by_light": [)" + matrix + "]}}"),
            "no error");
  EXPECT_NE(refusal("{}").find("format"), std::string::npos);
  EXPECT_NE(refusal(head + "3}").find("channels"), std::string::npos);
  EXPECT_NE(refusal(head + R"({"wavelengths_nm": [430, 500, 560], "xyz_by_light": []}})").find("has 3 wavelengths"),
            std::string::npos);
  EXPECT_NE(refusal(head + R"({"wavelengths_nm": [430, 500, 500, 620], "xyz_by_light": [)" + matrix + "]}}")
                .find("that rise"),
            std::string::npos);
  EXPECT_NE(refusal(head + R"({"wavelengths_nm": [430, 500, 560, 620], "xyz_by_light": [[[1], [2], [3]]]}})")
                .find("three rows of 4 numbers"),
            std::string::npos);
  EXPECT_NE(refusal(head + R"({"wavelengths_nm": [430, 500, 560, 620], "xyz_by_light": []}})").find("xyz_by_light"),
            std::string::npos);
}

}  // namespace test_spectral_bake
}  // namespace kiln
