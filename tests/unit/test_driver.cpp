// SPDX-License-Identifier: GPL-3.0-or-later
// The driver's own logic: the pipeline file, the stages' commands, the Makefile's quoting. What make makes of it is in
// tests/cli.
#include <algorithm>
#include <array>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

#include "base/asset_layout.h"
#include "base/errors.h"
#include "kiln/asset_names.h"
#include "kiln/build.h"
#include "kiln/init.h"
#include "kiln/pipeline.h"
#include "pipelines.h"
#include "scratch.h"

namespace kiln {
namespace {

namespace fs = std::filesystem;

constexpr const char* two_assets = R"(
output: made
defaults:
  simplify: {faces: 500}
  bake: {bands: 3}
  report: {lights: ['45,30', 'ambient:1']}
budgets:
  simplify.hausdorff: {max: 0.01}
  atlas.utilisation: {min: 0.6}
assets:
  first: {mesh: a.obj}
  second:
    mesh: {archive: b.tar.gz, member: data/b.off}
    default: false
    simplify: {max-error: 0.02}
    bake: {bands: 4}
    budgets:
      simplify.hausdorff: {max: 0.5}
)";

TEST(Pipeline, AssetsReplaceDefaults) {
  const Pipeline pipeline = pipeline_of(two_assets);
  ASSERT_EQ(pipeline.assets.size(), 2u);
  EXPECT_FALSE(pipeline.assets[0].on_request);
  EXPECT_TRUE(pipeline.assets[1].on_request);
  const std::vector<MakeRule> rules = make_rules(pipeline);
  EXPECT_EQ(value_after(run_of(rules, "first", "simplify").command, "--faces"), "500");
  // --faces and --max-error exclude each other: the asset's own drives out the default.
  EXPECT_EQ(value_after(run_of(rules, "second", "simplify").command, "--max-error"), "0.02");
  EXPECT_EQ(value_after(run_of(rules, "second", "simplify").command, "--faces"), "");
  EXPECT_EQ(value_after(run_of(rules, "second", "bake").command, "--bands"), "4");
  EXPECT_EQ(value_after(run_of(rules, "first", "report").command, "--lights"), "45,30; ambient:1");
  EXPECT_EQ(pipeline.assets[0].budgets,
            (std::vector<std::string>{"atlas.utilisation>=0.6", "simplify.hausdorff<=0.01"}));
  EXPECT_EQ(pipeline.assets[1].budgets,
            (std::vector<std::string>{"atlas.utilisation>=0.6", "simplify.hausdorff<=0.5"}));
}

TEST(Pipeline, ArchivesAreExtractedFirst) {
  const std::vector<MakeRule> rules = make_rules(pipeline_of(two_assets));
  const StageRun& extract = run_of(rules, "second", "extract");
  EXPECT_EQ(extract.inputs, std::vector<fs::path>{"b.tar.gz"});
  EXPECT_EQ(extract.outputs, std::vector<fs::path>{"made/second/high/b.off"});
  const std::vector<fs::path>& inputs = run_of(rules, "second", "simplify").inputs;
  EXPECT_NE(std::find(inputs.begin(), inputs.end(), extract.outputs[0]), inputs.end());
}

TEST(Pipeline, EveryInputIsMadeBeforeOrGiven) {
  const std::vector<MakeRule> rules = make_rules(pipeline_of(two_assets));
  std::vector<fs::path> there = {"a.obj", "b.tar.gz"};
  for (const MakeRule& rule : rules) {
    for (const fs::path& input : rule.run.inputs)
      EXPECT_NE(std::find(there.begin(), there.end(), input), there.end())
          << rule.asset << " " << rule.run.name << " " << input;
    there.insert(there.end(), rule.run.outputs.begin(), rule.run.outputs.end());
  }
}

TEST(Pipeline, BakeMakesOnePlanePerCoefficient) {
  const std::vector<fs::path> outputs = run_of(make_rules(pipeline_of(two_assets)), "second", "bake").outputs;
  EXPECT_NE(std::find(outputs.begin(), outputs.end(), "made/second/prt/coeff_0_15.png"), outputs.end());
  EXPECT_EQ(std::find(outputs.begin(), outputs.end(), "made/second/prt/coeff_0_16.png"), outputs.end());
}

bool passes(const std::vector<MakeRule>& rules, const std::string& asset, const std::string& stage) {
  return std::any_of(rules.begin(), rules.end(),
                     [&](const MakeRule& rule) { return rule.asset == asset && rule.run.name == stage; });
}

TEST(Pipeline, CompressesOnRequest) {
  EXPECT_FALSE(passes(make_rules(pipeline_of(two_assets)), "first", "compress"));
  const Pipeline pipeline = pipeline_of(R"(
defaults:
  compress: {max-error: 0.01}
budgets:
  compress.error: {max: 0.01}
assets:
  small: {mesh: a.obj}
  smaller: {mesh: a.obj, compress: {clusters: 64}}
  plain: {mesh: a.obj, compress: false}
)");
  const std::vector<MakeRule> rules = make_rules(pipeline);
  // Runs between the bake, whose record it waits for, and the report, which uses it.
  const StageRun& compress = run_of(rules, "smaller", "compress");
  EXPECT_EQ(compress.command, (std::vector<std::string>{"kiln-compress", "out/smaller/prt/", "-o", "out/smaller/small/",
                                                        "--max-error", "0.01", "--clusters", "64"}));
  EXPECT_TRUE(contains(compress.inputs, "out/smaller/prt/bake.json"));
  const StageRun& report = run_of(rules, "smaller", "report");
  EXPECT_TRUE(contains(report.inputs, "out/smaller/small/compress.json"));
  EXPECT_EQ(value_after(report.command, "--compressed"), "out/smaller/small/");
  EXPECT_EQ(value_after(run_of(rules, "small", "compress").command, "--clusters"), "");
  // An asset that is not compressed is not held to that budget.
  EXPECT_FALSE(passes(rules, "plain", "compress"));
  EXPECT_EQ(value_after(run_of(rules, "plain", "report").command, "--compressed"), "");
  EXPECT_EQ(pipeline.assets[0].budgets, std::vector<std::string>{"compress.error<=0.01"});
  EXPECT_TRUE(pipeline.assets[2].budgets.empty());
  EXPECT_TRUE(passes(make_rules(pipeline_of("assets:\n  a: {mesh: x.obj, compress: true}\n")), "a", "compress"));
}

TEST(Pipeline, LevelsOfDetailOnRequest) {
  EXPECT_FALSE(passes(make_rules(pipeline_of(two_assets)), "first", "lod"));
  const std::vector<MakeRule> rules = make_rules(pipeline_of(R"(
defaults:
  lod: [1, 0.5, 0.25]
assets:
  shares: {mesh: a.obj}
  pixels: {mesh: a.obj, lod: {pixels: [1, 4]}}
  none: {mesh: a.obj, lod: false}
)"));
  // Runs between the atlas and the bake, which ships what it makes.
  const StageRun& lod = run_of(rules, "shares", "lod");
  EXPECT_EQ(lod.command,
            (std::vector<std::string>{"kiln-lod", "out/shares/atlas.drc", "--high", value_after(lod.command, "--high"),
                                      "-o", "out/shares/lod/", "--levels", "1; 0.5; 0.25"}));
  EXPECT_TRUE(contains(lod.inputs, "out/shares/atlas.drc"));
  const StageRun& bake = run_of(rules, "shares", "bake");
  EXPECT_EQ(value_after(bake.command, "--levels"), "out/shares/lod/");
  EXPECT_TRUE(contains(bake.inputs, "out/shares/lod/lod.json"));
  EXPECT_TRUE(contains(bake.outputs, "out/shares/prt/lod_1.drc"));
  EXPECT_TRUE(contains(run_of(rules, "shares", "report").inputs, "out/shares/lod/lod.json"));
  const StageRun& pixels = run_of(rules, "pixels", "lod");
  EXPECT_EQ(value_after(pixels.command, "--pixels"), "1; 4");
  EXPECT_EQ(value_after(pixels.command, "--levels"), "");
  EXPECT_EQ(value_after(run_of(rules, "none", "bake").command, "--levels"), "");
  EXPECT_FALSE(passes(rules, "none", "lod"));
  EXPECT_NE(refusal("assets:\n  a:\n    mesh: x.obj\n    lod: [0.5, 0.75]\n").find("pipeline.yaml:4: '0.5; 0.75'"),
            std::string::npos);
  EXPECT_NE(refusal("assets:\n  a:\n    mesh: x.obj\n    bake: [5]\n").find("pipeline.yaml:4: "), std::string::npos);
}

TEST(Pipeline, ProbesOnRequest) {
  EXPECT_FALSE(passes(make_rules(pipeline_of(two_assets)), "first", "probes"));
  const Pipeline pipeline = pipeline_of(R"(
defaults:
  probes: {grid: 2x2x2}
  import: {up: +z, fill-holes: 4}
  material: {albedo: 0.5}
budgets:
  probes.invalid: {max: 0}
assets:
  grid: {mesh: a.obj, probes: {bands: 3, up: -y}}
  points: {mesh: a.obj, probes: {points: at/some.txt}}
  none: {mesh: a.obj, probes: false}
)");
  const std::vector<MakeRule> rules = make_rules(pipeline);
  const StageRun& grid = run_of(rules, "grid", "probes");
  // The mesh is read as the first stage reads it, but for what the stage says itself.
  EXPECT_EQ(grid.command,
            (std::vector<std::string>{"kiln-probes", "a.obj", "-o", "out/grid/probes/", "--grid", "2x2x2", "--bands",
                                      "3", "--albedo", "0.5", "--up=-y", "--fill-holes", "4"}));
  EXPECT_EQ(grid.inputs, std::vector<fs::path>{"a.obj"});
  EXPECT_EQ(value_after(run_of(rules, "grid", "report").command, "--probes"), "out/grid/probes/");
  EXPECT_TRUE(contains(run_of(rules, "grid", "report").inputs, "out/grid/probes/probes.json"));
  // Points drive out a grid that is the default, and are read.
  const StageRun& points = run_of(rules, "points", "probes");
  EXPECT_EQ(value_after(points.command, "--points"), "at/some.txt");
  EXPECT_EQ(value_after(points.command, "--grid"), "");
  EXPECT_TRUE(contains(points.inputs, "at/some.txt"));
  EXPECT_FALSE(passes(rules, "none", "probes"));
  EXPECT_TRUE(pipeline.assets[2].budgets.empty());
  EXPECT_NE(
      refusal("assets:\n  a:\n    mesh: x.obj\n    probes: {grid: 2x2}\n").find("pipeline.yaml:4: '2x2' for grid"),
      std::string::npos);
}

TEST(Stages, AreWhollyDescribed) {
  AssetPlan plan;
  plan.mesh = "a.obj";
  plan.folder = "out/a";
  for (const StageInfo* stage : all_stages()) {
    SCOPED_TRACE(stage->name);
    plan.settings[stage->name];
    const StageRun run = stage->run(plan);
    EXPECT_EQ(run.name, stage->name);
    EXPECT_EQ(run.command.front(), "kiln-" + stage->name);
    // The record first, in the folder that all others look for it in.
    EXPECT_EQ(run.outputs.front(), layout::record(plan.folder, stage->name));
    EXPECT_FALSE(stage->metrics.empty());
    for (const auto& [one, other] : stage->rivals) {
      EXPECT_NE(stage->options().find(one), nullptr) << one;
      EXPECT_NE(stage->options().find(other), nullptr) << other;
    }
    for (const MetricGroup& group : stage->metrics) EXPECT_EQ(group.prefix.empty(), group.is_written == nullptr);
  }
  EXPECT_EQ(stage_names().front(), "simplify");
  EXPECT_EQ(stage_names().back(), "report") << "it reads all others";
}

TEST(Pipeline, RefusalsNameTheLine) {
  EXPECT_NE(refusal("assets:\n  a:\n    mesh: x.obj\n    compress: much\n").find("pipeline.yaml:4: 'much'"),
            std::string::npos);
  EXPECT_NE(refusal("assets:\n  a:\n    mesh: x.obj\n    budgets:\n      compress.error: {max: 1}\n")
                .find("pipeline.yaml:5: a budget for 'compress.error', and no compress of asset 'a'"),
            std::string::npos);
  EXPECT_NE(refusal("assets:\n  a:\n    mesh: x.obj\n    bake: {directions: -3}\n")
                .find("pipeline.yaml:4: '-3' for directions of bake"),
            std::string::npos);
  EXPECT_NE(refusal("assets:\n  a:\n    mesh: x.obj\n    cook: {}\n").find("pipeline.yaml:4: unknown key 'cook'"),
            std::string::npos);
  EXPECT_NE(
      refusal("defaults:\n  bake:\n    backend: cuda\nassets: {a: {mesh: x}}\n").find("egl, mixed, beams or embree"),
      std::string::npos);
  EXPECT_EQ(refusal("assets:\n  a: {mesh: x.obj}\n"), "");
}

TEST(Pipeline, SelectsByNameOrDefault) {
  const Pipeline pipeline = pipeline_of(two_assets);
  EXPECT_EQ(select_assets(pipeline, {}).size(), 1u);
  EXPECT_EQ(select_assets(pipeline, {"second", "second"}).size(), 1u);
  EXPECT_THROW(select_assets(pipeline, {"third"}), WrongUsage);
}

TEST(Pipeline, AssetsOfVerticesPassNoStageForTexels) {
  const Pipeline pipeline = pipeline_of(
      "budgets: {atlas.charts: {max: 9}}\nassets:\n  dots: {mesh: a.obj, bake: {per-vertex: true}}\n  texels: {mesh: "
      "a.obj, bake: {per-vertex: false}}\n");
  EXPECT_TRUE(pipeline.assets[0].budgets.empty()) << "a budget for all is for those that pass the stage";
  EXPECT_EQ(pipeline.assets[1].budgets.size(), 1u);
  std::vector<std::string> names;
  for (const MakeRule& rule : make_rules(pipeline))
    if (rule.asset == "dots") {
      names.push_back(rule.run.name);
      for (const std::filesystem::path& input : rule.run.inputs)
        EXPECT_EQ(input.string().find("atlas"), std::string::npos) << input;
    }
  EXPECT_EQ(names, (std::vector<std::string>{"simplify", "bake", "report"}));
}

TEST(Pipeline, WhatCannotWorkIsRefusedAtOnce) {
  const auto refusal_of = [](const std::string& settings) {
    return refusal("assets:\n  a:\n    mesh: x.obj\n    " + settings + "\n");
  };
  const std::pair<const char*, const char*> cases[] = {
      {"atlas: {uv: keep}", "'keep' for uv of atlas"},
      {"bake: {per-vertex: true}\n    lod: [0.5]", "'true' for per-vertex of bake"},
      {"bake: {per-vertex: true, adaptive: 0.01}", "for adaptive of bake"},
      {"bake: {per-vertex: true, ship: 'maps=ao'}", "for ship of bake"},
      {"budgets: {atlas.charts: {max: 9}}\n    bake: {per-vertex: true}", "a stage that the asset passes"},
      {"budgets: {report.error.causes.texels: {max: 0.1}}\n    bake: {per-vertex: true}",
       "set per-vertex: false of bake"},
      {"bake: {size: 64}", "'64' for size of bake"},
      {"bake: {bits: 12}", "8 or 16"},
      {"bake: {max-error: 2}", "above 0 and below 1"},
      {"bake: {ground: '0,0'}", "a size above 0"},
      {"bake: {gl-device: cuda}", "auto, software or a number"},
      {"bake: {subsurface: custom}", "no --subsurface-scattering"},
      {"bake: {subsurface: marble, bake-albedo: true}", "bake-albedo"},
      {"bake: {receiver: low, bounces: 1}", "the low mesh has no materials"},
      {"compress: {max-error: 7}", "'7'"},
      {"compress: {pca: 26}", "at most 25"},
      {"simplify: {max-error: 1e-7}", "0.0001 to 1"},
      {"report: {lights: ['45']}", "AZIMUTH,ELEVATION"},
      {"report: {lights: []}", "at least one light"},
      {"budgets: {simplify.hausdorf: {max: 1}}", "'simplify.hausdorff'"},
      {"budgets: {bake.verification.error: {max: 1}}", "set verify-directions of bake"},
      {"budgets: {report.compressed_relative_l2: {max: 1}}", "set compress"},
  };
  for (const auto& [settings, word] : cases) {
    const std::string message = refusal_of(settings);
    EXPECT_NE(message.find("pipeline.yaml:4: "), std::string::npos) << settings << ": " << message;
    EXPECT_NE(message.find(word), std::string::npos) << settings << ": " << message;
  }
  for (const char* settings : {"bake: {receiver: low}", "bake: {receiver: low, bounces: 1, albedo: 0.5}",
                               "bake: {max-error: auto}", "compress: {pca: 25}", "atlas: {uv: auto}",
                               "atlas: {uv: new}", "report: {lights: ['cone:45,30,5', 'ambient:1,0.5,0']}"})
    EXPECT_EQ(refusal_of(settings), "") << settings;
}

TEST(Pipeline, ALowMeshOfItsOwnIsAnInputAndIsNotSimplified) {
  const Pipeline pipeline = pipeline_of(
      "defaults:\n  simplify: {faces: 500, quality: best, colors: true, low-unit: cm}\n"
      "assets:\n  a: {mesh: a.obj, low: low/a.glb, simplify: {low-up: +z}}\n  b: {mesh: b.obj}\n");
  const StageSettings& settings = pipeline.assets[0].settings.at("simplify");
  EXPECT_EQ(settings, (StageSettings{{"low", "low/a.glb"}, {"low-up", "+z"}, {"low-unit", "cm"}, {"colors", "true"}}));
  EXPECT_TRUE(pipeline.assets[0].setting_lines.at("simplify").at("low").ends_with("/pipeline.yaml:4"));
  const std::vector<MakeRule> rules = make_rules(pipeline);
  EXPECT_EQ(rules[0].run.inputs, (std::vector<fs::path>{"a.obj", "low/a.glb"}));
  EXPECT_EQ(pipeline.assets[1].settings.at("simplify").at("faces"), "500");
  const auto of_b = std::find_if(rules.begin(), rules.end(), [](const MakeRule& rule) { return rule.asset == "b"; });
  EXPECT_EQ(std::count(of_b->run.command.begin(), of_b->run.command.end(), "--low-unit"), 0);

  const auto refusal_of = [](const std::string& keys) { return refusal("assets:\n  a:\n    mesh: a.obj\n" + keys); };
  for (const auto& [keys, line, word] : std::initializer_list<std::array<const char*, 3>>{
           {"    low: {archive: a.tar, member: a.obj}\n", ":4: ", "a mapping for low"},
           {"    low: [a.obj]\n", ":4: ", "no file for low"},
           {"    low: a.glb\n    simplify: {faces: 5}\n", ":5: ", "faces of simplify"},
           {"    low: a.glb\n    simplify: {low: b.glb}\n", ":5: ", "low of simplify"},
           {"    simplify: {low: a.glb, quality: best}\n", ":4: ", "both low and quality"}}) {
    const std::string message = refusal_of(keys);
    EXPECT_NE(message.find(line), std::string::npos) << keys << message;
    EXPECT_NE(message.find(word), std::string::npos) << keys << message;
  }
}

TEST(Pipeline, NamesAndCagesMakeFilesInputsOfNormals) {
  const std::string low = "assets:\n  a:\n    mesh: a.obj\n    low: a.glb\n";
  const auto inputs_of = [&](const std::string& settings) {
    const std::vector<MakeRule> rules = make_rules(pipeline_of(low + settings));
    const StageRun& run = run_of(rules, "a", "normals");
    EXPECT_EQ(value_after(run.command, "--low"), settings.empty() ? "" : "a.glb") << settings;
    std::set<std::string> names;
    for (const fs::path& input : run.inputs) names.insert(input.string());
    return names;
  };
  EXPECT_FALSE(inputs_of("").contains("a.glb"));
  EXPECT_TRUE(inputs_of("    normals: {match: names}\n").contains("a.glb"));
  const std::set<std::string> with_cage = inputs_of("    normals: {cage-mesh: cage.obj}\n");
  EXPECT_TRUE(with_cage.contains("a.glb") && with_cage.contains("cage.obj"));
  for (const auto& [settings, word] : std::initializer_list<std::array<const char*, 2>>{
           {"normals: {match: names}", "add 'low: FILE'"},
           {"normals: {cage-mesh: a.obj}", "whose cage it is"},
           {"normals: {part-cage: 'a=0.1'}", "'match: names' beside it"},
           {"normals: {part-cage: 'a'}", "NAME=CAGE"},
           {"normals: {cage: 0.1, cage-mesh: a.obj}", "both cage and cage-mesh"}}) {
    const std::string message = refusal("assets:\n  a:\n    mesh: x.obj\n    " + std::string(settings) + "\n");
    EXPECT_NE(message.find(word), std::string::npos) << settings << ": " << message;
  }
}

TEST(Pipeline, ALowReceiverIsShadowedByItself) {
  const std::vector<MakeRule> rules =
      make_rules(pipeline_of("assets:\n  low: {mesh: a.obj, bake: {receiver: low}}\n  high: {mesh: a.obj}\n"));
  // kiln-bake takes the atlas itself where no occluder is named.
  EXPECT_EQ(value_after(run_of(rules, "low", "bake").command, "--occluder"), "");
  EXPECT_EQ(value_after(run_of(rules, "high", "bake").command, "--occluder"), "a.obj");
}

TEST(Pipeline, TabsThatIndentAreNamed) {
  EXPECT_NE(refusal("assets:\n\ta: {mesh: x.obj}\n").find("pipeline.yaml:2: a tab"), std::string::npos);
  EXPECT_NE(refusal("# \tnot this\nassets:\n  a:\n\t  mesh: x.obj\n").find("pipeline.yaml:4: a tab"),
            std::string::npos);
  EXPECT_EQ(refusal("assets:\t\n  a:\tx.obj\n").find("a tab"), std::string::npos) << "it indents nothing";
}

class Names : public testing::Test {
 protected:
  void make(const std::string& file) const {
    fs::create_directories((scratch_.folder() / file).parent_path());
    std::ofstream(scratch_.folder() / file, std::ios::binary) << "x";
  }
  std::vector<std::string> names_of(const std::string& text) const {
    std::vector<std::string> names;
    for (const Asset& asset : pipeline_in(scratch_.folder(), text).assets)
      names.push_back(asset.name + "=" + asset.mesh.string());
    return names;
  }
  std::string refusal_of(const std::string& text) const {
    try {
      names_of(text);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }

  Scratch scratch_;
};

TEST_F(Names, PatternsAreFilesInOrder) {
  for (const char* file : {"scans/b.ply", "scans/a.ply", "scans/.c.ply", "scans/d.obj", "scans/e.ply/x"}) make(file);
  EXPECT_EQ(names_of("assets:\n  scans/*.ply: {simplify: {faces: 9}}\n"),
            (std::vector<std::string>{"a=scans/a.ply", "b=scans/b.ply"}));
  EXPECT_EQ(names_of("assets: ['scans/{d,a}.*']\n"), (std::vector<std::string>{"a=scans/a.ply", "d=scans/d.obj"}));
  EXPECT_NE(refusal_of("assets: ['*.stl']\n").find("'*.stl', which no file matches"), std::string::npos);
  EXPECT_NE(refusal_of("assets: [scans/a.ply, 'scans/*.ply']\n").find("a second time"), std::string::npos);
  make("more/a.obj");
  EXPECT_NE(refusal_of("assets: ['*/a.*']\n").find("both be the asset 'a'"), std::string::npos);
}

TEST_F(Names, AFileOfAPatternsCharactersIsThatFile) {
  make("[ab].obj");
  make("a.obj");
  EXPECT_EQ(names_of("assets: ['[ab].obj']\n"), (std::vector<std::string>{"[ab]=[ab].obj"}));
}

TEST_F(Names, NamedSettingsRefineAPattern) {
  make("a.ply");
  make("b.ply");
  const Pipeline pipeline = pipeline_in(scratch_.folder(), R"(
defaults: {simplify: {faces: 1000}}
assets:
  '*.ply': {simplify: {faces: 200}, bake: {bands: 3}}
  b: {simplify: {max-error: 0.01}, default: false}
)");
  const std::vector<MakeRule> rules = make_rules(pipeline);
  EXPECT_EQ(value_after(run_of(rules, "a", "simplify").command, "--faces"), "200");
  EXPECT_EQ(value_after(run_of(rules, "b", "simplify").command, "--faces"), "");
  EXPECT_EQ(value_after(run_of(rules, "b", "simplify").command, "--max-error"), "0.01");
  EXPECT_EQ(value_after(run_of(rules, "b", "bake").command, "--bands"), "3");
  EXPECT_EQ(select_assets(pipeline, {}).size(), 1u);
}

TEST_F(Names, IncludedFilesAreWeaker) {
  fs::create_directories(scratch_.folder() / "shared");
  std::ofstream(scratch_.folder() / "shared/all.yaml")
      << "include: most.yaml\ndefaults: {simplify: {faces: 10}, material: {texture: wood.png}}\n";
  std::ofstream(scratch_.folder() / "shared/paint.yaml") << "defaults: {material: {reflectance: TCS05}}\n";
  std::ofstream(scratch_.folder() / "shared/most.yaml")
      << "defaults: {simplify: {faces: 5}, bake: {bands: 2}}\nbudgets: {simplify.rms: {max: 1}}\n";
  std::ofstream(scratch_.folder() / "props.yaml") << "defaults: {bake: {bands: 4}}\n";
  const Pipeline pipeline = pipeline_in(scratch_.folder(), R"(
include: shared/all.yaml
defaults: {atlas: {size: 64}}
assets:
  a: {mesh: a.obj}
  b: {mesh: b.obj, include: [props.yaml], simplify: {faces: 20}}
  c: {mesh: c.obj, include: [shared/paint.yaml]}
)");
  const std::vector<MakeRule> rules = make_rules(pipeline);
  EXPECT_EQ(value_after(run_of(rules, "c", "bake").command, "--reflectance"), "TCS05");  // a name, and no path
  EXPECT_EQ(value_after(run_of(rules, "c", "bake").command, "--albedo-texture"), "");
  EXPECT_EQ(value_after(run_of(rules, "a", "simplify").command, "--faces"), "10");
  EXPECT_EQ(value_after(run_of(rules, "b", "simplify").command, "--faces"), "20");
  EXPECT_EQ(value_after(run_of(rules, "a", "bake").command, "--bands"), "2");
  EXPECT_EQ(value_after(run_of(rules, "b", "bake").command, "--bands"), "4");
  EXPECT_EQ(value_after(run_of(rules, "a", "atlas").command, "--size"), "64");
  // A path is relative to the file it stands in.
  EXPECT_EQ(value_after(run_of(rules, "a", "normals").command, "--albedo-texture"), "shared/wood.png");
  EXPECT_EQ(pipeline.assets[0].budgets, std::vector<std::string>{"simplify.rms<=1"});

  std::ofstream(scratch_.folder() / "props.yaml") << "include: props.yaml\n";
  EXPECT_NE(refusal_of("include: props.yaml\nassets: {a: {mesh: a.obj}}\n").find("include one another"),
            std::string::npos);
  std::ofstream(scratch_.folder() / "props.yaml") << "defaults:\n  bake: {bands: 99}\n";
  EXPECT_NE(refusal_of("include: props.yaml\nassets: {a: {mesh: a.obj}}\n").find("props.yaml:2: '99'"),
            std::string::npos);
}

TEST(AssetNames, AreOfAnyScript) {
  for (const char* name : {"a", "Старый дуб", "木の像", "🌲👩‍🎨", "it's", "a.b", "a (2)", "#1", "$x", "100%"})
    EXPECT_EQ(fault_of_name(name), "") << name;
  for (const char* name : {"", ".a", "-a", " a", "a ", "a.", "a/b", "a\\b", "a:b", "a*", "a?", "a\nb", "a\x7f",
                           "a\xc2\x85", "a\xe2\x80\xa8", "caf\xe9", "Makefile", "index.html", "a.yaml"})
    EXPECT_NE(fault_of_name(name), "") << name;
  EXPECT_NE(fault_of_name(std::string(201, 'a')), "");
}

TEST(AssetNames, OfMeshesArePermitted) {
  EXPECT_EQ(name_of_mesh("scans/Model (2).obj"), "Model (2)");
  EXPECT_EQ(name_of_mesh("caf\xe9 木.obj"), "caf_ 木");
  EXPECT_EQ(name_of_mesh("a:b\n.obj"), "a_b_");
  EXPECT_EQ(name_of_mesh("-x.obj"), "_-x");
  EXPECT_EQ(name_of_mesh(".obj"), "_.obj");
  for (const char* mesh : {"Makefile.obj", "a..obj", "a .obj", "x.yaml.obj"})
    EXPECT_EQ(fault_of_name(name_of_mesh(mesh)), "") << mesh;
  EXPECT_EQ(fault_of_name(name_of_mesh(std::string(199, 'a') + "木.obj")), "");
}

TEST(Init, WritesWhatIsReadBack) {
  const Scratch scratch;
  std::vector<fs::path> meshes;
  for (const char* name : {"Model (2).obj", "it's.ply", "a: b.stl", "new\nline.obj", "caf\xe9.obj", "-x.obj",
                           "true.obj", "tab\t\"quoted\".obj", "back\\slash.obj", "1.obj", "1.ply", "木.OBJ"}) {
    meshes.push_back(scratch.folder() / name);
    std::ofstream(meshes.back(), std::ios::binary) << "x";
  }
  const fs::path file = scratch.folder() / "new" / "pipeline.yaml";
  init_pipeline(meshes, file);
  const Pipeline pipeline = load_pipeline(file);
  ASSERT_EQ(pipeline.assets.size(), meshes.size());
  for (std::size_t k = 0; k < meshes.size(); ++k)
    EXPECT_EQ(fs::weakly_canonical(pipeline.folder / pipeline.assets[k].mesh), fs::weakly_canonical(meshes[k]));
  EXPECT_EQ(pipeline.assets[10].name, "1_2");
  EXPECT_THROW(init_pipeline(meshes, file), BadInput) << "it is there";
  EXPECT_THROW(init_pipeline({meshes[0], meshes[0]}, scratch.folder() / "b.yaml"), BadInput);
  EXPECT_THROW(init_pipeline({scratch.folder() / "no.obj"}, scratch.folder() / "b.yaml"), BadInput);
  EXPECT_THROW(init_pipeline({file}, scratch.folder() / "b.yaml"), BadInput) << "no mesh";
}

TEST(Makefile, QuotesForTheShell) {
  EXPECT_EQ(shell_quoted("a-b_1.obj"), "a-b_1.obj");
  EXPECT_EQ(shell_quoted("a b$c"), "'a b$c'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shown_command({"a", "b c", "d\ne"}), "a 'b c' 'd\\012e'");
}

TEST(Makefile, HoldsNoFileNames) {
  // Whatever make makes of a name, it is in the plans.
  const std::vector<MakeRule> rules = make_rules(pipeline_of("assets:\n  all: {mesh: \"a\\n$(x) %.obj\"}\n"));
  std::istringstream lines(makefile_text(rules, "/bin"));
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.starts_with("#") || line.find("(x)") == std::string::npos) << line;
  const std::vector<std::vector<std::size_t>> needs = needs_of(rules);
  ASSERT_EQ(needs.size(), 5u);
  EXPECT_EQ(needs[0], std::vector<std::size_t>{});
  EXPECT_EQ(needs[3], (std::vector<std::size_t>{1, 2})) << "a bake reads the atlas and the normals";
}

TEST(Build, GravestStatus) {
  EXPECT_EQ(gravest_status({}), 0);
  EXPECT_EQ(gravest_status({0, 4, 0}), 4);
  EXPECT_EQ(gravest_status({4, 3, 2}), 3);
  EXPECT_EQ(gravest_status({3, 5}), 5);
  EXPECT_EQ(gravest_status({5, 1, 3}), 1);
  EXPECT_EQ(gravest_status({139, 5}), 1);
}

}  // namespace
}  // namespace kiln
