// SPDX-License-Identifier: GPL-3.0-or-later
// A scene.yaml as shaders draw it.
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "image/image_file.h"
#include "render/film/film.h"
#include "scratch.h"
#include "shade/shade.h"

namespace kiln {
namespace test_shade_scene {

TEST(ShadeScene, NodesAndLightsAreWhereTheyAreInTime) {
  const Scratch scratch;
  std::ofstream(scratch / "square.obj") << "v -0.5 -0.5 0\nv 0.5 -0.5 0\nv 0.5 0.5 0\nv -0.5 0.5 0\n"
                                           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                                           "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n";
  std::ofstream(scratch / "paint.glsl")
      << "parameter vec3 paint = vec3(0);\n"
         "void before_light(Surface surface, inout Appearance appearance) {}\n"
         "vec3 after_light(Surface surface, Appearance appearance, Light light) { return paint * light.diffuse; }\n";
  // A square that faces the camera and the light steps from the left to the right, and the light becomes half.
  std::ofstream(scratch / "scene.yaml") << R"(
shaders: .
nodes:
  - name: group
    animate: {keyframes: [{time: 0, translate: [-1, 0, 0]}, {time: 1, translate: [1, 0, 0]}]}
    nodes:
      - {name: square, mesh: square.obj, shader: paint, set: {paint: [1, 0.5, 0.25]}, casts-shadow: false}
lights: [{directional: [0, 0], animate: {keyframes: [{time: 0, radiance: 1}, {time: 1, radiance: 0.5}]}}]
camera: {azimuth: 0, elevation: 0, target: [0, 0, 0], distance: 4, field-of-view: 30}
)";
  ShadeScene scene = load_shade_scene(scratch / "scene.yaml");
  ShadeSettings settings;
  settings.picture.width = 80;
  settings.picture.height = 40;
  settings.picture.frames = 2;
  settings.picture.gl_device = "software";
  settings.film.strip = true;
  use_scene_look(settings.picture, scene.film.description, [](const std::string&) { return false; });
  OutputSet outputs(scratch / "out");
  shade_to_files(outputs, "film.exr", scene, settings, 1, [](double) {});
  outputs.commit();
  const Picture film = read_picture(scratch / "out" / "film.exr");
  const auto& pixels = std::get<Image<float>>(film.pixels);
  ASSERT_EQ(pixels.width(), 160);
  // The square's side over the height of what is seen at its distance.
  const double side = 1 / (2 * 4 * std::tan(15 * 3.14159265358979 / 180)), area = side * 40 * side * 40;
  double covered[4] = {};  // by quarter of the strip: the left and the right of each frame
  for (int j = 0; j < pixels.height(); ++j)
    for (int i = 0; i < pixels.width(); ++i) {
      const float alpha = pixels.at(i, j, 3), radiance = i < 80 ? 1.f : 0.5f;
      covered[i / 40] += static_cast<double>(alpha);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(pixels.at(i, j, c), alpha * radiance * std::pow(0.5f, static_cast<float>(c)), 2e-3f);
    }
  EXPECT_NEAR(covered[0], area, 0.03 * area);
  EXPECT_EQ(covered[1], 0);
  EXPECT_EQ(covered[2], 0);
  EXPECT_NEAR(covered[3], area, 0.03 * area);
}

}  // namespace test_shade_scene
}  // namespace kiln
