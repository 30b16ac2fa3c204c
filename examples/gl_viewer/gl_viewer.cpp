// SPDX-License-Identifier: MIT
// Shows an asset under a light: gl_viewer FOLDER            in a window; drag turns the asset, with shift the light
//                               gl_viewer FOLDER --picture FILE.ppm    without one, through EGL

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <kiln/asset.h>
#include <kiln/gl/renderer.h>
#include <kiln/light.h>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr double degree = 0.017453292519943295;
constexpr int picture_size = 512;

using Vector = std::array<float, 3>;

/// Returns the direction towards an azimuth (0 is +Z, 90 is +X) and an elevation, in degrees.
Vector towards(double azimuth, double elevation) {
  const double level = std::cos(elevation * degree);
  return {static_cast<float>(level * std::sin(azimuth * degree)), static_cast<float>(std::sin(elevation * degree)),
          static_cast<float>(level * std::cos(azimuth * degree))};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

float dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Camera {
  std::array<float, 16> clip_from_object;  ///< for column vectors, column after column
  Vector eye;
};

/// Places a camera that sees the whole mesh from a direction, with a vertical field of view of 30 degrees.
Camera camera_around(const kiln::runtime::Asset& asset, double azimuth, double elevation, float aspect) {
  Vector lowest = {1e30f, 1e30f, 1e30f}, highest = {-1e30f, -1e30f, -1e30f};
  for (std::size_t k = 0; k < asset.positions().size(); ++k) {
    lowest[k % 3] = std::min(lowest[k % 3], asset.positions()[k]);
    highest[k % 3] = std::max(highest[k % 3], asset.positions()[k]);
  }
  Vector centre, half;
  for (int axis = 0; axis < 3; ++axis) {
    centre[axis] = (lowest[axis] + highest[axis]) / 2;
    half[axis] = (highest[axis] - lowest[axis]) / 2;
  }
  const float radius = std::sqrt(dot(half, half)), tangent = std::tan(15 * static_cast<float>(degree));
  const float distance = radius / std::sin(15 * static_cast<float>(degree)) / std::min(1.f, aspect);
  const Vector back = towards(azimuth, elevation), right = towards(azimuth + 90, 0), up = cross(back, right);
  Camera camera;
  for (int axis = 0; axis < 3; ++axis) camera.eye[axis] = centre[axis] + distance * back[axis];
  const float nearest = distance - radius, farthest = distance + radius;
  const float depth = (farthest + nearest) / (nearest - farthest),
              shift = 2 * farthest * nearest / (nearest - farthest);
  // Multiplies the rows of the view matrix by those of the projection.
  const auto set_row = [&](int row, const Vector& axis, float scale, float added) {
    for (int column = 0; column < 3; ++column) camera.clip_from_object[4 * column + row] = scale * axis[column];
    camera.clip_from_object[12 + row] = -scale * dot(axis, camera.eye) + added;
  };
  set_row(0, right, 1 / (tangent * aspect), 0);
  set_row(1, up, 1 / tangent, 0);
  set_row(2, back, depth, shift);
  set_row(3, back, -1, 0);
  return camera;
}

struct View {
  double azimuth = 20, elevation = 12;              ///< direction of the camera, degrees
  double light_azimuth = 45, light_elevation = 30;  ///< direction of the light, degrees
};

void draw(kiln::runtime::gl::Renderer& renderer, const kiln::runtime::Asset& asset, const View& view, int width,
          int height) {
  glViewport(0, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glClearColor(0.1f, 0.1f, 0.1f, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  renderer.set_light(kiln::runtime::Light()
                         .directional(view.light_azimuth, view.light_elevation, {0.8f, 0.8f, 0.8f})
                         .ambient({0.1f, 0.1f, 0.12f}));
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const Camera camera = camera_around(asset, view.azimuth, view.elevation, aspect);
  renderer.draw(camera.clip_from_object, camera.eye);
}

void save_picture(const kiln::runtime::Asset& asset, const char* file) {
  // Step 1: create a context without a window.
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API))
    throw std::runtime_error("EGL has no display without a surface");
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
    throw std::runtime_error("EGL has no OpenGL 4.5");
  // Step 2: create a framebuffer, and draw the asset into it.
  GLuint framebuffer, color, depth;
  glCreateFramebuffers(1, &framebuffer);
  glCreateRenderbuffers(1, &color);
  glCreateRenderbuffers(1, &depth);
  glNamedRenderbufferStorage(color, GL_SRGB8_ALPHA8, picture_size, picture_size);
  glNamedRenderbufferStorage(depth, GL_DEPTH_COMPONENT32F, picture_size, picture_size);
  glNamedFramebufferRenderbuffer(framebuffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  glNamedFramebufferRenderbuffer(framebuffer, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  std::vector<unsigned char> pixels(3 * picture_size * picture_size);
  {
    kiln::runtime::gl::Renderer renderer(asset);
    draw(renderer, asset, {}, picture_size, picture_size);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, picture_size, picture_size, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  }
  // Step 3: write the file, whose first row is the top.
  std::FILE* const out = std::fopen(file, "wb");
  if (out == nullptr) throw std::runtime_error(std::string("cannot write ") + file);
  std::fprintf(out, "P6\n%d %d\n255\n", picture_size, picture_size);
  for (int row = picture_size - 1; row >= 0; --row)
    std::fwrite(pixels.data() + 3 * picture_size * row, 3, picture_size, out);
  std::fclose(out);
}

void show(const kiln::runtime::Asset& asset) {
  if (!glfwInit()) throw std::runtime_error("GLFW found no display");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SRGB_CAPABLE, GLFW_TRUE);
  GLFWwindow* const window = glfwCreateWindow(800, 800, "Kiln", nullptr, nullptr);
  if (window == nullptr) throw std::runtime_error("GLFW has no window with OpenGL 4.5");
  glfwMakeContextCurrent(window);
  {
    kiln::runtime::gl::Renderer renderer(asset);
    View view;
    double last_x = 0, last_y = 0;
    while (!glfwWindowShouldClose(window)) {
      double x, y;
      glfwGetCursorPos(window, &x, &y);
      if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        const bool is_light = glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS;
        (is_light ? view.light_azimuth : view.azimuth) += (is_light ? 0.4 : -0.4) * (x - last_x);
        double& elevation = is_light ? view.light_elevation : view.elevation;
        elevation = std::clamp(elevation + (is_light ? -0.4 : 0.4) * (y - last_y), -89.0, 89.0);
        view.light_azimuth = std::remainder(view.light_azimuth, 360);
      }
      last_x = x, last_y = y;
      int width, height;
      glfwGetFramebufferSize(window, &width, &height);
      draw(renderer, asset, view, std::max(width, 1), std::max(height, 1));
      glfwSwapBuffers(window);
      glfwPollEvents();
    }
  }
  glfwTerminate();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && !(argc == 4 && std::string(argv[2]) == "--picture")) {
    std::fprintf(stderr, "usage: gl_viewer FOLDER [--picture FILE.ppm]\n");
    return 2;
  }
  try {
    const auto asset = kiln::runtime::Asset::load(argv[1]);
    argc == 4 ? save_picture(asset, argv[3]) : show(asset);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gl_viewer: %s\n", error.what());
    return 3;
  }
}
