// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/film/film.h"
#include "view/draw/canvas.h"
#include "view/draw/screen.h"
#include "view/frame_clock.h"
#include "view/state/scene_state.h"
#include "view/state/script.h"
#include "view/window/window.h"

namespace kiln {

/// Start settings of a scene in a window.
struct SceneViewerSetup {
  std::string name;  ///< title of the window, and of screenshots
  RenderSettings look;
  FilmSettings film;
  std::string screenshots = ".";                ///< folder for screenshots
  std::function<void(const std::string&)> say;  ///< called with lines for the terminal
  int threads = 0;                              ///< 0: all
};

/// A window in which a scene plays.
class SceneViewer {
 public:
  /// Opens the window; `film` must live on. Throws MachineLacks if that is impossible, and as FilmAssets does.
  SceneViewer(const SceneViewerSetup& setup, const Film& film);

  /// Runs until the person closes the window.
  void run();

  /// Runs a script step by step, then closes. A scene that plays goes on by a thirtieth of a second for each frame that
  /// a script draws.
  void run(const std::vector<ScriptStep>& script);

  /// Reports what was drawn by what, and how fast.
  Json metrics() const;

 private:
  void press_key(char key);
  void hold(double right, double down);
  void drag(Drag what, double right, double down);
  void do_step(const ScriptStep& step);
  void take_screenshot();
  void write_picture_file(const std::filesystem::path& file, bool with_panels);
  void draw();
  std::vector<PlacedPanel> panels();
  Camera camera();

  SceneViewerSetup setup_;
  Window window_;
  MovingScene scene_;
  int samples_;
  FilmAssets assets_;
  Screen screen_;
  SceneState home_, state_;
  double duration_;
  std::unique_ptr<Canvas> canvas_;
  FrameClock clock_, light_clock_;
  bool has_to_draw_ = true, is_closing_ = false, is_scripted_ = false;
  std::string message_;
  std::chrono::steady_clock::time_point drawn_at_;
  std::vector<std::string> screenshots_;
};

}  // namespace kiln
