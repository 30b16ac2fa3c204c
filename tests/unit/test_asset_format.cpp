// SPDX-License-Identifier: GPL-3.0-or-later
// The room that reads and writes assets: versions, requirements, faults, and the numbers of docs/format.md.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <numeric>
#include <regex>

#include "asset/check.h"
#include "asset/probe_set.h"
#include "asset/prt_asset.h"
#include "asset/write_asset.h"
#include "base/files.h"
#include "base/json.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"
#include "scratch.h"
#include "sh/light_spec.h"

namespace kiln {
namespace {

namespace fs = std::filesystem;

const fs::path source_folder = KILN_SOURCE_FOLDER;
const fs::path version_1 = source_folder / "tests" / "data" / "version1";

/// A copy of a folder of version 1, and its JSON.
class Copy {
 public:
  explicit Copy(const std::string& name) : name_(name) {
    fs::copy(version_1 / name, folder());
    for (const char* candidate : {ranges_name, pca_name, probes_json_name})
      if (fs::exists(folder() / candidate)) file_ = folder() / candidate;
  }
  fs::path folder() const { return scratch_.folder() / name_; }
  Json read() const { return Json::parse(read_text(file_)); }
  void write(const Json& json) const { std::ofstream(file_) << json.dump(); }

  /// Changes one value of the JSON; null removes a key.
  void set(const std::string& pointer, const Json& value) const {
    Json json = read();
    if (value.is_null())
      json.erase(pointer.substr(1));
    else
      json[Json::json_pointer(pointer)] = value;
    write(json);
  }

  /// Rewrites the folder as version 2.
  void raise(const Json& required) const {
    set("/version", 2);
    set("/requires", required);
  }

