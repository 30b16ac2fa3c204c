// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that move: motions, trees, the file, and where its nodes and their light are at a time.
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "damaged_text.h"
#include "runtime/play/moving_scene.h"
#include "runtime/scene/cluster_tree.h"
#include "runtime/scene_file/scene_file.h"
#include "scratch.h"
#include "sh/directions.h"
#include "sh/lights.h"
#include "shapes.h"

namespace kiln {
namespace test_scene {

using Eigen::Vector3d;

Eigen::Quaterniond turn(const Vector3d& axis, double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis));
}

TEST(Motion, KeyframesAreLinearAndTurnsAreEven) {
  Keyframes keyframes;
  keyframes.frames = {{.time = 1, .translation = Vector3d(0, 0, 0), .rotation = turn({0, 0, 1}, 0), .scale = 1},
                      {.time = 2, .translation = {}, .rotation = turn({0, 0, 1}, 90), .scale = {}},
                      {.time = 3, .translation = Vector3d(4, 2, 0), .rotation = {}, .scale = 3}};
  Placement rest;
  rest.translation = {9, 9, 9};
  const Placement at = place_at(rest, keyframes, 1.5);
  EXPECT_TRUE(at.translation.isApprox(Vector3d(1, 0.5, 0), 1e-12));  // the second says no place
  EXPECT_DOUBLE_EQ(at.scale, 1.5);
  EXPECT_TRUE(at.rotation.isApprox(turn({0, 0, 1}, 45).toRotationMatrix(), 1e-12));
  const Placement late = place_at(rest, keyframes, 2.5);
  EXPECT_TRUE(late.rotation.isApprox(turn({0, 0, 1}, 90).toRotationMatrix(), 1e-12));
  EXPECT_TRUE(place_at(rest, keyframes, 0).translation.isZero(1e-12));
  EXPECT_TRUE(place_at(rest, keyframes, 7).translation.isApprox(Vector3d(4, 2, 0), 1e-12));
  keyframes.ends = MotionEnds::repeat;
  EXPECT_TRUE(place_at(rest, keyframes, 5.5).translation.isApprox(Vector3d(3, 1.5, 0) / 3, 1e-12));
  keyframes.ends = MotionEnds::mirror;
  EXPECT_TRUE(place_at(rest, keyframes, 3.5).translation.isApprox(Vector3d(3, 1.5, 0), 1e-12));
  EXPECT_TRUE(place_at(rest, keyframes, 0.5).translation.isApprox(Vector3d(1, 0.5, 0), 1e-12));
  EXPECT_DOUBLE_EQ(duration_of(Motion(keyframes)), 3);
}

TEST(Motion, WhatKeyframesLeaveOutIsThatOfRest) {
  Placement rest;
  rest.scale = 2;
  rest.translation = {1, 2, 3};
  rest.rotation = turn({1, 0, 0}, 30).toRotationMatrix();
  const Keyframes one{{{.time = 0, .translation = {}, .rotation = {}, .scale = 5}}, MotionEnds::hold};
  const Placement at = place_at(rest, one, 3);
  EXPECT_EQ(at.scale, 5);
  EXPECT_EQ(at.translation, rest.translation);
  EXPECT_EQ(at.rotation, rest.rotation);
}

TEST(Motion, CirclesGoByTheRightHand) {
  Placement rest;
  rest.translation = {0, 1, 0};
  const CircularOrbit about_y{.radius = 2, .period = 4};
  EXPECT_TRUE(place_at(rest, about_y, 0).translation.isApprox(Vector3d(0, 1, 2), 1e-12));
  EXPECT_TRUE(place_at(rest, about_y, 1).translation.isApprox(Vector3d(2, 1, 0), 1e-12));  // as azimuths count
  EXPECT_TRUE(place_at(rest, about_y, 5).translation.isApprox(Vector3d(2, 1, 0), 1e-12));
  EXPECT_TRUE(place_at(rest, about_y, 1).rotation.isIdentity(1e-12));
  const CircularOrbit turning{.axis = {0, 0, 1}, .radius = 1, .period = -4, .phase_degrees = 90, .turns = true};
  const Placement at = place_at(rest, turning, 1);
  EXPECT_TRUE(at.translation.isApprox(Vector3d(1, 1, 0), 1e-12));
  EXPECT_TRUE(place_at({}, turning, 2).rotation.isApprox(turn({0, 0, 1}, -90).toRotationMatrix(), 1e-12));
  EXPECT_THROW(check_motion(CircularOrbit{.axis = {0, 0, 0}}), WrongUsage);
  EXPECT_THROW(check_motion(Keyframes{}), WrongUsage);
}

