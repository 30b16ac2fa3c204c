// SPDX-License-Identifier: GPL-3.0-or-later
// What a pipeline says of surfaces, of the sizes of maps and of scenes, and what the stages' commands make of it.
#include <algorithm>
#include <gtest/gtest.h>

#include "pipelines.h"

namespace kiln {
namespace test_driver_scene {

namespace fs = std::filesystem;

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

TEST(Scene, NamesMayHoldWhatPartsFields) {
  const std::vector<MakeRule> rules = make_rules(
      pipeline_of("assets:\n  a: {mesh: 'x;y\\z.obj'}\n  b: {mesh: -b.obj}\nscene: {a: '0,0,0', b: '1,0,0'}\n"));
  EXPECT_EQ(value_after(run_of(rules, "b", "bake").command, "--neighbour"), "x\\;y\\\\z.obj;place=0,0,0");
  EXPECT_EQ(value_after(run_of(rules, "a", "bake").command, "--neighbour"), "./-b.obj;place=1,0,0");
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
  measured: {mesh: a.obj, material: {reflectance: paint.csv}}
  sample: {mesh: b.obj, material: {reflectance: tcs05}}
  door: {mesh: b.obj, material: {reflectance: {wood: oak.csv, lock: TCS05}}}
scene: {plain: '0,0,0', sample: '1,0,0', door: '2,0,0'}
)");
  const std::vector<MakeRule> rules = make_rules(pipeline);
  EXPECT_EQ(value_after(run_of(rules, "plain", "bake").command, "--neighbour"), "b.obj;place=1,0,0;reflectance=tcs05");
  const std::vector<std::string> of_sample = run_of(rules, "sample", "bake").command;
  EXPECT_NE(std::ranges::find(of_sample, "b.obj;place=2,0,0;reflectance-of=wood=oak.csv,lock=TCS05"), of_sample.end())
      << "in the order of the file";
  for (const char* stage : {"normals", "bake"}) {
    EXPECT_EQ(value_after(run_of(rules, "door", stage).command, "--reflectance-of"), "wood=oak.csv,lock=TCS05");
    EXPECT_EQ(value_after(run_of(rules, "door", stage).command, "--albedo"), "") << "the default's";
    EXPECT_EQ(value_after(run_of(rules, "plain", stage).command, "--albedo"), "0.8");
    // A texture drives out the number that is the default.
    EXPECT_EQ(value_after(run_of(rules, "painted", stage).command, "--albedo-texture"), "paint.png");
    EXPECT_EQ(value_after(run_of(rules, "painted", stage).command, "--albedo"), "");
    EXPECT_EQ(value_after(run_of(rules, "measured", stage).command, "--reflectance"), "paint.csv");
    EXPECT_EQ(value_after(run_of(rules, "measured", stage).command, "--albedo"), "");
    EXPECT_EQ(value_after(run_of(rules, "sample", stage).command, "--reflectance"), "tcs05");
  }
  EXPECT_EQ(value_after(run_of(rules, "odd", "normals").command, "--albedo"), "0.5");
  EXPECT_EQ(value_after(run_of(rules, "odd", "bake").command, "--albedo"), "0.6");
}

TEST(Material, OpacityGoesToTheStagesThatCutAndToNeighbours) {
  const std::vector<MakeRule> rules = make_rules(pipeline_of(R"(
assets:
  fern: {mesh: a.obj, material: {opacity-texture: a.png, opacity-cutoff: 0.25}}
  wall: {mesh: b.obj, material: {opacity: none}}
scene: {fern: [0, 0, 0], wall: [1, 0, 0]}
)"));
  for (const char* stage : {"normals", "bake"}) {
    EXPECT_EQ(value_after(run_of(rules, "fern", stage).command, "--opacity-texture"), "a.png");
    EXPECT_EQ(value_after(run_of(rules, "fern", stage).command, "--opacity-cutoff"), "0.25");
    EXPECT_EQ(value_after(run_of(rules, "wall", stage).command, "--opacity"), "none");
  }
  const std::string neighbour = value_after(run_of(rules, "wall", "bake").command, "--neighbour");
  EXPECT_NE(neighbour.find("opacity-texture=a.png;opacity-cutoff=0.25"), std::string::npos) << neighbour;
}

TEST(Maps, HaveTheirSizesFromOneBlock) {
  const std::vector<MakeRule> rules = make_rules(pipeline_of(R"(
defaults:
  maps: {planes: 256, albedo: 4096}
assets:
  plain: {mesh: a.obj}
  own: {mesh: a.obj, maps: {normal: 2048}, normals: {albedo-size: 1024}}
)"));
  EXPECT_EQ(value_after(run_of(rules, "plain", "atlas").command, "--size"), "256");
  EXPECT_EQ(value_after(run_of(rules, "plain", "normals").command, "--albedo-size"), "4096");
  EXPECT_EQ(value_after(run_of(rules, "plain", "normals").command, "--normal-size"), "");
  EXPECT_EQ(value_after(run_of(rules, "own", "normals").command, "--albedo-size"), "1024");
  EXPECT_EQ(value_after(run_of(rules, "own", "normals").command, "--normal-size"), "2048");
  EXPECT_NE(refusal("assets:\n  a: {mesh: x.obj, maps: {height: 1}}\n").find("'height'"), std::string::npos);
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

}  // namespace test_driver_scene
}  // namespace kiln
