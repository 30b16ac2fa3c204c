// SPDX-License-Identifier: MIT
// Draws the ball in out/bunny/prt by the lines of docs/guide/engine.md, and checks its pixels.

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <kiln/asset.h>
#include <kiln/gl/renderer.h>
#include <kiln/light.h>
#include <vector>

namespace {

constexpr int side = 64;

bool make_context() {
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) return false;
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

/// Binds a framebuffer of floats whose pixels are -1.
void bind_framebuffer() {
  GLuint framebuffer, color, depth;
  glCreateFramebuffers(1, &framebuffer);
  glCreateRenderbuffers(1, &color);
  glCreateRenderbuffers(1, &depth);
  glNamedRenderbufferStorage(color, GL_RGBA32F, side, side);
  glNamedRenderbufferStorage(depth, GL_DEPTH_COMPONENT24, side, side);
  glNamedFramebufferRenderbuffer(framebuffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  glNamedFramebufferRenderbuffer(framebuffer, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, side, side);
  glEnable(GL_DEPTH_TEST);
  glClearColor(-1, -1, -1, -1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

}  // namespace

int main() {
  if (!make_context()) return 5;
  bind_framebuffer();
  // The ball has a radius of 1; it fills the middle of the picture, seen from +Z.
  const std::array<float, 16> clip_from_object = {0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, -0.5f, 0, 0, 0, 0, 1};
  const std::array<float, 3> eye_object = {0, 0, 100};

#include "engine_1.inc"

  std::vector<float> pixels(4 * side * side);
  glReadPixels(0, 0, side, side, GL_RGBA, GL_FLOAT, pixels.data());
  int drawn = 0;
  float brightest = -1;
  for (std::size_t k = 0; k < pixels.size(); k += 4) {
    drawn += pixels[k] != -1 ? 1 : 0;
    brightest = std::max(brightest, pixels[k]);
  }
  // The ball is a disc of 804 pixels without what its facets cut off. It is white; the brightest pixel faces the light,
  // whose radiance is 1, up to some degrees and a step of 8 bits in each of 9 planes.
  std::printf("%d pixels, the brightest %.3f\n", drawn, static_cast<double>(brightest));
  return drawn > 700 && drawn < 830 && brightest > 0.97f && brightest < 1.01f ? 0 : 1;
}
