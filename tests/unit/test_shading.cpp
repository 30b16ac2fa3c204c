// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "base/errors.h"
#include "image/image_file.h"
#include "runtime/shading/sample_pattern.h"
#include "scratch.h"
#include "shading_stand.h"

namespace kiln {
namespace test_shading {

using namespace shading_stand;

TEST(Shading, ThreeWaysGiveOnePicture) {
  const EglContext context("software");
  const Stand stand;
  const Image<float> forward = stand.drawn(ShadingWay::forward), deferred = stand.drawn(ShadingWay::deferred),
                     factored = stand.drawn(ShadingWay::factored);
  EXPECT_LE(largest_difference(deferred, factored), 1);
  EXPECT_LE(largest_difference(forward, factored), 1);
  // It is no empty picture: spheres, floor and background are there.
  std::set<int> greens;
  for (std::size_t k = 1; k < factored.values().size(); k += 4)
    greens.insert(static_cast<int>(255 * factored.values()[k]));
  EXPECT_GT(greens.size(), 100u);
}

TEST(Shading, MoreShadersThanListsOfSetsGiveOnePicture) {
  const EglContext context("software");
  Stand stand;
  stand.shaders[1] = parse_shader(plain("vec3(0.9, 0.9, 0.2)"), "busy.glsl");  // quicker to compile
  for (ShadedMaterial& material : stand.scene.materials) material.values.clear();
  stand.shaders.push_back(parse_shader(plain("vec3(0.1, 0.9, 0.2)"), "fourth.glsl"));
  stand.scene.materials.push_back({"fourth", {}});
  for (std::size_t k = 0; k < 9; k += 4) stand.scene.nodes[k].material = 4;
  // Several samples a pixel, and sizes that tiles do not divide.
  const auto drawn = [&](ShadingWay way) { return stand.drawn(way, 3, 107, 75); };
  const Image<float> factored = drawn(ShadingWay::factored);
  EXPECT_LE(largest_difference(drawn(ShadingWay::forward), factored), 1);
  EXPECT_LE(largest_difference(drawn(ShadingWay::deferred), factored), 1);
}

TEST(Shading, SamplesLieInRowsAndColumnsOfTheirOwn) {
  for (const int count : {1, 2, 5, 8, 16}) {
    std::set<int> columns, rows;
    for (const Eigen::Vector2d& place : sample_pattern(count)) {
      columns.insert(static_cast<int>(place.x() * count));
      rows.insert(static_cast<int>(place.y() * count));
    }
    EXPECT_EQ(columns.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(count));
  }
}

/// Reads the number of the shader at each sample, from 1; 0: nothing.
std::vector<std::uint32_t> shader_words(const ShadedFrame& frame) {
  std::vector<std::uint32_t> words(4 * static_cast<std::size_t>(frame.width()) * frame.height()), shaders;
  glGetTextureImage(frame.words().name(), 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, static_cast<GLsizei>(4 * words.size()),
                    words.data());
  for (std::size_t k = 3; k < words.size(); k += 4) shaders.push_back(words[k] >> 24);
  return shaders;
}

TEST(Shading, TilesAreInTheListsOfTheirShaders) {
  const EglContext context("software");
  Stand stand;
  stand.make_constant("vec3(0.5)");
  const int width = 203, height = 150;
  for (const ShadingWay way : {ShadingWay::deferred, ShadingWay::factored}) {
    ShadingSettings settings;
    settings.way = way;
    settings.samples = 1;
    ShadedRenderer renderer(stand.scene, stand.shaders, settings);
    const ShadedFrame frame = renderer.make_frame(width, height);
    renderer.draw(stand.camera, frame);
    const std::vector<std::uint32_t> shaders = shader_words(frame);
    const auto columns = static_cast<std::size_t>(frame.columns()), rows = static_cast<std::size_t>(frame.rows());
    ASSERT_EQ(columns * rows, 13u * 10u);
    std::vector<std::uint32_t> masks(columns * rows);
    for (std::size_t k = 0; k < shaders.size(); ++k)
      if (shaders[k] > 0) masks[k / width / 16 * columns + k % width / 16] |= 1u << (shaders[k] - 1);
    const std::vector<std::uint32_t> sets = renderer.programs().sets();
    std::vector<std::uint32_t> commands(4 * sets.size()), listed(sets.size() * masks.size());
    glGetNamedBufferSubData(frame.commands().name(), 0, static_cast<GLsizeiptr>(4 * commands.size()), commands.data());
    glGetNamedBufferSubData(frame.listed().name(), 0, static_cast<GLsizeiptr>(4 * listed.size()), listed.data());
    std::size_t mixed = 0;
    for (std::size_t list = 0; list < sets.size(); ++list) {
      std::multiset<std::uint32_t> expected;
      for (std::uint32_t tile = 0; tile < masks.size(); ++tile) {
        const bool single = (sets[list] & (sets[list] - 1)) == 0;
        if (way == ShadingWay::factored ? masks[tile] == sets[list] : single && (masks[tile] & sets[list]) != 0)
          expected.insert(tile);
        if (!single && masks[tile] == sets[list]) ++mixed;
      }
      const auto first = listed.begin() + static_cast<std::ptrdiff_t>(list * masks.size());
      EXPECT_EQ(std::multiset<std::uint32_t>(first, first + commands[4 * list + 1]), expected) << list;
    }
    EXPECT_GT(mixed, 10u);
  }
}

TEST(Shading, EachVisibleSampleIsShadedOnce) {
  const EglContext context("software");
  Stand stand;
  stand.make_constant("vec3(1.0)");
  for (const ShadingWay way : {ShadingWay::deferred, ShadingWay::factored}) {
    ShadingSettings settings;
    settings.way = way;
    settings.samples = 4;  // a quarter each, which float32 adds exactly
    ShadedRenderer renderer(stand.scene, stand.shaders, settings);
    const int width = 200, height = 150;
    const ShadedFrame frame = renderer.make_frame(width, height);
    renderer.draw(stand.camera, frame);
    Image<float> picture(width, height, 4);
    glGetTextureImage(frame.picture().name(), 0, GL_RGBA, GL_FLOAT, 4 * 4 * width * height, picture.values().data());
    const std::vector<std::uint32_t> last = shader_words(frame);
    std::size_t whole = 0, part = 0;
    for (std::size_t k = 0; k < last.size(); ++k) {
      const float red = picture.values()[4 * k], coverage = picture.values()[4 * k + 3];
      ASSERT_EQ(red, coverage);
      ASSERT_LE(coverage, 1);
      if (last[k] > 0) {
        ASSERT_GE(coverage, 0.25f);
      }
      if (coverage == 1)
        ++whole;
      else if (coverage > 0)
        ++part;
    }
    EXPECT_GT(whole, 10000u);
    EXPECT_GT(part, 100u);
  }
}

TEST(Shading, UniformsAreComputedOnceAFrame) {
  const EglContext context("software");
  Stand stand;
  // The value itself is the colour.
  stand.shaders[1] = parse_shader(
      "parameter vec3 paint = vec3(0.1);\nparameter int stripes = 2;\nuniform float twice = 2.0 * paint.x + time;\n"
      "uniform vec3 all = vec3(twice, float(stripes), float(frame));\n"
      "void before_light(Surface surface, inout Appearance appearance) {}\n"
      "vec3 after_light(Surface surface, Appearance appearance, Light light) { return all; }\n",
      "busy.glsl");
  ShadingSettings settings;
  settings.samples = 3;
  ShadedRenderer renderer(stand.scene, stand.shaders, settings);
  const ShadedFrame frame = renderer.make_frame(200, 150);
  for (int k = 0; k < 4; ++k) renderer.draw(stand.camera, frame, 0.25 * k, k);
  // Two materials have that shader, over three samples and the reflection map.
  EXPECT_EQ(renderer.uniform_evaluations(), 4u * 2u);
  Image<float> picture(200, 150, 4);
  glGetTextureImage(frame.picture().name(), 0, GL_RGBA, GL_FLOAT, 4 * 4 * 200 * 150, picture.values().data());
  std::size_t first = 0, second = 0;
  for (std::size_t k = 0; k < picture.values().size(); k += 4) {
    const Eigen::Vector3f color(picture.values()[k], picture.values()[k + 1], picture.values()[k + 2]);
    first += (color - Eigen::Vector3f(0.95f, 2, 3)).norm() < 1e-4f;
    second += (color - Eigen::Vector3f(2.75f, 3, 3)).norm() < 1e-4f;  // its own paint and stripes
  }
  EXPECT_GT(first, 500u);
  EXPECT_GT(second, 500u);
}

/// Shows what the light says, on a floor seen from above, by a shader of this expression.
struct FloorStand {
  TriangleMesh ball = shapes::cube_sphere(32, 0.5f), ground = shapes::plane(4, 6);
  ShadedScene scene;
  Eigen::Vector3d middle{0.3, 0.9, -0.2};
  Camera camera;

