// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/draw/canvas.h"
#include "view/draw/screen.h"
#include "view/files/file_watch.h"
#include "view/frame_clock.h"
#include "view/state/script.h"
#include "view/window/window.h"

namespace kiln {

/// What a viewer's window is called, and where it reports.
struct ViewerWindowSetup {
  std::string name;                             ///< in its title, and of screenshots
  int width = 0, height = 0;                    ///< screen units
  std::string screenshots = ".";                ///< folder for screenshots
  std::function<void(const std::string&)> say;  ///< called with lines for the terminal
  int threads = 0;                              ///< of a software renderer; 0: all
};

/// What the viewers of an asset and of a scene share: the window, scripts, messages, screenshots, and files that are
/// read again when they change.
class ViewerWindow {
 public:
  virtual ~ViewerWindow() = default;

  /// Runs until the person closes the window.
  void run();

  /// Runs a script step by step, then closes. Throws BadInput if a picture cannot be written.
  void run(const std::vector<ScriptStep>& script);

 protected:
  /// Opens the window. Throws MachineLacks if that is impossible.
  explicit ViewerWindow(ViewerWindowSetup setup);

  virtual void press_key(char key) = 0;
  virtual void turn_wheel(double steps) = 0;
  /// Carries out a step of a script that drags something.
  virtual void drag_step(const ScriptStep& step) = 0;
  /// Draws the picture into the canvas and finishes it on the screen, for a window of that size.
  virtual void draw_picture(const Extent& size) = 0;
  /// Panels beside those of messages.
  virtual std::vector<PlacedPanel> panels() = 0;
  /// Goes on by the time since the last call; `seconds` is that of one frame in scripts.
  virtual void advance([[maybe_unused]] double seconds) {}
  virtual bool is_playing() const { return false; }
  /// Takes changed files in. Throws BadInput or MachineLacks; what was shown then stays.
  virtual void reload() {}
  /// Says what stays where reload() fails.
  virtual const char* kept_heading() const { return ""; }

  void watch(std::vector<std::filesystem::path> folders);
  void note(const std::string& message);
  void draw();
  void take_screenshot();
  /// Makes a canvas for the window, with so many samples of a pixel along each axis, unless there is one.
  void fit_canvas(const Extent& size, int supersample);

  Window window_;
  Screen screen_;
  std::unique_ptr<Canvas> canvas_;
  FrameClock clock_;
  bool has_to_draw_ = true, is_closing_ = false, is_scripted_ = false;
  std::string message_;  // on the screen until message_until_
  std::vector<std::string> screenshots_;

 private:
  void do_step(const ScriptStep& step);
  void write_picture_file(const std::filesystem::path& file, bool with_panels);
  std::vector<PlacedPanel> all_panels();
  bool reload_if_changed();
  void wait_for_reload();

  ViewerWindowSetup setup_;
  std::optional<FileWatch> watch_;
  std::string fault_;  // of the last reload, until one succeeds
  std::chrono::steady_clock::time_point message_until_, looked_at_files_, advanced_at_;
};

}  // namespace kiln