TEST(Motion, PlacesInPlacesAreProductsOfTheirMatrices) {
  Placement outer{turn({0, 1, 0}, 40).toRotationMatrix(), 2, {1, 2, 3}};
  const Placement inner{turn({1, 0, 0}, -70).toRotationMatrix(), 0.5, {-1, 0, 4}};
  EXPECT_TRUE(compose(outer, inner).matrix().isApprox(outer.matrix() * inner.matrix(), 1e-12));
}

std::vector<SceneNode> leaves(int count) {
  std::vector<SceneNode> nodes(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    nodes[static_cast<std::size_t>(k)].name = "leaf " + std::to_string(k);
    nodes[static_cast<std::size_t>(k)].asset = 0;
  }
  return nodes;
}

/// Tests that parents stand before children, that both know each other, and that each leaf is there once.
void expect_sound(const ClusterTree& tree, int count) {
  const SceneTree& found = tree.tree();
  int seen = 0;
  for (int k = 1; k < found.count(); ++k) {
    const SceneNode& node = found.nodes[static_cast<std::size_t>(k)];
    ASSERT_LT(node.parent, k);
    const std::vector<int>& siblings = found.nodes[static_cast<std::size_t>(node.parent)].children;
    ASSERT_EQ(std::count(siblings.begin(), siblings.end(), k), 1);
    ASSERT_EQ(node.asset >= 0, node.children.empty());
    if (node.asset < 0) {
      ASSERT_GT(node.children.size(), 1u);
    }
    seen += node.asset >= 0;
  }
  ASSERT_EQ(seen, count);
  for (int leaf = 0; leaf < count; ++leaf)
    ASSERT_EQ(found.nodes[static_cast<std::size_t>(tree.node_of(leaf))].name, "leaf " + std::to_string(leaf));
}

int parent_of(const ClusterTree& tree, int leaf) {
  return tree.tree().nodes[static_cast<std::size_t>(tree.node_of(leaf))].parent;
}

TEST(ClusterTree, GroupsWhatIsNearForItsSize) {
  ClusterTree tree(leaves(5));
  // Two that touch, a third beside them, and far away two small ones that touch.
  std::vector<NodeSphere> spheres = {
      {{0, 0, 0}, 1}, {{1.9, 0, 0}, 1}, {{5.5, 0, 0}, 1}, {{60, 0, 0}, 0.1}, {{60.15, 0, 0}, 0.1}};
  EXPECT_TRUE(tree.update(spheres));
  expect_sound(tree, 5);
  EXPECT_EQ(parent_of(tree, 0), parent_of(tree, 1));
  EXPECT_NE(parent_of(tree, 0), parent_of(tree, 2));
  EXPECT_EQ(tree.tree().nodes[static_cast<std::size_t>(parent_of(tree, 0))].parent, parent_of(tree, 2));
  EXPECT_EQ(parent_of(tree, 3), parent_of(tree, 4));
  EXPECT_EQ(tree.tree().nodes[static_cast<std::size_t>(parent_of(tree, 3))].parent, 0);
  EXPECT_FALSE(tree.update(spheres));
  for (NodeSphere& sphere : spheres) sphere.centre *= 7, sphere.radius *= 7;
  EXPECT_FALSE(tree.update(spheres));  // sizes do not matter, only distances over them
}

TEST(ClusterTree, HoveringAboutTheBorderChangesNothing) {
  ClusterTree tree(leaves(3));
  std::vector<NodeSphere> spheres = {{{0, 0, 0}, 1}, {{1.8, 0, 0}, 1}, {{100, 0, 0}, 1}};
  tree.update(spheres);
  const int together = tree.tree().count();
  int changes = 0;
  // Rounds form below 1, 2 and 4, and part above 1.25, 2.5 and 5; the distance over size is half of x here.
  for (int frame = 0; frame < 200; ++frame) {
    spheres[1].centre.x() = 2 + 0.4 * std::sin(frame * 1.7);
    changes += tree.update(spheres);
  }
  EXPECT_EQ(changes, 0);
  EXPECT_EQ(tree.tree().count(), together);
  spheres[1].centre.x() = 2.6;  // now it leaves the innermost round, which the tree does not show: two are two
  tree.update(spheres);
  spheres[1].centre.x() = 10.2;
  EXPECT_TRUE(tree.update(spheres));
  EXPECT_EQ(parent_of(tree, 1), 0);
  spheres[1].centre.x() = 9;  // back within the border, but not below what it takes to form
  for (int frame = 0; frame < 200; ++frame) {
    spheres[1].centre.x() = 9 + 0.9 * std::sin(frame * 1.7);
    EXPECT_FALSE(tree.update(spheres));
  }
  spheres[1].centre.x() = 7.9;
  EXPECT_TRUE(tree.update(spheres));
  EXPECT_NE(parent_of(tree, 1), 0);
}