  FloorStand() {
    scene.meshes = {{&ball, nullptr}, {&ground, nullptr}};
    scene.materials = {{"ball", {}}, {"floor", {}}};
    ShadedNode node{0, 0, {}};
    node.placement.translation = middle;
    scene.nodes = {node, {1, 1, {}, false}};
    CameraSettings settings;
    settings.azimuth_degrees = 30;
    settings.elevation_degrees = 40;
    camera = make_camera(ground.positions, settings, 200, 150);
  }

  Image<float> drawn(const std::string& floor, const std::string& ball_color) const {
    const std::string before =
        "void before_light(Surface surface, inout Appearance appearance) { appearance.mirror = 1.0; }\n"
        "vec3 after_light(Surface surface, Appearance appearance, Light light) { return ";
    ShadingSettings settings;
    settings.samples = 1;
    ShadedRenderer renderer(scene,
                            {parse_shader(before + ball_color + "; }\n", "ball.glsl"),
                             parse_shader(before + floor + "; }\n", "floor.glsl")},
                            settings);
    return shaded_picture(renderer, camera, 200, 150);
  }

  /// Returns by how many radii a ray misses the ball's middle; negative t: it is behind.
  double miss(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const {
    const Eigen::Vector3d unit = along.normalized(), to = middle - from;
    return to.dot(unit) < 0 ? 9 : (to - to.dot(unit) * unit).norm() / 0.5;
  }

  /// Visits pixels that show the floor and not the ball.
  template <class Visit>
  void visit(Visit visit) const {
    for (int j = 0; j < 150; ++j)
      for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d from = camera.position.cast<double>(),
                              ray = camera.pixel_direction(i, j, 200, 150).cast<double>();
        if (!(ray.y() < 0) || miss(from, ray) < 1.1) continue;
        const Eigen::Vector3d place = from - from.y() / ray.y() * ray;
        if (place.cwiseAbs().maxCoeff() < 2.9) visit(i, j, place, ray);
      }
  }
};

TEST(Shading, ShadowsFallWhereRaysToTheLightAreBlocked) {
  const EglContext context("software");
  for (const std::string light : {"sphere:1.5,4,2,0.1", "40,50"}) {
    FloorStand stand;
    stand.scene.lights.specs = {parse_light_spec(light)};
    const Image<float> picture = stand.drawn("vec3(light.visibility)", "vec3(0.0)");
    const Eigen::Vector3d ball(1.5, 4, 2);
    int dark = 0, bright = 0;
    stand.visit([&](int i, int j, const Eigen::Vector3d& place, const Eigen::Vector3d&) {
      const Eigen::Vector3d towards =
          light[0] == 's'
              ? Eigen::Vector3d(ball - place)
              : Eigen::Vector3d(std::cos(50 * M_PI / 180) * std::sin(40 * M_PI / 180), std::sin(50 * M_PI / 180),
                                std::cos(50 * M_PI / 180) * std::cos(40 * M_PI / 180));
      const double miss = stand.miss(place, towards);
      // The filter is four texels wide and places are moved by two, of 1/1000 of a unit: a hundredth of the radius.
      if (miss > 0.97 && miss < 1.03) return;
      ASSERT_NEAR(picture.at(i, j, 0), miss < 1 ? 0 : 1, 1e-3) << light << ": " << i << ", " << j << ", " << miss;
      ++(miss < 1 ? dark : bright);
    });
    EXPECT_GT(dark, 60);
    EXPECT_GT(bright, 3000);
  }
}

TEST(Shading, ReflectionsAreWhereMirroredRaysHit) {
  const EglContext context("software");
  FloorStand stand;
  stand.scene.mirror = MirrorPlane{1};
  stand.scene.background = {0.125f, 0.25f, 0.5f};
  // The ball's colour is its normal, so that it is the right side that is seen.
  const Image<float> picture = stand.drawn("light.reflection", "0.5 + 0.5 * surface.normal");
  int hits = 0, misses = 0;
  stand.visit([&](int i, int j, const Eigen::Vector3d& place, const Eigen::Vector3d& ray) {
    const Eigen::Vector3d mirrored = Eigen::Vector3d(ray.x(), -ray.y(), ray.z()).normalized();
    const double miss = stand.miss(place, mirrored);
    // A texel of the map is 1/50 of the radius wide, and its lookup is bilinear.
    if (miss > 0.93 && miss < 1.07) return;
    Eigen::Vector3d expected(0.125, 0.25, 0.5);
    if (miss < 1) {
      const double along = (stand.middle - place).dot(mirrored) - 0.5 * std::sqrt(1 - miss * miss);
      expected = 0.5 * (Eigen::Vector3d::Ones() + (place + along * mirrored - stand.middle).normalized());
    }
    // Within an outline of 1.07 radii, normals change by at most 1/50 / sqrt(1 - 0.93^2) a texel.
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(picture.at(i, j, c), expected[c], miss < 1 ? 0.03 : 1e-4) << i << ", " << j << ", " << miss;
    ++(miss < 1 ? hits : misses);
  });
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 3000);
}

TEST(Shading, MirrorsMoveWithTheirNode) {
  const EglContext context("software");
  FloorStand stand;
  stand.scene.mirror = MirrorPlane{1};
  const auto drawn = [&] { return stand.drawn("light.reflection", "0.5 + 0.5 * to_object(surface.normal)"); };
  const Image<float> before = drawn();
  // All that is there, and the camera, turned and moved: the same picture.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d by(3, 2, -1);
  for (ShadedNode& node : stand.scene.nodes) {
    node.placement.translation = turn * node.placement.translation + by;
    node.placement.rotation = turn * node.placement.rotation;
  }
  const Eigen::Matrix3f axes = turn.cast<float>();
  stand.camera.position = axes * stand.camera.position + by.cast<float>();
  for (Eigen::Vector3f* axis : {&stand.camera.right, &stand.camera.up, &stand.camera.forward}) *axis = axes * *axis;
  const Image<float> after = drawn();
  int same = 0, bright = 0;
  for (std::size_t k = 0; k < before.values().size(); ++k) {
    same += std::abs(before.values()[k] - after.values()[k]) < 0.01f;
    bright += before.values()[k] > 0.3f;
  }
  EXPECT_GT(same, 0.999 * static_cast<double>(before.values().size()));  // rounding moves outlines
  EXPECT_GT(bright, 2000);
}

TEST(Shading, PicturesAreMipMapped) {
  const EglContext context("software");
  const Scratch scratch;
  Image<std::uint8_t> checks(256, 256, 3);
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i)
      for (int c = 0; c < 3; ++c) checks.at(i, j, c) = (i + j) % 2 == 0 ? 0 : 200;
  write_png(scratch / "checks.png", checks);
  const std::string text =
      "texture checks = \"checks.png\" linear;\n"
      "void before_light(Surface surface, inout Appearance appearance) {}\n"
      "vec3 after_light(Surface surface, Appearance appearance, Light light) {\n"
      "  return mip_mapped(checks, surface.uv, surface.footprint).rgb;\n}\n";
  FloorStand stand;
  stand.scene.nodes.erase(stand.scene.nodes.begin());
  ShadingSettings settings;
  settings.samples = 1;
  ShadedRenderer renderer(
      stand.scene, {parse_shader(text, scratch / "floor.glsl"), parse_shader(text, scratch / "ball.glsl")}, settings);
  // A pixel is several texels wide, so that the picture is grey.
  const Image<float> picture = shaded_picture(renderer, stand.camera, 50, 40);
  int covered = 0;
  for (std::size_t k = 0; k < picture.values().size(); k += 4)
    if (picture.values()[k + 3] > 0) {
      ASSERT_NEAR(picture.values()[k], 100.0 / 255, 2.0 / 255);
      ++covered;
    }
  EXPECT_GT(covered, 300);
}

