// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/extent.h"
#include "view/state/view_state.h"

namespace kiln {

/// Callbacks for what a person does at a window.
struct WindowEvents {
  std::function<void(char)> key;  ///< one character, as typed in the keyboard's layout; or escape or an arrow
  std::function<void(Drag, double right, double down)> drag;  ///< pixels
  std::function<void(double)> wheel;                          ///< steps forwards
  std::function<void()> redraw;                               ///< the content was lost, or has another size
  std::function<void(double, double)> hold = {};              ///< left button down, at pixels from the upper left
};

/// A window and its OpenGL 4.5 core context, current on the thread that made it for its lifetime. One at a time.
class Window {
 public:
  /// Opens a window of `width` x `height` screen units, which are pixels on most displays. A software renderer uses
  /// `software_threads` threads. Throws MachineLacks if there is no display or no such context.
  Window(const std::string& title, int width, int height, int software_threads);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void listen(WindowEvents events);

  /// Waits for events and reports them; returns after the first, or after `seconds`.
  void wait(double seconds);

  bool is_closing() const;

  /// Returns the size of the framebuffer in pixels; 0 x 0 while the window is iconified.
  Extent framebuffer() const;

  /// Returns how much larger than at 96 dots per inch text should be.
  double content_scale() const;

  /// Shows what was drawn. `wait_for_display` waits until the display is ready for it.
  void swap(bool wait_for_display);

  /// Resizes the window, and waits until it has so many pixels. Throws MachineLacks if the display does not give them.
  void resize_and_wait(int width, int height);

  /// Returns GL_RENDERER.
  const std::string& renderer() const { return renderer_; }

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
  std::string renderer_;
};

}  // namespace kiln
