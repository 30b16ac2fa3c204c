// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/render_settings.h"
#include "view/draw/scene_drawing.h"
#include "view/state/scene_state.h"
#include "view/viewer_window.h"

namespace kiln {

/// Start settings of a scene in a window.
struct SceneViewerSetup {
  std::string name;  ///< title of the window, and of screenshots
  RenderSettings look;
  double time = 0;                                              ///< seconds
  std::string screenshots = ".";                                ///< folder for screenshots
  std::function<void(const std::string&)> say;                  ///< called with lines for the terminal
  int threads = 0;                                              ///< 0: all
  std::function<std::unique_ptr<SceneDrawing>()> make_drawing;  ///< called once there is a GL context
};

/// A window in which a scene plays; in scripts by a thirtieth of a second for each frame that they draw.
class SceneViewer : public ViewerWindow {
 public:
  /// Opens the window. Throws MachineLacks if that is impossible, and as make_drawing does.
  explicit SceneViewer(const SceneViewerSetup& setup);

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
  void reload() override { drawing_->reload(); }
  const char* kept_heading() const override { return "Not read again; these are the shaders as they were"; }
  void hold(double right, double down);
  void drag(Drag what, double right, double down);
  Camera camera();

  SceneViewerSetup setup_;
  std::unique_ptr<SceneDrawing> drawing_;
  MovingScene& scene_;
  SceneState home_, state_;
  double duration_;
  FrameClock light_clock_;
};

}  // namespace kiln