TEST(Shading, MovedNodesAndLightsAreAsIfMadeThere) {
  const EglContext context("software");
  Stand stand;
  stand.make_constant("light.diffuse");
  ShadingSettings settings;
  settings.samples = 1;
  ShadedRenderer moved(stand.scene, stand.shaders, settings);
  const Image<float> before = shaded_picture(moved, stand.camera, 200, 150);
  std::vector<Placement> placements;
  for (ShadedNode& node : stand.scene.nodes) {
    node.placement.translation += Eigen::Vector3d(0.3, 0.1, -0.2);
    placements.push_back(node.placement);
  }
  stand.scene.lights.specs = {parse_light_spec("-60,50"), parse_light_spec("20,70,0.2,0.3,0.4"),
                              parse_light_spec("hemisphere:0,90,0.3,0.3,0.3,0.1,0.1,0.1")};
  moved.set_placements(placements);
  moved.set_lights(stand.scene.lights);
  ShadedRenderer made(stand.scene, stand.shaders, settings);
  const Image<float> expected = shaded_picture(made, stand.camera, 200, 150);
  EXPECT_EQ(shaded_picture(moved, stand.camera, 200, 150).values(), expected.values());
  EXPECT_GT(largest_difference(before, expected), 20);
}

TEST(Shading, ValuesOutOfRangeAndUnknownShadersAreRefused) {
  const EglContext context("software");
  const auto refused = [](const ShadedMaterial& material) -> std::string {
    Stand stand;
    stand.scene.materials[1] = material;
    try {
      const ShadedRenderer renderer(stand.scene, stand.shaders, {});
    } catch (const WrongUsage& fault) {
      return fault.what();
    }
    return "none";
  };
  EXPECT_EQ(refused({"busy", {{"stripes", {20}}}}), "none");
  EXPECT_NE(refused({"busy", {{"stripes", {21}}}}).find("busy.stripes: found 21"), std::string::npos);
  EXPECT_NE(refused({"busy", {{"phase", {1}}}}).find("declares no such parameter"), std::string::npos);
  EXPECT_NE(refused({"bussy", {}}).find("expected one of plain, busy, floor"), std::string::npos);
}

TEST(Shading, FaultyShadersLeaveTheOldOnes) {
  const EglContext context("software");
  Stand stand;
  stand.make_constant("vec3(1.0, 0.0, 0.0)");
  ShadingSettings settings;
  settings.samples = 1;
  ShadedRenderer renderer(stand.scene, stand.shaders, settings);
  const Image<float> before = shaded_picture(renderer, stand.camera, 200, 150);
  std::vector<SurfaceShader> others = stand.shaders;
  others[0] = parse_shader("float f() {\n  return oops;\n}\n" + plain("vec3(1)"), "plain.glsl");
  EXPECT_THROW(renderer.set_shaders(others), BadInput);
  EXPECT_EQ(shaded_picture(renderer, stand.camera, 200, 150).values(), before.values());
  stand.make_constant("vec3(0.0, 1.0, 0.0)");
  renderer.set_shaders(stand.shaders);
  EXPECT_GT(largest_difference(shaded_picture(renderer, stand.camera, 200, 150), before), 50);
}

}  // namespace test_shading
}  // namespace kiln
