// SPDX-License-Identifier: GPL-3.0-or-later
// What the window does with a scene, without a window.
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "base/errors.h"
#include "scratch.h"
#include "shapes.h"
#include "view/state/scene_state.h"

namespace kiln {
namespace test_scene_view {

SceneDescription two_balls() {
  SceneDescription description;
  description.assets = {"ball"};
  for (const char* name : {"near", "far"}) {
    SceneItem item;
    item.name = name;
    item.asset = 0;
    description.items.push_back(item);
  }
  description.items[0].rest.translation = {0, 0, 3};
  description.items[0].rest.scale = 0.5;
  description.items[1].rest.translation = {0.8, 0, 0};
  description.items[1].is_static = true;
  description.lights.emplace_back();
  return description;
}

TEST(SceneView, ThePointerFindsWhatIsNearestAndItFollows) {
  PrtAsset ball;
  ball.mesh = shapes::cube_sphere(8);
  ball.bands = 2;
  MovingScene scene(two_balls(), {&ball}, {{}, 1});
  std::vector<Eigen::Vector3f> shape = {{-2, -2, -2}, {2, 2, 4}};
  CameraSettings settings;
  settings.azimuth_degrees = settings.elevation_degrees = 0;
  settings.target = Eigen::Vector3d(0, 0, 0);
  settings.distance = 10;
  const int width = 320, height = 200;
  const Camera camera = make_camera(shape, settings, width, height);
  const auto pixel_of = [&](const Eigen::Vector3d& place) {
    const Eigen::Vector4f clip = camera.clip_from_object() * place.cast<float>().homogeneous();
    return Eigen::Vector2f((clip.x() / clip.w() + 1) / 2 * width, (1 - clip.y() / clip.w()) / 2 * height);
  };
  EXPECT_EQ(item_at(scene, camera, 160, 100, width, height), 0);  // before the other, which is there as well
  const Eigen::Vector2f beside = pixel_of({1.4, 0, 0});
  EXPECT_EQ(item_at(scene, camera, beside.x(), beside.y(), width, height), 1);
  EXPECT_EQ(item_at(scene, camera, 5, 5, width, height), -1);
  EXPECT_TRUE(can_be_dragged(scene, 0));
  EXPECT_FALSE(can_be_dragged(scene, 1));
  EXPECT_FALSE(can_be_dragged(scene, -1));
  const Eigen::Vector2f before = pixel_of(scene.pose(0).translation);
  drag_item(scene, 0, camera, 37, -21, height);
  const Eigen::Vector2f after = pixel_of(scene.pose(0).translation);
  EXPECT_NEAR(after.x() - before.x(), 37, 0.01);
  EXPECT_NEAR(after.y() - before.y(), -21, 0.01);
  EXPECT_NEAR(scene.pose(0).translation.z(), 3, 1e-6);  // the camera looks along Z
}

TEST(SceneView, KeysStepAndPlay) {
  SceneState home, state;
  press_scene_key(state, home, 2, ' ');
  EXPECT_TRUE(state.plays);
  press_scene_key(state, home, 2, right_key);
  EXPECT_FALSE(state.plays);
  EXPECT_DOUBLE_EQ(state.time, scene_frame_seconds);
  press_scene_key(state, home, 2, down_key);
  EXPECT_EQ(state.time, 0);
  for (int k = 0; k < 9; ++k) press_scene_key(state, home, 2, up_key);
  EXPECT_EQ(state.time, 2);
  EXPECT_DOUBLE_EQ(looped(2.5, 2), 0.5);
  EXPECT_EQ(looped(2.5, 0), 2.5);
  EXPECT_EQ(press_scene_key(state, home, 2, 'q'), Wish::close);
  EXPECT_EQ(press_scene_key(state, home, 2, 's'), Wish::screenshot);
  press_scene_key(state, home, 2, 'r');
  EXPECT_EQ(state.time, 0);
}

TEST(SceneView, ScriptsHaveItsWords) {
  const Scratch scratch;
  const auto steps = [&](const std::string& text, const ScriptWords& words) {
    std::ofstream(scratch / "script") << text;
    return read_script(scratch / "script", words);
  };
  const std::vector<ScriptStep> read = steps("key space left\nmove 10 20 -5 7\n", scene_script_words());
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[0].key, ' ');
  EXPECT_EQ(read[1].key, left_key);
  EXPECT_EQ(read[2].kind, ScriptStep::Kind::move);
  EXPECT_EQ(read[2].from_x, 10);
  EXPECT_EQ(read[2].from_y, 20);
  EXPECT_EQ(read[2].x, -5);
  EXPECT_EQ(read[2].y, 7);
  EXPECT_THROW(steps("reload\n", scene_script_words()), BadInput);
  EXPECT_EQ(steps("reload\n", scene_script_words(true)).size(), 1u);
  EXPECT_THROW(steps("key f\n", scene_script_words()), BadInput);
  EXPECT_THROW(steps("move 1 2 3\n", scene_script_words()), BadInput);
  EXPECT_THROW(steps("move 10 20 -5 7\n", asset_script_words()), BadInput);
  EXPECT_THROW(steps("key space\n", asset_script_words()), BadInput);
}

}  // namespace test_scene_view
}  // namespace kiln
