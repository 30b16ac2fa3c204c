// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/options.h"
#include "lights/light_settings.h"
#include "render/lamps.h"
#include "render/render_settings.h"
#include "view/draw/asset_view.h"
#include "view/draw/screen.h"
#include "view/files/file_watch.h"
#include "view/frame_clock.h"
#include "view/state/keys.h"
#include "view/state/script.h"
#include "view/window/window.h"

namespace kiln {

/// Start settings of the viewer.
struct ViewerSetup {
  AssetFolders folders;
  LightSettings lights;
  LampSettings lamps;  ///< to choose among, by spectra
  RenderSettings look;
  std::string screenshots = ".";                ///< folder for screenshots
  std::filesystem::path shader;                 ///< the asset is drawn by it; empty: by a technique
  std::function<void(const std::string&)> say;  ///< called with lines for the terminal
};

/// Makes the options that concern the window alone.
OptionSet viewer_options(ViewerSetup& setup);

/// Makes the state that the settings describe. Throws WrongUsage for invalid settings, and if the asset cannot be drawn
/// so.
ViewState first_state(const ViewScene& scene, const LightSettings& lights, const RenderSettings& look);

/// A window with an asset in it.
class Viewer {
 public:
  /// Opens the window. Throws MachineLacks if that is impossible.
  Viewer(const ViewerSetup& setup, ViewScene scene, int software_threads);

  /// Runs until the person closes the window.
  void run();

  /// Runs a script step by step, then closes. Throws BadInput if a picture cannot be written.
  void run(const std::vector<ScriptStep>& script);

  /// Reports what was drawn by what, and how fast.
  Json metrics() const;

 private:
  void press_key(char key);
  void take_screenshot();
  void write_picture_file(const std::filesystem::path& file, bool with_panels);
  void do_step(const ScriptStep& step);
  bool reload_if_changed();
  void wait_for_reload();
  void draw();
  void draw_state(int width, int height);
  void note(const std::string& message);
  std::vector<PlacedPanel> panels();
  Camera camera(int width, int height) const;

  ViewerSetup setup_;
  Window window_;
  Screen screen_;
  ViewState home_, state_, drawn_;
  std::unique_ptr<AssetView> asset_;
  std::unique_ptr<Canvas> canvas_;
  FileWatch watch_;
  FrameClock clock_;
  bool has_to_draw_ = true;
  bool is_closing_ = false;
  bool is_scripted_ = false;
  std::string message_;  // on the screen until message_until_
  std::string fault_;    // of the last reload, until one succeeds
  std::chrono::steady_clock::time_point message_until_, looked_at_files_;
  std::vector<std::string> screenshots_;
};

}  // namespace kiln
