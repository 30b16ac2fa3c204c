// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/film/film.h"
#include "view/state/scene_state.h"
#include "view/viewer_window.h"

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

/// A window in which a scene plays; in scripts by a thirtieth of a second for each frame that they draw.
class SceneViewer : public ViewerWindow {
 public:
  /// Opens the window; `film` must live on. Throws MachineLacks if that is impossible, and as FilmAssets does.
  SceneViewer(const SceneViewerSetup& setup, const Film& film);

  /// Reports what was drawn by what, and how fast.
  Json metrics() const;

 private:
  void press_key(char key) override;
  void turn_wheel(double steps) override;
  void drag_step(const ScriptStep& step) override;
  void draw_picture(const Extent& size) override;
  std::vector<PlacedPanel> panels() override;
  void advance(double seconds) override;
  bool is_playing() const override { return state_.plays; }
  void hold(double right, double down);
  void drag(Drag what, double right, double down);
  Camera camera();

  SceneViewerSetup setup_;
  MovingScene scene_;
  int samples_;
  FilmAssets assets_;
  SceneState home_, state_;
  double duration_;
  FrameClock light_clock_;
};

}  // namespace kiln
