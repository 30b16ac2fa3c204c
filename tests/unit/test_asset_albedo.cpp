// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <functional>
#include <gtest/gtest.h>

#include "asset/prt_asset.h"
#include "bake/planes/coefficient_planes.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "compress/compress_files.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_asset_albedo {

namespace fs = std::filesystem;

constexpr int size = 16;

class AssetAlbedo : public testing::Test {
 protected:
  fs::path folder(const std::string& name = "prt") const { return scratch_.folder() / name; }

  /// Writes a baked folder of two bands whose ranges.json has `albedo`.
  void write(const PrtAlbedo& albedo) const {
    OutputSet outputs(folder());
    const TriangleMesh mesh = shapes::plane(2);
    save_draco(outputs.add("atlas.drc"), mesh);
    if (!albedo.file.empty()) write_png(outputs.add(albedo.file), picture());
    const TriangleMesh atlas = load_atlas(outputs.staging() / "atlas.drc");
    const ReceiverSet receivers = receivers_on_low(atlas, size, size, nullptr);
    TransferVectors transfer(receivers.slots.size(), 4);
    for (int i = 0; i < 4; ++i)
      for (std::size_t r = 0; r < receivers.slots.size(); ++r)
        transfer.plane(i)[r] = 0.1f * static_cast<float>(i) + 0.001f * static_cast<float>(r % 17);
    write_planes(outputs, {transfer}, receivers, {.mesh_file = "atlas.drc", .albedo = albedo}, Seams(atlas, size, size),
                 SeamChoice::keep);
    outputs.commit();
  }

  static Image<std::uint8_t> picture() {
    Image<std::uint8_t> result(size, size, 3);
    for (std::size_t k = 0; k < result.values().size(); ++k) result.values()[k] = static_cast<std::uint8_t>(3 * k);
    return result;
  }

  std::string refusal(const std::string& name = "prt") const {
    try {
      load_prt_asset(folder(name));
    } catch (const BadInput& error) {
      return error.what();
    }
    return "no error";
  }

  /// Compresses `prt` into `small`, as planes again or by principal components.
  void compress_as(int components) const {
    const PrtAsset asset = load_prt_asset(folder());
    CompressSettings settings;
    settings.components = components;
    const CompressResult result = compress(asset, settings);
    OutputSet outputs(folder("small"));
    save_compressed(outputs, folder(), asset, result);
    outputs.commit();
  }

 private:
  Scratch scratch_;
};

TEST_F(AssetAlbedo, IsReadAsItWasBaked) {
  write(PrtAlbedo::of_picture("albedo.png"));
  const PrtAlbedo painted = load_prt_asset(folder()).albedo;
  EXPECT_EQ(painted.file, "albedo.png");
  EXPECT_EQ(painted.picture.values(), picture().values());
  write(PrtAlbedo::of_constant({0.5f, 0.25f, 0.125f}));
  const PrtAlbedo plain = load_prt_asset(folder()).albedo;
  EXPECT_TRUE(plain.file.empty() && plain.picture.values().empty());
  EXPECT_EQ(plain.constant, Eigen::Vector3f(0.5f, 0.25f, 0.125f));
  write({});
  EXPECT_FALSE(Json::parse(read_text(folder() / "ranges.json")).contains("albedo"));
  EXPECT_EQ(load_prt_asset(folder()).albedo.constant, Eigen::Vector3f::Ones());
}

TEST_F(AssetAlbedo, SurvivesCompression) {
  for (const int components : {0, 2}) {
    SCOPED_TRACE(components);
    write(PrtAlbedo::of_picture("albedo.png"));
    compress_as(components);
    EXPECT_EQ(load_prt_asset(folder("small")).albedo.picture.values(), picture().values());
    write(PrtAlbedo::of_constant({0.5f, 0.25f, 0.125f}));
    compress_as(components);
    EXPECT_EQ(load_prt_asset(folder("small")).albedo.constant, Eigen::Vector3f(0.5f, 0.25f, 0.125f));
    EXPECT_FALSE(fs::exists(folder("small") / "albedo.png")) << "of the run before";
  }
}

TEST_F(AssetAlbedo, WhatDoesNotFitIsRefused) {
  const auto expect_words = [&](const std::string& words) {
    const std::string found = refusal();
    EXPECT_NE(found.find(words), std::string::npos) << found;
  };
  write(PrtAlbedo::of_picture("albedo.png"));
  write_png(folder() / "albedo.png", Image<std::uint8_t>(size, size / 2, 3));
  expect_words("albedo.png: is 16 x 8 texels; expected 16 x 16");
  write_png(folder() / "albedo.png", Image<std::uint8_t>(size, size, 1));
  expect_words("albedo.png: has 1 channels");
  write_png(folder() / "albedo.png", Image<std::uint16_t>(size, size, 3));
  expect_words("albedo.png: a PNG of 16 bits");
  fs::remove(folder() / "albedo.png");
  expect_words("albedo.png: no such file");
  for (const char* albedo : {R"([1, 1])", R"([1, 1, 2])", R"([1, 1, "1"])", "3", R"("../albedo.png")", "null"}) {
    Json ranges = Json::parse(read_text(folder() / "ranges.json"));
    ranges["albedo"] = Json::parse(albedo);
    std::ofstream(folder() / "ranges.json") << ranges.dump();
    expect_words("albedo is");
  }
}

}  // namespace test_asset_albedo
}  // namespace kiln