TEST(ClusterTree, StaysSoundWhateverMoves) {
  ClusterTree tree(leaves(24));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-4, 4), step(-0.3, 0.3), size(0.05, 0.8);
  std::vector<NodeSphere> spheres(24);
  for (NodeSphere& sphere : spheres) sphere = {{place(random), place(random), place(random)}, size(random)};
  int changes = 0;
  for (int frame = 0; frame < 100; ++frame) {
    changes += tree.update(spheres);
    expect_sound(tree, 24);
    ASSERT_FALSE(tree.update(spheres)) << "nothing has moved";
    for (NodeSphere& sphere : spheres) sphere.centre += Vector3d(step(random), step(random), step(random));
  }
  EXPECT_GT(changes, 3);
  EXPECT_LT(changes, 100);
}

/// A folder with folders a and b in it, for assets, a file, for a mesh, and a scene.
struct SceneFolder {
  Scratch scratch;
  SceneFolder() {
    std::filesystem::create_directories(scratch / "a");
    std::filesystem::create_directories(scratch / "b");
    std::ofstream(scratch / "m.obj") << "v 0 0 0\n";
  }
  SceneDescription read(const std::string& text) const {
    std::ofstream(scratch / "scene.yaml") << text;
    return load_scene(scratch / "scene.yaml");
  }
  void refuses(const std::string& text, int line, const std::string& part) const {
    try {
      read(text);
      ADD_FAILURE() << "not refused: " << text;
    } catch (const BadInput& error) {
      EXPECT_TRUE(error.file().ends_with("scene.yaml:" + std::to_string(line))) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
};

TEST(SceneFile, HasWhatItSays) {
  const SceneFolder folder;
  const SceneDescription scene = folder.read(R"(
nodes:
  - {name: still, asset: a}
  - name: pair
    translate: [0, 0.4, 0]
    nodes:
      - {name: mover, asset: b, scale: 0.2, animate: {keyframes: [{time: 0, translate: [-6, 1.6, 0]}, {time: 1, translate: [0, 1.6, 0]}]}}
      - {name: moon, asset: b, rotate: {axis: [0, 0, 2], degrees: 90}, animate: {orbit: {axis: [0, 3, 0], radius: 2, period: 4}}}
lights:
  - {directional: [0, 80], radiance: 1, radius: 6}
  - {sphere: [0, 2, 0], radius: 0.5, radiance: [1, 2, 3], animate: {orbit: {radius: 1, period: 2}}}
  - {directional: [350, 10], animate: {keyframes: [{time: 0, directional: [350, 10], radiance: 1}, {time: 2, directional: [370, 20], radiance: 3}]}}
  - {hemisphere: [0, 90], radiance: 0.5, ground: 0.1}
  - {ambient: 0.25}
camera: {azimuth: 30, elevation: 20}
)");
  ASSERT_EQ(scene.items.size(), 4u);
  EXPECT_EQ(scene.assets.size(), 2u);  // b once
  EXPECT_EQ(scene.items[3].parent, 1);
  EXPECT_EQ(scene.items[3].asset, 1);
  EXPECT_EQ(scene.items[2].rest.scale, 0.2);
  EXPECT_TRUE(scene.items[3].rest.rotation.isApprox(turn({0, 0, 1}, 90).toRotationMatrix(), 1e-12));
  EXPECT_EQ(std::get<CircularOrbit>(scene.items[3].motion).axis, Vector3d(0, 1, 0));
  EXPECT_EQ(scene.tree, TreeChoice::given);
  EXPECT_EQ(duration_of(scene), 4);
  ASSERT_EQ(scene.lights.size(), 5u);
  EXPECT_EQ(to_text(light_at(scene.lights[0], 1)), to_text(parse_light_spec("cone:0,80,6")));
  EXPECT_EQ(to_text(light_at(scene.lights[1], 0)), to_text(parse_light_spec("sphere:0,2,1,0.5,1,2,3")));
  EXPECT_EQ(to_text(light_at(scene.lights[2], 1)), to_text(parse_light_spec("360,15,2,2,2")));
  EXPECT_EQ(to_text(light_at(scene.lights[4], 1)), to_text(parse_light_spec("ambient:0.25")));
  EXPECT_EQ(*scene.cameras.front().azimuth_degrees, 30);
  EXPECT_EQ(folder.read("nodes: [{name: x, asset: a}, {name: y, asset: a}]\n").tree, TreeChoice::found);
  EXPECT_EQ(folder.read("nodes: [{name: x, asset: a}]\ntree: given\nduration: 7.5\n").duration, 7.5);
}

TEST(SceneFile, CamerasMove) {
  const SceneFolder folder;
  const SceneDescription scene = folder.read(R"(
nodes: [{name: x, asset: a}]
cameras:
  - name: dolly
    azimuth: 10
    animate:
      keyframes:
        - {time: 1, azimuth: 350, elevation: 20, target: [0, 0, 0]}
        - {time: 2, distance: 4}
        - {time: 3, azimuth: 370, elevation: 40, target: [2, 4, 6]}
  - {name: round, azimuth: 30, distance: 2, animate: {orbit: {period: -4, phase: 5}}}
  - {name: still, zoom: 2}
)");
  ASSERT_EQ(scene.cameras.size(), 3u);
  const CameraPlace before = camera_at(scene.cameras[0], 0), between = camera_at(scene.cameras[0], 1.5),
                    after = camera_at(scene.cameras[0], 9);
  EXPECT_EQ(*before.azimuth_degrees, 350);
  EXPECT_EQ(*between.azimuth_degrees, 355);
  EXPECT_EQ(*between.elevation_degrees, 25);
  EXPECT_EQ(*between.target, Vector3d(0.5, 1, 1.5));
  EXPECT_EQ(*between.distance, 4);
  EXPECT_FALSE(between.zoom);
  EXPECT_EQ(*after.azimuth_degrees, 370);
  EXPECT_EQ(*camera_at(scene.cameras[1], 1).azimuth_degrees, 30 + 5 - 90);
  EXPECT_EQ(*camera_at(scene.cameras[1], 1).distance, 2);
  EXPECT_EQ(*camera_at(scene.cameras[2], 1).zoom, 2);
  EXPECT_EQ(find_camera(scene, "still"), 2);
  EXPECT_EQ(find_camera(scene, ""), 0);
  EXPECT_EQ(find_camera(scene, "none"), -1);
  EXPECT_EQ(duration_of(scene), 4);
}

TEST(SceneFile, HasWhatShadersAreTold) {
  const SceneFolder folder;
  const SceneDescription scene = folder.read(R"(
shaders: b
background: [0.25, 0.5, 1]
nodes:
  - {name: floor, mesh: m.obj, shader: wood, set: {gloss: 0.5, paint: [1, 0, 0.5]}, casts-shadow: false, mirror: true}
  - {name: hare, asset: a}
)");
  EXPECT_TRUE(scene.shaders.string().ends_with("/b"));
  EXPECT_EQ(*scene.background, (std::array<float, 3>{0.25f, 0.5f, 1}));
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.tree, TreeChoice::found);
  const SceneSurface &floor = scene.items[0].surface, &hare = scene.items[1].surface;
  EXPECT_EQ(floor.shader, "wood");
  ASSERT_EQ(floor.parameters.size(), 2u);
  EXPECT_EQ(floor.parameters[1].name, "paint");
  EXPECT_EQ(floor.parameters[1].numbers, (std::vector<double>{1, 0, 0.5}));
  EXPECT_TRUE(floor.parameters[1].where.ends_with("scene.yaml:5"));
  EXPECT_TRUE(floor.is_mirror && !floor.casts_shadow);
  EXPECT_TRUE(hare.shader.empty() && hare.casts_shadow && !hare.is_mirror);
  try {
    require_transfer(scene);
    ADD_FAILURE() << "a mesh has no transfer";
  } catch (const BadInput& error) {
    EXPECT_TRUE(error.file().ends_with("scene.yaml:5")) << error.what();
  }
}

TEST(SceneFile, DirectionsTurnAboutTheAxis) {
  SceneLight light;
  light.spec = parse_light_spec("cone:0,30,5");
  light.motion = CircularOrbit{.period = 4};
  const LightSpec spec = light_at(light, 1);
  EXPECT_NEAR(spec.azimuth_degrees, 90, 1e-4);
  EXPECT_NEAR(spec.elevation_degrees, 30, 1e-4);
  light.motion = CircularOrbit{.axis = {1, 0, 0}, .period = 4};  // from +Z upwards is about -X
  EXPECT_NEAR(light_at(light, -0.25).elevation_degrees, 52.5, 1e-4);
}

TEST(SceneFile, FaultsNameTheirLine) {
  const SceneFolder folder;
  const auto node = [](const std::string& more) { return "nodes:\n  - {name: x, asset: a, " + more + "}\n"; };
  folder.refuses(node("scale: [1, 2, 1]"), 2, "uniform");
  folder.refuses(node("scale: 0"), 2, "above 0");
  folder.refuses(node("scale: -1"), 2, "'-1'");
  folder.refuses(node("translate: [.nan, 0, 0]"), 2, "'.nan'");
  folder.refuses(node("translate: [1, 2]"), 2, "2 numbers");
  folder.refuses(node("rotate: {axis: [0, 0, 0], degrees: 1}"), 2, "length 0");
  folder.refuses(node("turn: 1"), 2, "unknown key 'turn'");
  folder.refuses(node("animate: {orbit: {axis: [0, 0, 0], radius: 1, period: 1}}"), 2, "length 0");
  folder.refuses(node("animate: {orbit: {radius: 1, period: 0}}"), 2, "a period of 0");
  folder.refuses(node("animate: {orbit: {radius: 0, period: 1}}"), 2, "a radius of 0");
  folder.refuses(node("animate: {keyframes: [{time: 1, scale: 1}, {time: 1, scale: 2}]}"), 2, "the order of time");
  folder.refuses(node("animate: {keyframes: [{time: 1}]}"), 2, "time alone");
  folder.refuses(node("animate: {keyframes: [{scale: 1}]}"), 2, "without a time");
  folder.refuses(node("animate: {keyframes: [{time: 0, scale: 1}], orbit: {radius: 1, period: 1}}"), 2, "both");
  folder.refuses(node("static: true, animate: {orbit: {radius: 1, period: 1}}"), 2, "static node 'x'");
  folder.refuses(node("static: 1"), 2, "true or false");
  folder.refuses(node("nodes: [{name: y, asset: a}]"), 2, "both asset and nodes");
  folder.refuses("nodes:\n  - {name: x, asset: a}\n  - {name: x, asset: a}\n", 3, "the name 'x'");
  folder.refuses("nodes:\n  - {name: x}\n", 2, "without an asset");
  folder.refuses("nodes:\n  - {asset: a}\n", 2, "without a name");
  folder.refuses(node("mesh: m.obj"), 2, "both asset and mesh");
  folder.refuses("nodes:\n  - {name: x, mesh: a}\n", 2, "no file");
  folder.refuses("shaders: c\n" + node("shader: s"), 1, "no folder");
  folder.refuses(node("shader: s"), 2, "without 'shaders'");
  folder.refuses("shaders: a\n" + node("set: {p: 1}"), 3, "without 'shader'");
  folder.refuses("shaders: a\n" + node("shader: s, set: {p: [1, 2, 3, 4, 5]}"), 3, "5 numbers");
  folder.refuses("shaders: a\n" + node("shader: s, set: {p: red}"), 3, "'red'");
  folder.refuses(node("casts-shadow: 0"), 2, "true or false");
  folder.refuses("nodes:\n  - {name: x, asset: a, mirror: true}\n  - {name: y, asset: a, mirror: true}\n", 3, "second");
  folder.refuses("shaders: a\nnodes:\n  - name: x\n    shader: s\n    nodes: [{name: y, asset: a}]\n", 4,
                 "other nodes");
  folder.refuses("background: [1, 2]\n" + node("scale: 1"), 1, "2 numbers");
  folder.refuses("nodes:\n  - {name: x, asset: c}\n", 2, "no folder");
  folder.refuses("nodes: &n\n  - {name: x, nodes: *n}\n", 1, "themselves");
  folder.refuses(
      "nodes:\n  - name: x\n    animate: {orbit: {radius: 1, period: 1}}\n    nodes:\n"
      "      - {name: y, asset: a, static: true}\n",
      5, "static node 'y'");
  folder.refuses("nodes:\n  - {name: x, asset: a}\nlights:\n  - {directional: [0, 91]}\n", 4, "-90 to 90");
  folder.refuses("nodes:\n  - {name: x, asset: a}\nlights:\n  - {sphere: [0, 1, 0]}\n", 4, "without a radius");
  folder.refuses("nodes:\n  - {name: x, asset: a}\nlights:\n  - {sun: [0, 1]}\n", 4, "one of directional");
  folder.refuses("nodes:\n  - {name: x, asset: a}\nlights:\n  - {environment: sky.hdr}\n", 4, "does not exist");
  folder.refuses("nodes:\n  - {name: x, asset: a}\nlights:\n  - {ambient: 1, lamp: A}\n  - {ambient: 1}\n", 5,
                 "of all lights, or of none");
  folder.refuses("nodes:\n  - {name: x, asset: a}\nlights:\n  - {environment: a}\n  - {ambient: 1, lamp: A}\n", 4,
                 "an environment");
  folder.refuses("nodes:\n  - {name: x, asset: a}\nlights:\n  - {ambient: 1, lamp: [A]}\n", 4, "D65");
  folder.refuses("nodes:\n  - {name: x, asset: a}\ntree: oak\n", 3, "given or auto");
  folder.refuses("nodes:\n  - {name: x, asset: a}\n---\nnodes: []\n", 3, "a second document");
}

/// Makes an asset in memory: a cube of half size 0.5 with unoccluded transfer is not needed, as nothing is drawn.
PrtAsset box_asset() {
  PrtAsset asset;
  asset.mesh = shapes::cube(1);
  asset.bands = 3;
  return asset;
}

TEST(SceneFile, DamagedScenesAreReadOrRefused) {
  const SceneFolder folder;
  const std::string good =
      "nodes:\n"
      "  - {name: still, asset: a, static: true, rotate: {axis: [0, 0, 2], degrees: 90}}\n"
      "  - name: pair\n"
      "    nodes:\n"
      "      - {name: mover, asset: b, animate: {keyframes: [{time: 0, scale: 1}, {time: 1, translate: [0, 1.6, "
      "0]}]}}\n"
      "      - {name: moon, mesh: m.obj, animate: {orbit: {axis: [0, 1, 0], radius: 2, period: 4}}}\n"
      "lights: [{directional: [0, 80], radiance: 1, radius: 6}, {ambient: [0.25, 1, 0]}]\n"
      "camera: {azimuth: 30, elevation: 20}\n";
  const int refused = count_refused(good, 1000, [&](const std::string& text) {
    const SceneDescription scene = folder.read(text);
    EXPECT_FALSE(scene.items.empty());
    EXPECT_GE(duration_of(scene), 0);
    for (const SceneLight& light : scene.lights) light_at(light, 0.5);
  });
  EXPECT_GT(refused, 300);
  EXPECT_LT(refused, 1000);
}

TEST(MovingScene, NodesAndLightAreWhereTheyAreInTime) {
  const SceneFolder folder;
  const SceneDescription description = folder.read(R"(
nodes:
  - {name: floor, asset: a, static: true}
  - name: rig
    translate: [0, 2, 0]
    rotate: {axis: [0, 1, 0], degrees: 90}
    scale: 2
    nodes:
      - {name: ball, asset: a, animate: {keyframes: [{time: 0, translate: [0, 0, 0]}, {time: 2, translate: [0, 0, 1]}]}}
lights: [{sphere: [3, 3, 0], radius: 0.5, animate: {orbit: {radius: 1, period: 2}}}, {ambient: 0.1}]
)");
  const PrtAsset asset = box_asset();
  MovingScene scene(description, {&asset}, {{.method = ShadowMethod::none}, samples_at_vertices});
  scene.set_time(1);
  const int ball = scene.find("ball");
  ASSERT_EQ(ball, 2);
  // Half way along +Z, turned to +X, twice as far.
  EXPECT_TRUE(scene.pose(ball).translation.isApprox(Vector3d(1, 2, 0), 1e-12));
  EXPECT_EQ(scene.pose(ball).scale, 2);
  EXPECT_EQ(to_text(scene.lights().specs[0]), to_text(parse_light_spec("sphere:3,3,-1,0.5")));
  // The light at vertices is that of an asset by itself there.
  const AssetLight found = scene.light(ball);
  const AssetLight alone = light_asset(scene.lights(), 3, scene.pose(ball), asset.mesh.positions);
  ASSERT_EQ(found.samples.size(), asset.mesh.positions.size());
  for (std::size_t k = 0; k < found.samples.size(); ++k)
    EXPECT_EQ(found.samples[k].channels, alone.samples[k].channels);
  EXPECT_EQ(found.direct.size(), 1u);
  // The tree has the flag, and the names.
  const SceneTree& tree = scene.tree();
  ASSERT_EQ(tree.count(), 4);
  EXPECT_TRUE(tree.nodes[1].is_static);
  EXPECT_FALSE(tree.nodes[2].is_static);
  EXPECT_FALSE(tree.nodes[3].is_static);
  EXPECT_EQ(tree.nodes[3].name, "ball");
  EXPECT_EQ(tree.nodes[3].parent, 2);
}

TEST(MovingScene, AFoundTreeHasTheFlagToo) {
  const SceneFolder folder;
  const SceneDescription description = folder.read(
      "nodes: [{name: x, asset: a, static: true}, {name: y, asset: b, translate: [1, 0, 0]}, {name: z, asset: a, "
      "translate: [90, 0, 0]}]\n");
  const PrtAsset asset = box_asset();
  MovingScene scene(description, {&asset, &asset}, {});
  int seen = 0;
  for (const SceneNode& node : scene.tree().nodes) {
    seen += node.name == "x" && node.is_static;
    seen += node.name == "y" && !node.is_static && node.asset == 1;
    seen += node.name == "z" && node.parent == 0;
  }
  EXPECT_EQ(seen, 3);
}

TEST(MovingScene, AFoundTreeFollowsWhatMoves) {
  SceneDescription description;
  description.assets = {"a"};
  description.tree = TreeChoice::found;
  for (const char* name : {"still", "passing", "beside"}) {
    SceneItem item;
    item.name = name;
    item.asset = 0;
    description.items.push_back(item);
  }
  description.items[2].rest.translation = {0, 1.2, 0};
  description.items[1].motion = Keyframes{{{.time = 0, .translation = Vector3d(-50, 0, 0), .rotation = {}, .scale = {}},
                                           {.time = 1, .translation = Vector3d(0, 0, 0), .rotation = {}, .scale = {}}},
                                          MotionEnds::hold};
  description.lights.emplace_back();
  const PrtAsset asset = box_asset();
  MovingScene scene(description, {&asset}, {});
  scene.light(0);
  EXPECT_EQ(scene.tree_changes(), 0);
  scene.set_time(1);
  scene.light(0);
  EXPECT_EQ(scene.tree_changes(), 1);
  EXPECT_EQ(scene.light(1).samples.size(), 8u);
  // The node beside is where it was, and sees the passing one now; the others' light is what a new scene would have.
  MovingScene fresh(description, {&asset}, {});
  fresh.set_time(1);
  for (int item = 0; item < 3; ++item)
    for (std::size_t p = 0; p < 8; ++p)
      EXPECT_EQ(scene.light(item).samples[p].channels, fresh.light(item).samples[p].channels);
}

TEST(MovingScene, WhatPassesTakesLightAndWhatIsStaticDoesNot) {
  const SceneFolder folder;
  const auto scene_of = [&](const std::string& flag) {
    return folder.read(
        "nodes:\n  - {name: low, asset: a, static: true}\n  - {name: high, asset: a, translate: [0, 4, 0], scale: 2" +
        flag + "}\nlights: [{directional: [0, 90], radius: 5}]\n");
  };
  PrtAsset ball;
  ball.mesh = shapes::cube_sphere(6);
  ball.bands = 4;
  const auto above = [&](const std::string& flag) {
    MovingScene scene(scene_of(flag), {&ball}, {{.method = ShadowMethod::combined, .directions = 256}, 1});
    return evaluate_at(scene.light(0).samples.front().channels[0], Eigen::Vector3f::UnitY());
  };
  const double alone = above(", animate: {keyframes: [{time: 0, translate: [50, 4, 0]}]}");
  EXPECT_GT(alone, 1);
  EXPECT_LT(std::abs(above("")), 0.02 * alone);  // the light is behind the other
  EXPECT_EQ(above(", static: true"), alone);     // the bake holds that already
}

TEST(SceneFile, LightsHaveLamps) {
  const SceneFolder folder;
  const SceneDescription scene = folder.read(
      "nodes: [{name: x, asset: a}]\nlights:\n  - {directional: [0, 80], lamp: F11}\n"
      "  - {ambient: 0.2, lamp: 'sun:20'}\n");
  EXPECT_EQ(scene.lights[0].lamp, "F11");
  EXPECT_EQ(scene.lights[1].lamp, "sun:20");
  EXPECT_TRUE(scene.lights[1].where.ends_with("scene.yaml:4"));
  try {
    require_no_lamps(scene, "leave it out");
    ADD_FAILURE() << "not refused";
  } catch (const BadInput& error) {
    EXPECT_TRUE(error.file().ends_with("scene.yaml:3")) << error.what();
  }
}

/// A light of each kind, two of them moving, and something that passes before another.
constexpr const char* lit_scene =
    "nodes:\n  - {name: low, asset: a}\n"
    "  - {name: high, asset: a, translate: [0, 4, 0], animate: {keyframes: [{time: 0, translate: [9, 4, 0]}, {time: 1, "
    "translate: [0.3, 2, 0]}]}}\n"
    "lights:\n  - {directional: [0, 80], radius: 5, lamp: A}\n"
    "  - {directional: [0, 20], animate: {orbit: {period: 2}}, lamp: A}\n"
    "  - {sphere: [0, 6, 1], radius: 1, radiance: 2, lamp: A}\n"
    "  - {hemisphere: [0, 90], radiance: 1, ground: 0.1, lamp: A}\n"
    "  - {ambient: 0.25, lamp: A}\n";

TEST(MovingScene, EachFunctionOfLightIsShadowedByItself) {
  const SceneFolder folder;
  const SceneDescription description = folder.read(lit_scene);
  PrtAsset ball;
  ball.mesh = shapes::cube_sphere(4);
  ball.bands = 3;
  constexpr Eigen::Index count = 5;
  for (const ShadowMethod method : {ShadowMethod::combined, ShadowMethod::product}) {
    const MovingSceneSettings settings{{.method = method, .directions = 64}, 2};
    // The truth: each light alone, in red, green and blue.
    std::vector<AssetLight> alone;
    for (std::size_t k = 0; k < count; ++k) {
      SceneDescription one = description;
      one.lights = {description.lights[k]};
      MovingScene scene(one, {&ball}, settings);
      scene.set_time(1);
      alone.push_back(scene.light(0));
    }
    MovingScene scene(description, {&ball}, settings);
    std::vector<Eigen::VectorXf> vectors;
    for (Eigen::Index k = 0; k < count; ++k) vectors.emplace_back(Eigen::VectorXf::Unit(count, k));
    vectors[0] << 1, 0, 0, -0.5f, 2;  // a mixture, as of characteristic vectors
    scene.set_light_vectors(vectors);
    scene.light(0);
    scene.set_time(1);  // what is kept from another time does not matter
    const AssetLight found = scene.light(0);
    ASSERT_EQ(found.samples.size(), 2u);
    EXPECT_EQ(found.rest.channels.size(), 5u);
    for (std::size_t s = 0; s < 2; ++s) {
      ASSERT_EQ(found.samples[s].channels.size(), 5u);
      for (std::size_t f = 0; f < count; ++f)
        for (std::size_t i = 0; i < 9; ++i) {
          float truth = 0;
          for (std::size_t k = 0; k < count; ++k)
            truth += vectors[k][static_cast<Eigen::Index>(f)] * alone[k].samples[s].channels[0][i];
          EXPECT_NEAR(found.samples[s].channels[f][i], truth, 2e-5) << f << " " << i;
        }
    }
    MovingScene grey(description, {&ball}, settings);
    grey.set_time(1);
    const AssetLight as_grey = grey.light(0);
    grey.set_light_vectors(std::vector<Eigen::VectorXf>(5, Eigen::VectorXf::Ones(1)));
    const AssetLight one = grey.light(0);
    EXPECT_EQ(one.samples.front().channels.at(0), as_grey.samples.front().channels[0]);
  }
}

TEST(MovingScene, NodesMoveByHandUnlessTheyAreStatic) {
  const SceneFolder folder;
  const SceneDescription description = folder.read(R"(
nodes:
  - {name: floor, asset: a, static: true}
  - {name: rig, rotate: {axis: [0, 0, 1], degrees: 90}, scale: 4, nodes: [{name: ball, asset: a, translate: [1, 0, 0]}]}
)");
  const PrtAsset asset = box_asset();
  MovingScene scene(description, {&asset}, {});
  const Vector3d before = scene.pose(2).translation;
  scene.move(2, {0.5, 1, 2});
  EXPECT_TRUE(scene.pose(2).translation.isApprox(before + Vector3d(0.5, 1, 2), 1e-12));
  scene.set_time(5);
  EXPECT_TRUE(scene.pose(2).translation.isApprox(before + Vector3d(0.5, 1, 2), 1e-12));
  EXPECT_THROW(scene.move(0, {1, 0, 0}), WrongUsage);
  scene.put_back();
  EXPECT_TRUE(scene.pose(2).translation.isApprox(before, 1e-12));
}

}  // namespace test_scene
}  // namespace kiln
