// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/options.h"
#include "view/state/view_state.h"

namespace kiln {

/// What a window tells of the person in front of it.
struct WindowEvents {
  std::function<void(char)> key;                              ///< one character, as the layout has it; or escape
  std::function<void(Drag, double right, double down)> drag;  ///< pixels
  std::function<void(double)> wheel;                          ///< steps forwards
  std::function<void()> redraw;                               ///< the content was lost, or has another size
};

/// A window and its OpenGL 4.5 core context, current on the thread that made it for as long as it lives. One at a time.
class Window {
 public:
  /// `width` x `height` as the display counts: pixels, unless it says otherwise. A software renderer uses
  /// `software_threads` threads. Throws MachineLacks where there is no display or no such context.
  Window(const std::string& title, int width, int height, int software_threads);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void listen(WindowEvents events);

  /// Tells of events as they come, for at most so long; returns after the first.
  void wait(double seconds);

  bool is_closing() const;

  /// Of what is drawn into: pixels. 0 x 0 while the window is iconified.
  Extent framebuffer() const;

  /// How much larger than at 96 dots per inch text should be.
  double content_scale() const;

  /// Shows what was drawn. `wait_for_display` waits until the display is ready for it.
  void swap(bool wait_for_display);

  void resize(int width, int height);

  /// GL_RENDERER.
  const std::string& renderer() const { return renderer_; }

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
  std::string renderer_;
};

}  // namespace kiln
