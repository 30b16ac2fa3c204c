// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gpu/egl_context.h"
#include "mesh/camera.h"
#include "runtime/shading/shaded_renderer.h"
#include "runtime/shading/shader_file.h"
#include "shapes.h"

/// Shaders and a scene for tests.
namespace kiln::shading_stand {

inline constexpr const char* plain_after =
    "vec3 after_light(Surface surface, Appearance appearance, Light light) {\n"
    "  return appearance.base_color * light.diffuse + 0.4 * light.specular;\n"
    "}\n";

/// Returns the largest difference of two pictures in steps of 8 bits.
inline double largest_difference(const Image<float>& a, const Image<float>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.values().size(); ++k)
    largest = std::max<double>(largest, std::abs(a.values()[k] - b.values()[k]));
  return 255 * largest;
}

/// A shader of one colour.
inline std::string plain(const std::string& color) {
  return "parameter vec3 paint = " + color +
         ";\nvoid before_light(Surface surface, inout Appearance appearance) {\n"
         "  appearance.base_color = paint;\n  appearance.shininess = 30.0;\n}\n" +
         plain_after;
}

/// A shader that uses everything: a uniform, a varying, helpers and a global variable whose names other shaders have
/// too.
inline std::string busy() {
  return "parameter vec3 paint = vec3(0.2, 0.5, 0.9) in 0 to 1;\n"
         "parameter int stripes = 6 in 1 to 20;\n"
         "uniform float phase = 0.25 + time;\n"
         "uniform vec2 both = vec2(phase, 2.0 * phase);\n"
         "varying vec2 slow = 0.5 + 0.5 * surface.object.xy;\n"
         "float wave;  // from before the light to after it\n"
         "float smooth_wave(float at) { return 0.5 + 0.5 * sin(6.2832 * at); }\n"
         "void before_light(Surface surface, inout Appearance appearance) {\n"
         "  wave = smooth_wave(float(stripes) * surface.uv.x + both.y);\n"
         "  appearance.base_color = mix(paint, vec3(slow, 0.3), wave);\n"
         "  appearance.normal = normalize(surface.normal + 0.1 * sin(20.0 * surface.object));\n"
         "  appearance.shininess = 12.0;\n}\n"
         "vec3 after_light(Surface surface, Appearance appearance, Light light) {\n"
         "  return appearance.base_color * light.diffuse + wave * light.specular;\n}\n";
}

/// A floor that mirrors.
inline std::string floor() {
  return "float smooth_wave(float at) { return 0.6 + 0.2 * sin(at); }\n"
         "void before_light(Surface surface, inout Appearance appearance) {\n"
         "  appearance.base_color = vec3(smooth_wave(40.0 * surface.uv.y), 0.6, 0.4);\n"
         "  appearance.mirror = 1.0;\n  appearance.blur = 1.0;\n}\n"
         "vec3 after_light(Surface surface, Appearance appearance, Light light) {\n"
         "  return appearance.base_color * light.diffuse + 0.3 * light.reflection;\n}\n";
}

/// Spheres of two shaders, some behind others, on a floor of a third, under a ball and ambient light.
struct Stand {
  TriangleMesh ball = shapes::cube_sphere(12, 0.5f), ground = shapes::plane(4, 6);
  std::vector<SurfaceShader> shaders = {parse_shader(plain("vec3(0.8, 0.3, 0.2)"), "plain.glsl"),
                                        parse_shader(busy(), "busy.glsl"), parse_shader(floor(), "floor.glsl")};
  ShadedScene scene;
  Camera camera;

  explicit Stand(int width = 200, int height = 150) {
    scene.meshes = {{&ball, nullptr}, {&ground, nullptr}};
    scene.materials = {
        {"plain", {}}, {"busy", {}}, {"busy", {{"paint", {1, 0.8f, 0.1f, 0}}, {"stripes", {3}}}}, {"floor", {}}};
    for (int k = 0; k < 9; ++k) {
      ShadedNode node{0, k % 3, {}};
      node.placement.translation = Eigen::Vector3d(1.1 * (k % 3) - 1.1, 0.55 + 0.2 * (k / 3), 1.0 - k / 3);
      node.placement.rotation = Eigen::AngleAxisd(0.3 * k, Eigen::Vector3d::UnitY()).toRotationMatrix();
      scene.nodes.push_back(node);
    }
    scene.nodes.push_back({1, 3, {}, false});
    scene.mirror = MirrorPlane{9};
    scene.lights.specs = {parse_light_spec("sphere:3,5,4,0.3,1,0.95,0.9"), parse_light_spec("ambient:0.2")};
    camera = camera_at(width, height);
  }

  /// Gives all nodes shaders of constant `radiance`, without a mirror: quick to compile.
  void make_constant(const std::string& radiance) {
    const std::string text =
        "void before_light(Surface surface, inout Appearance appearance) {}\n"
        "vec3 after_light(Surface surface, Appearance appearance, Light light) { return " +
        radiance + "; }\n";
    for (SurfaceShader& shader : shaders) shader = parse_shader(text, shader.file);
    for (ShadedMaterial& material : scene.materials) material.values.clear();
    scene.mirror.reset();
  }

  Camera camera_at(int width, int height) const {
    std::vector<Eigen::Vector3f> shape;
    for (const Eigen::Vector3f& vertex : ground.positions) shape.push_back(0.5f * vertex);
    CameraSettings settings;
    settings.azimuth_degrees = 25;
    settings.elevation_degrees = 20;
    Camera made = make_camera(shape, settings, width, height);
    made.near_distance = 1;
    made.far_distance = 40;
    return made;
  }

  Image<float> drawn(ShadingWay way, int samples = 1, int width = 200, int height = 150, double seconds = 0.1) const {
    ShadingSettings settings;
    settings.way = way;
    settings.samples = samples;
    settings.shadow_size = 256;
    settings.reflection_size = 128;
    ShadedRenderer renderer(scene, shaders, settings);
    return shaded_picture(renderer, camera, width, height, seconds);
  }
};

}  // namespace kiln::shading_stand
