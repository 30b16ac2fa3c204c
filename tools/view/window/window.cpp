// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/window/window.h"

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/errors.h"
#include "base/extent.h"
#include "base/interruption.h"
#include "view/state/keys.h"

namespace kiln {

namespace {

/// Returns GLFW's message about its last failure.
std::string failure() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

/// GLFW, for as long as a window needs it.
struct Library {
  Library() {
    if (glfwInit() != GLFW_TRUE)
      throw MachineLacks("no display to open a window on (" + failure() +
                         "); run this where there is a desktop, or draw with kiln-render, which needs none");
  }
  ~Library() { glfwTerminate(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

}  // namespace

struct Window::Implementation {
  Library library;
  GLFWwindow* window = nullptr;
  WindowEvents events;
  double pointer_x = 0, pointer_y = 0;
  int swap_interval = -1;

  Implementation(const std::string& title, int width, int height) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);  // pictures have depth buffers of their own
    window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window == nullptr)
      throw MachineLacks("no window with an OpenGL 4.5 core context (" + failure() +
                         "); install libgl1-mesa-dri and libglx-mesa0, or a GPU driver with OpenGL 4.5");
    glfwSetWindowUserPointer(window, this);
    glfwSetCharCallback(window, [](GLFWwindow* from, unsigned int character) {
      if (character < 128) of(from).key(static_cast<char>(character));
    });
    glfwSetKeyCallback(window, [](GLFWwindow* from, int key, int, int action, int) {
      if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) of(from).key(escape_key);
      if (action == GLFW_RELEASE) return;
      if (key == GLFW_KEY_LEFT) of(from).key(left_key);
      if (key == GLFW_KEY_RIGHT) of(from).key(right_key);
      if (key == GLFW_KEY_UP) of(from).key(up_key);
      if (key == GLFW_KEY_DOWN) of(from).key(down_key);
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* from, int button, int action, int) {
      if (button == GLFW_MOUSE_BUTTON_LEFT && action == GLFW_PRESS) of(from).hold();
    });
    glfwSetScrollCallback(window, [](GLFWwindow* from, double, double steps) {
      if (of(from).events.wheel) of(from).events.wheel(steps);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* from, double x, double y) { of(from).move_pointer(x, y); });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* from, int, int) { of(from).redraw(); });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* from) { of(from).redraw(); });
    glfwMakeContextCurrent(window);
    glfwGetCursorPos(window, &pointer_x, &pointer_y);
  }
  ~Implementation() {
    if (window != nullptr) glfwDestroyWindow(window);
  }

  static Implementation& of(GLFWwindow* from) { return *static_cast<Implementation*>(glfwGetWindowUserPointer(from)); }

  void key(char character) const {
    if (events.key) events.key(character);
  }
  void hold() const {
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    const auto [across, down] = pixels_per_unit();
    if (events.hold) events.hold(x * across, y * down);
  }
  void redraw() const {
    if (events.redraw) events.redraw();
  }
  /// Returns what converts the pointer's coordinates, which on some displays are not pixels.
  std::pair<double, double> pixels_per_unit() const {
    int window_width = 1, window_height = 1, pixels_across = 1, pixels_up = 1;
    glfwGetWindowSize(window, &window_width, &window_height);
    glfwGetFramebufferSize(window, &pixels_across, &pixels_up);
    return {static_cast<double>(pixels_across) / std::max(1, window_width),
            static_cast<double>(pixels_up) / std::max(1, window_height)};
  }
  void move_pointer(double x, double y) {
    const auto is_down = [&](int button) { return glfwGetMouseButton(window, button) == GLFW_PRESS; };
    const bool shift =
        glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS || glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    const auto [across, high] = pixels_per_unit();
    const double right = (x - pointer_x) * across, down = (y - pointer_y) * high;
    pointer_x = x;
    pointer_y = y;
    if (!events.drag) return;
    if (is_down(GLFW_MOUSE_BUTTON_LEFT))
      events.drag(shift ? Drag::pan : Drag::orbit, right, down);
    else if (is_down(GLFW_MOUSE_BUTTON_MIDDLE))
      events.drag(Drag::pan, right, down);
    else if (is_down(GLFW_MOUSE_BUTTON_RIGHT))
      events.drag(Drag::light, right, down);
  }
};

Window::Window(const std::string& title, int width, int height, int software_threads) {
  // llvmpipe reads its thread count from the environment, once.
  if (software_threads > 0) setenv("LP_NUM_THREADS", std::to_string(software_threads).c_str(), 0);
  implementation_ = std::make_unique<Implementation>(title, width, height);
  renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

Window::~Window() = default;

void Window::listen(WindowEvents events) { implementation_->events = std::move(events); }

void Window::wait(double seconds) {
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
}

bool Window::is_closing() const { return glfwWindowShouldClose(implementation_->window) == GLFW_TRUE; }

Extent Window::framebuffer() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(implementation_->window, &width, &height);
  return {width, height};
}

double Window::content_scale() const {
  float across = 1, up = 1;
  glfwGetWindowContentScale(implementation_->window, &across, &up);
  return across > 0 ? across : 1;
}

void Window::swap(bool wait_for_display) {
  const int interval = wait_for_display ? 1 : 0;
  if (implementation_->swap_interval != interval) glfwSwapInterval(interval);
  implementation_->swap_interval = interval;
  glfwSwapBuffers(implementation_->window);
}

void Window::resize_and_wait(int width, int height) {
  using Clock = std::chrono::steady_clock;
  constexpr auto patience = std::chrono::seconds(60);
  glfwSetWindowSize(implementation_->window, width, height);
  const auto begun = Clock::now();
  while (!(framebuffer() == Extent(width, height))) {
    throw_if_interrupted();
    if (Clock::now() - begun > patience)
      throw MachineLacks("the display gave no window of " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels");
    wait(0.1);
  }
}

}  // namespace kiln
