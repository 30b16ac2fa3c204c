// The driver's own logic: the pipeline file, the stages' commands, the Makefile's quoting. What make makes of it is in
// tests/cli.
#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "kiln/build.h"
#include "kiln/pipeline.h"
#include "scratch.h"

namespace kiln {
namespace {

namespace fs = std::filesystem;

Pipeline pipeline_in(const fs::path& folder, const std::string& text) {
  std::ofstream(folder / "pipeline.yaml") << text;
  return load_pipeline(folder / "pipeline.yaml");
}

Pipeline pipeline_of(const std::string& text) {
  const Scratch scratch;  // of this test alone: CTest runs several at once
  return pipeline_in(scratch.folder(), text);
}

std::string refusal(const std::string& text) {
  try {
    pipeline_of(text);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

const StageRun& run_of(const std::vector<MakeRule>& rules, const std::string& asset, const std::string& stage) {
  const auto found = std::find_if(rules.begin(), rules.end(),
                                  [&](const MakeRule& rule) { return rule.asset == asset && rule.run.name == stage; });
  if (found == rules.end()) throw std::runtime_error("no such rule");
  return found->run;
}

std::string value_after(const std::vector<std::string>& command, const std::string& option) {
  const auto found = std::find(command.begin(), command.end(), option);
  return found == command.end() || found + 1 == command.end() ? "" : *(found + 1);
}

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

bool contains(const std::vector<fs::path>& paths, const char* path) {
  return std::find(paths.begin(), paths.end(), path) != paths.end();
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
  // Between the bake, whose record it waits for, and the report, which is told of it.
  const StageRun& compress = run_of(rules, "smaller", "compress");
  EXPECT_EQ(compress.command, (std::vector<std::string>{"kiln-compress", "out/smaller/prt/", "-o", "out/smaller/small/",
                                                        "--max-error", "0.01", "--clusters", "64"}));
  EXPECT_TRUE(contains(compress.inputs, "out/smaller/prt/bake.json"));
  const StageRun& report = run_of(rules, "smaller", "report");
  EXPECT_TRUE(contains(report.inputs, "out/smaller/small/compress.json"));
  EXPECT_EQ(value_after(report.command, "--compressed"), "out/smaller/small/");
  EXPECT_EQ(value_after(run_of(rules, "small", "compress").command, "--clusters"), "");
  // An asset that does without is not held to a budget for all.
  EXPECT_FALSE(passes(rules, "plain", "compress"));
  EXPECT_EQ(value_after(run_of(rules, "plain", "report").command, "--compressed"), "");
  EXPECT_EQ(pipeline.assets[0].budgets, std::vector<std::string>{"compress.error<=0.01"});
  EXPECT_TRUE(pipeline.assets[2].budgets.empty());
  EXPECT_TRUE(passes(make_rules(pipeline_of("assets:\n  a: {mesh: x.obj, compress: true}\n")), "a", "compress"));
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
  EXPECT_NE(refusal("defaults:\n  bake:\n    backend: cuda\nassets: {a: {mesh: x}}\n").find("egl, beams or embree"),
            std::string::npos);
  EXPECT_NE(refusal("assets:\n  a: {mesh: 'x:y.obj'}\n").find("':' in the path"), std::string::npos);
  EXPECT_EQ(refusal("assets:\n  a: {mesh: x.obj}\n"), "");
}

TEST(Pipeline, SelectsByNameOrDefault) {
  const Pipeline pipeline = pipeline_of(two_assets);
  EXPECT_EQ(select_assets(pipeline, {}).size(), 1u);
  EXPECT_EQ(select_assets(pipeline, {"second", "second"}).size(), 1u);
  EXPECT_THROW(select_assets(pipeline, {"third"}), WrongUsage);
}

TEST(Makefile, QuotesForShellAndMake) {
  EXPECT_EQ(shell_quoted("a-b_1.obj"), "a-b_1.obj");
  EXPECT_EQ(shell_quoted("a b$c"), "'a b$c'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(make_quoted("a b#c$d"), "a\\ b\\#c$$d");
}

TEST(Build, GravestStatus) {
  EXPECT_EQ(gravest_status({}), 0);
  EXPECT_EQ(gravest_status({0, 4, 0}), 4);
  EXPECT_EQ(gravest_status({4, 3, 2}), 3);
  EXPECT_EQ(gravest_status({3, 5}), 5);
  EXPECT_EQ(gravest_status({5, 1, 3}), 1);
  EXPECT_EQ(gravest_status({139, 5}), 1);
}

constexpr const char* scene = R"(
output: made
assets:
  bunny:
    mesh: bunny.obj
    material: {albedo: [0.5, 0.4, 0.3]}
    simplify: {fill-holes: 8}
  floor:
    mesh: {square: 2.5}
    material: {texture: wood.png, encoding: linear}
  lamp: {mesh: lamp.obj}
scene:
  bunny: [0, 1, 0, 45]
  floor: 0,0,0
)";

TEST(Scene, NeighboursShadowEachOther) {
  const std::vector<MakeRule> rules = make_rules(pipeline_of(scene));
  const StageRun& bunny = run_of(rules, "bunny", "bake");
  EXPECT_EQ(value_after(bunny.command, "--place"), "0,1,0,45");
  EXPECT_EQ(value_after(bunny.command, "--neighbour"),
            "made/floor/high/square.obj;place=0,0,0;albedo-texture=wood.png;albedo-encoding=linear");
  EXPECT_TRUE(contains(bunny.inputs, "made/floor/high/square.obj"));
  const StageRun& floor = run_of(rules, "floor", "bake");
  EXPECT_EQ(value_after(floor.command, "--neighbour"), "bunny.obj;place=0,1,0,45;albedo=0.5,0.4,0.3;fill-holes=8");
  EXPECT_TRUE(contains(floor.inputs, "bunny.obj"));
  EXPECT_EQ(value_after(run_of(rules, "lamp", "bake").command, "--place"), "") << "not in the scene";
  EXPECT_EQ(value_after(run_of(rules, "lamp", "bake").command, "--neighbour"), "");
}

TEST(Scene, SquaresAreMadeFirst) {
  const std::vector<MakeRule> rules = make_rules(pipeline_of(scene));
  const StageRun& square = run_of(rules, "floor", "square");
  EXPECT_EQ(square.command, (std::vector<std::string>{"kiln", "square", "2.5", "-o", "made/floor/high/square.obj"}));
  EXPECT_EQ(square.outputs, std::vector<fs::path>{"made/floor/high/square.obj"});
  EXPECT_TRUE(contains(run_of(rules, "floor", "simplify").inputs, "made/floor/high/square.obj"));
}

TEST(Material, GoesToTheStagesThatNeedIt) {
  const Pipeline pipeline = pipeline_of(R"(
defaults:
  material: {albedo: 0.8}
assets:
  plain: {mesh: a.obj}
  painted: {mesh: a.obj, material: {texture: paint.png}}
  odd: {mesh: a.obj, material: {albedo: 0.5}, bake: {albedo: 0.6}}
)");
  const std::vector<MakeRule> rules = make_rules(pipeline);
  for (const char* stage : {"normals", "bake"}) {
    EXPECT_EQ(value_after(run_of(rules, "plain", stage).command, "--albedo"), "0.8");
    // A texture drives out the number that is the default.
    EXPECT_EQ(value_after(run_of(rules, "painted", stage).command, "--albedo-texture"), "paint.png");
    EXPECT_EQ(value_after(run_of(rules, "painted", stage).command, "--albedo"), "");
  }
  EXPECT_EQ(value_after(run_of(rules, "odd", "normals").command, "--albedo"), "0.5");
  EXPECT_EQ(value_after(run_of(rules, "odd", "bake").command, "--albedo"), "0.6");
}

TEST(Material, FilesOfTheRecordAreInputs) {
  const Scratch scratch;
  const fs::path folder = scratch.folder() / "made" / "a" / "normals";
  fs::create_directories(folder);
  const fs::path texture = scratch.folder() / "wood.png";
  std::ofstream(texture) << "x";
  std::ofstream(folder / "normals.json") << R"({"inputs": {"a.obj": "1", "wood.png": "2", "gone.mtl": "3"}})";
  const std::vector<MakeRule> rules =
      make_rules(pipeline_in(scratch.folder(), "output: made\nassets:\n  a: {mesh: a.obj}\n"));
  const std::vector<fs::path>& inputs = run_of(rules, "a", "normals").inputs;
  EXPECT_TRUE(contains(inputs, "wood.png"));
  EXPECT_FALSE(contains(inputs, "gone.mtl")) << "make would know no way to it";
  EXPECT_EQ(std::count(inputs.begin(), inputs.end(), fs::path("a.obj")), 1);
}

TEST(Scene, MistakesAreNamed) {
  const auto with = [](const std::string& end) { return "assets:\n  a: {mesh: x.obj}\n" + end; };
  EXPECT_NE(refusal(with("scene: {b: '0,0,0'}\n")).find("unknown key 'b'"), std::string::npos);
  EXPECT_NE(refusal(with("scene: {a: '0,0'}\n")).find("'0,0' for the place of a"), std::string::npos);
  EXPECT_NE(refusal(with("scene: [a]\n")).find("mapping"), std::string::npos);
  EXPECT_NE(refusal("assets:\n  a: {mesh: {square: 0}}\n").find("above 0"), std::string::npos);
  EXPECT_NE(refusal("assets:\n  a: {mesh: {square: big}}\n").find("a number"), std::string::npos);
  EXPECT_NE(refusal("assets:\n  a: {mesh: x.obj, material: {albedo: 2}}\n").find("'2' for albedo"), std::string::npos);
  EXPECT_NE(refusal("assets:\n  a: {mesh: x.obj, material: {albedo: 1, texture: a.png}}\n").find("both albedo"),
            std::string::npos);
  EXPECT_NE(refusal("assets:\n  a: {mesh: x.obj, material: {colour: 1}}\n").find("'colour'"), std::string::npos);
}

}  // namespace
}  // namespace kiln