 private:
  std::string name_;
  Scratch scratch_;
  fs::path file_;
};

std::vector<std::string> faults_of(const fs::path& folder) {
  std::vector<std::string> texts;
  for (const CheckedFolder& checked : check_folder(folder))
    for (const BadInput& fault : checked.faults) texts.emplace_back(fault.what());
  return texts;
}

std::string joined(const std::vector<std::string>& texts) {
  return std::accumulate(texts.begin(), texts.end(), std::string(),
                         [](const std::string& a, const std::string& b) { return a + b + "\n"; });
}

std::vector<float> all_transfer(const PrtAsset& asset) {
  if (asset.is_per_vertex()) return asset.vertex_transfer;
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(asset.width) * asset.height);
  std::iota(texels.begin(), texels.end(), 0);
  std::vector<float> vectors(texels.size() * asset.vector_length());
  decode_transfer(asset, texels, vectors);
  return vectors;
}

std::string refusal(const fs::path& folder) {
  try {
    load_prt_asset(folder);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "taken";
}

TEST(PlaneRange, StepsAndValuesAreOfOneFormula) {
  const PlaneRange range{-0.25, 0.5};
  for (const int bits : {8, 16}) {
    EXPECT_EQ(range.store(-1, bits), 0u) << "clamped";
    EXPECT_EQ(range.store(1, bits), (1u << bits) - 1);
    // Neighbours differ by a step, up to rounding of doubles of about 1.
    EXPECT_NEAR(range.recover(18, bits) - range.recover(17, bits), range.step(bits), 1e-15);
    const PlaneRange of_steps = PlaneRange::of_steps(range.lowest, range.step(bits), bits);
    EXPECT_NEAR(of_steps.highest, range.highest, 1e-15);
  }
}

TEST(Versions, FoldersOfVersion1AreRead) {
  struct Case {
    const char* name;
    bool clusters, vertices, albedo, tangent;
  };
  for (const Case& c : {Case{"textured", false, false, true, false}, Case{"tangent", false, false, false, true},
                        Case{"vertices", false, true, true, false}, Case{"pca", true, false, true, false}}) {
    SCOPED_TRACE(c.name);
    EXPECT_EQ(joined(faults_of(version_1 / c.name)), "");
    const PrtAsset asset = load_prt_asset(version_1 / c.name);
    EXPECT_EQ(asset.bands, 2);
    EXPECT_EQ(asset.clusters.has_value(), c.clusters);
    EXPECT_EQ(asset.is_per_vertex(), c.vertices);
    EXPECT_EQ(asset.albedo.known, c.albedo);
    EXPECT_EQ(asset.albedo.constant, c.albedo ? Eigen::Vector3f(0.8f, 0.5f, 0.2f) : Eigen::Vector3f(1, 1, 1));
    EXPECT_EQ(asset.normal_space == NormalSpace::tangent, c.tangent);
    // No texel and no vertex sees more than the whole sky. PCA with so few components overshoots.
    const std::vector<float> transfer = all_transfer(asset);
    for (std::size_t k = 0; k < transfer.size() && !c.clusters; k += 4) EXPECT_LT(transfer[k], 0.2825);
  }
  const ProbeSet probes = load_probes(version_1 / "probes");
  EXPECT_EQ(probes.positions.size(), 4u);
  EXPECT_EQ(joined(faults_of(version_1 / "probes")), "");
}

TEST(Versions, Version1StandsForTheSameAsVersion2) {
  const std::vector<std::pair<const char*, Json>> cases = {{"textured", {"albedo"}},
                                                           {"tangent", {"tangent_normals"}},
                                                           {"vertices", {"albedo", "vertices"}},
                                                           {"pca", {"albedo"}}};
  for (const auto& [name, required] : cases) {
    SCOPED_TRACE(name);
    const Copy copy(name);
    const PrtAsset before = load_prt_asset(copy.folder());
    copy.raise(required);
    copy.set("/of_a_later_day", {{"key", "that is ignored"}});
    EXPECT_EQ(joined(faults_of(copy.folder())), "");
    EXPECT_EQ(all_transfer(load_prt_asset(copy.folder())), all_transfer(before));
    // A written description reads back as the one that was read.
    Json rewritten = Json::parse(description_text(load_prt_description(copy.folder()))), expected = copy.read();
    expected.erase("of_a_later_day");
    EXPECT_EQ(nlohmann::json(rewritten), nlohmann::json(expected));
  }
}

TEST(Versions, WhatIsNotKnownIsRefusedByName) {
  const Copy copy("textured");
  copy.raise({"albedo", "holograms"});
  EXPECT_NE(refusal(copy.folder()).find("requires \"holograms\""), std::string::npos) << refusal(copy.folder());
  copy.raise("albedo");
  EXPECT_NE(refusal(copy.folder()).find("requires is no list"), std::string::npos) << refusal(copy.folder());
  copy.set("/requires", nullptr);
  EXPECT_NE(refusal(copy.folder()).find("has no requires"), std::string::npos) << refusal(copy.folder());
  copy.set("/version", 3);
  EXPECT_NE(refusal(copy.folder()).find("version is 3"), std::string::npos) << refusal(copy.folder());
  copy.set("/version", 1);
  EXPECT_EQ(refusal(copy.folder()), "taken");
  const Copy pca("pca");
  pca.raise({"vertices"});
  EXPECT_NE(refusal(pca.folder()).find("requires \"vertices\""), std::string::npos) << "no such thing in pca.json";
}

TEST(Versions, OriginIsReadAndWritten) {
  const Copy copy("vertices");
  copy.set("/origin", {500000.25, -1e-300, 1.0 / 3});
  const PrtDescription asset = load_prt_description(copy.folder());
  EXPECT_EQ(asset.origin, Eigen::Vector3d(500000.25, -1e-300, 1.0 / 3));
  EXPECT_EQ(Json::parse(description_text(asset))["origin"], copy.read()["origin"]);
  EXPECT_NE(joined(faults_of(copy.folder())).find("0, 0, 0, as the mesh has it"), std::string::npos);
  copy.set("/origin", {1, 2});
  EXPECT_NE(refusal(copy.folder()).find("origin is a list of 2"), std::string::npos) << refusal(copy.folder());
}

TEST(Albedo, MayHaveASizeOfItsOwn) {
  const Copy copy("textured");  // 32 x 32
  Image<std::uint8_t> picture(128, 64, 3);
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 128; ++i)
      for (int c = 0; c < 3; ++c) picture.at(i, j, c) = static_cast<std::uint8_t>(i % 4 < 2 ? 255 : c == 0 ? 255 : 0);
  write_png(copy.folder() / "albedo.png", picture);
  copy.raise({"albedo", "albedo_size"});
  copy.set("/albedo", "albedo.png");
  copy.set("/albedo_width", 128);
  copy.set("/albedo_height", 64);
  EXPECT_EQ(joined(faults_of(copy.folder())), "");
  const PrtAsset asset = load_prt_asset(copy.folder());
  EXPECT_EQ(asset.albedo.picture.values(), picture.values());
  // A texel of the planes covers 4 x 2 of the picture: half of them red, half of them white.
  EXPECT_LT((asset.albedo.at(5) - Eigen::Vector3f(1, 0.5f, 0.5f)).norm(), 0.01f);  // 8 bits
  const Json written = Json::parse(description_text(load_prt_description(copy.folder())));
  EXPECT_EQ(written["albedo_width"], 128);
  EXPECT_EQ(written["albedo_height"], 64);

  copy.raise({"albedo"});
  EXPECT_NE(joined(faults_of(copy.folder())).find("requires lacks albedo_size"), std::string::npos);
  copy.raise({"albedo", "albedo_size"});
  copy.set("/albedo_height", 128);
  EXPECT_NE(refusal(copy.folder()).find("is 128 x 64 texels"), std::string::npos) << refusal(copy.folder());
  copy.set("/albedo_height", nullptr);
  EXPECT_NE(refusal(copy.folder()).find("albedo_height"), std::string::npos) << refusal(copy.folder());
}

TEST(Normals, MayHaveASizeOfTheirOwn) {
  const Copy copy("textured");
  write_png(copy.folder() / "normal.png", Image<std::uint8_t>(16, 64, 3, 200));
  EXPECT_NE(joined(faults_of(copy.folder())).find("normal.png"), std::string::npos);
  copy.raise({"albedo", "normal_size"});
  copy.set("/normals", "normal.png");
  copy.set("/normal_width", 16);
  copy.set("/normal_height", 64);
  EXPECT_EQ(joined(faults_of(copy.folder())), "");
  const Json written = Json::parse(description_text(load_prt_description(copy.folder())));
  EXPECT_EQ(written["normal_width"], 16);
  EXPECT_EQ(written["requires"], Json({"albedo", "normal_size"}));
  copy.set("/normal_height", 65);
  EXPECT_NE(joined(faults_of(copy.folder())).find("normal.png"), std::string::npos);
}

TEST(Opacity, IsAPictureOfAnySize) {
  const Copy copy("textured");
  write_png(copy.folder() / "opacity.png", Image<std::uint8_t>(64, 16, 1, 200));
  copy.raise({"albedo", "opacity"});
  copy.set("/opacity", "opacity.png");
  EXPECT_EQ(joined(faults_of(copy.folder())), "");
  EXPECT_EQ(load_prt_asset(copy.folder()).opacity.width(), 64);
  EXPECT_EQ(Json::parse(description_text(load_prt_description(copy.folder())))["opacity"], "opacity.png");
  copy.raise({"albedo"});
  EXPECT_NE(joined(faults_of(copy.folder())).find("requires lacks opacity"), std::string::npos);
  copy.raise({"albedo", "opacity"});
  write_png(copy.folder() / "opacity.png", Image<std::uint8_t>(64, 16, 3, 200));
  EXPECT_NE(refusal(copy.folder()).find("opacity.png"), std::string::npos) << refusal(copy.folder());
  fs::remove(copy.folder() / "opacity.png");
  EXPECT_NE(refusal(copy.folder()).find("opacity.png"), std::string::npos) << refusal(copy.folder());
}

/// A folder of version 2 with a level of detail of one triangle less.
class WithLevel : public Copy {
 public:
  WithLevel() : Copy("textured") {
    raise({"albedo"});
    TriangleMesh mesh = load_prt_asset(folder()).mesh;
    mesh.triangles.pop_back();
    save_draco(folder() / level_file(1), mesh);
    triangles = static_cast<int>(load_draco(folder() / level_file(1)).triangles.size());
    set("/levels", {{{"mesh", level_file(1)}, {"triangles", triangles}, {"error", 0.25}, {"distance", 7.5}}});
  }
  int triangles = 0;
};

TEST(Levels, AreReadWrittenAndLoaded) {
  const WithLevel copy;
  EXPECT_EQ(joined(faults_of(copy.folder())), "");
  const PrtAsset asset = load_prt_asset(copy.folder());
  ASSERT_EQ(asset.levels.size(), 1u);
  EXPECT_EQ(asset.levels[0].triangles, copy.triangles);
  EXPECT_EQ(asset.levels[0].error, 0.25);
  EXPECT_EQ(asset.levels[0].distance, 7.5);
  EXPECT_EQ(Json::parse(description_text(asset)).at("levels"), copy.read().at("levels"));
  EXPECT_FALSE(Json::parse(description_text(asset)).at("requires").contains("levels"));
  EXPECT_EQ(load_level(copy.folder(), asset, 0).triangles.size(), asset.mesh.triangles.size());
  EXPECT_EQ(load_level(copy.folder(), asset, 1).triangles.size(), static_cast<std::size_t>(copy.triangles));
  EXPECT_THROW(load_level(copy.folder(), asset, 2), BadInput);
  EXPECT_THROW(load_level(version_1 / "textured", load_prt_asset(version_1 / "textured"), 1), BadInput);
}

TEST(Levels, FaultsAreToldByName) {
  const auto fault = [](const std::string& pointer, const Json& value) {
    const WithLevel copy;
    copy.set(pointer, value);
    return joined(faults_of(copy.folder()));
  };
  EXPECT_NE(fault("/levels/0/mesh", "lod_9.drc").find("lod_9.drc"), std::string::npos);
  EXPECT_NE(fault("/levels/0/mesh", "../lod_1.drc").find("levels[0].mesh"), std::string::npos);
  EXPECT_NE(fault("/levels/0/triangles", 1).find("lod_1.drc: has"), std::string::npos);
  EXPECT_NE(fault("/levels/0/triangles", 100'000).find("levels[0].triangles is 100000"), std::string::npos);
  EXPECT_NE(fault("/levels/0/error", -1).find("levels[0].error is -1"), std::string::npos);
  EXPECT_NE(fault("/levels/0/distance", "far").find("levels[0].distance"), std::string::npos);
  const Json level = WithLevel().read().at("levels")[0];
  EXPECT_NE(fault("/levels", {level, level}).find("levels[1].triangles is"), std::string::npos);
  Json nearer = level;
  nearer["triangles"] = 1;
  nearer["distance"] = 1;
  EXPECT_NE(fault("/levels", {level, nearer}).find("levels[1].distance is 1"), std::string::npos);
  EXPECT_NE(fault("/levels", Json(17, level)).find("16 levels at most"), std::string::npos);
}

TEST(Check, TellsEveryFault) {
  const Copy copy("textured");
  copy.raise({"vertices"});
  copy.set("/basis", "complex");
  copy.set("/planes/1/min", 7);
  copy.set("/planes/3/file", "../x.png");
  fs::remove(copy.folder() / "atlas.drc");
  std::ofstream(copy.folder() / "coeff_0_00.png") << "GIF89a";
  write_png(copy.folder() / "coeff_0_02.png", Image<std::uint8_t>(16, 32, 1));
  write_png(copy.folder() / "normal.png", Image<std::uint16_t>(32, 32, 1));
  const std::vector<std::string> faults = faults_of(copy.folder());
  for (const char* words : {"requires lacks albedo", "requires vertices, which it does not use", "basis is \"complex\"",
                            "planes[1].min", "planes[3].file", "atlas.drc: ", "coeff_0_00.png: ",
                            "coeff_0_02.png: is 16 x 32", "normal.png: has 1 channels"})
    EXPECT_NE(joined(faults).find(words), std::string::npos) << words << " in\n" << joined(faults);
  EXPECT_EQ(faults.size(), 9u) << joined(faults);
}

TEST(Check, OneFaultIsOneFault) {
  struct Case {
    const char *name, *pointer;
    Json value;
    const char* words;
  };
  const std::vector<Case> cases = {{"textured", "/bands", "2", "bands is \"2\""},
                                   {"textured", "/width", 33, "is 32 x 32 texels"},
                                   {"textured", "/planes", {1}, "planes is a list of 1"},
                                   {"textured", "/planes/1/max", nullptr, "planes[1].max"},
                                   {"textured", "/planes/1/file", "coeff_0_00.png", "twice"},
                                   {"textured", "/mesh", 7, "mesh is 7"},
                                   {"vertices", "/planes/2/attribute", "other", "no attribute 'other'"},
                                   {"vertices", "/planes/2/unique_id", 9, "planes[2].unique_id is 9"},
                                   {"vertices", "/albedo", "albedo.png", "albedo is"},
                                   {"pca", "/clusters", 0, "clusters is 0"},
                                   {"pca", "/coefficient_scales/1", "x", "finite numbers"},
                                   {"pca", "/vector_ranges/1/min", "x", "vector_ranges[1].min"},
                                   {"probes", "/bands", 9, "bands is 9"},
                                   {"probes", "/grid/size", {2, 0, 2}, "grid.size"},
                                   {"probes", "/invalid", {4}, "invalid is 4"},
                                   {"probes", "/ranges", Json::array(), "ranges is a list of 0"}};
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.name) + c.pointer);
    const Copy copy(c.name);
    if (std::string(c.pointer) == "/planes/1/max") {
      Json json = copy.read();
      json["planes"][1].erase("max");
      copy.write(json);
    } else {
      copy.set(c.pointer, c.value);
    }
    const std::vector<std::string> faults = faults_of(copy.folder());
    ASSERT_FALSE(faults.empty());
    EXPECT_NE(joined(faults).find(c.words), std::string::npos) << joined(faults);
    // A width that is wrong is seen in each of four planes and the normal map; a table too short for its clusters
    // beside the number that is at fault.
    const bool shows_often = std::string(c.pointer) == "/width" || std::string(c.pointer) == "/clusters";
    EXPECT_TRUE(shows_often || faults.size() == 1) << joined(faults);
  }
}

TEST(Check, FindsFoldersInAnAssetsFolder) {
  const std::vector<CheckedFolder> all = check_folder(version_1);
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(all[0].format, "kiln-prt-pca");
  EXPECT_EQ(all[1].format, "kiln-probes");
  EXPECT_EQ(all[4].folder.filename(), "vertices");
  for (const CheckedFolder& checked : all) EXPECT_EQ(checked.version, 1);
  EXPECT_NE(joined(faults_of(source_folder / "docs")).find("has no ranges.json"), std::string::npos);
  EXPECT_NE(joined(faults_of(source_folder / "nowhere")).find("is no folder"), std::string::npos);
  const Copy both("textured");
  std::ofstream(both.folder() / "pca.json") << read_text(version_1 / "pca" / "pca.json");
  EXPECT_NE(joined(faults_of(both.folder())).find("has both"), std::string::npos);
}

/// Reads the rows of the table of docs/format.md: "| (i, j) | `light` | R | G | B |".
TEST(WorkedNumbers, AreWhatKilnComputes) {
  const PrtAsset asset = load_prt_asset(source_folder / "examples" / "post");
  const std::string page = read_text(source_folder / "docs" / "format.md");
  const std::regex row(R"(\| \((\d+), (\d+)\) \| `([^`]+)` \| ([-\d.]+) \| ([-\d.]+) \| ([-\d.]+) \|)");
  int rows = 0;
  for (auto match = std::sregex_iterator(page.begin(), page.end(), row); match != std::sregex_iterator();
       ++match, ++rows) {
    SCOPED_TRACE((*match)[0].str());
    const auto texel = static_cast<std::uint32_t>(std::stoi((*match)[2]) * asset.width + std::stoi((*match)[1]));
    std::vector<float> transfer(asset.vector_length());
    decode_transfer(asset, {{texel}}, transfer);
    const std::vector<LightSpec> specs = {parse_light_spec((*match)[3].str())};
    const LightCoefficients light = light_coefficients(specs, asset.bands, LightWindow::hann);
    for (std::size_t c = 0; c < 3; ++c) {
      const double radiance =
          static_cast<double>(asset.albedo.constant[static_cast<int>(c)]) * dot_product(light.channels[c], transfer);
      // The page rounds to 5e-7; floats of lights, transfer and albedo, all below 1, add 25 roundings of 6e-8 at most.
      EXPECT_NEAR(radiance, std::stod((*match)[4 + c]), 5e-7 + 25 * 6e-8);
    }
  }
  EXPECT_EQ(rows, 6);
}

}  // namespace
}  // namespace kiln
