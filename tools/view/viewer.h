// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "base/options.h"
#include "lights/light_settings.h"
#include "render/lamps.h"
#include "render/render_settings.h"
#include "view/draw/asset_view.h"
#include "view/state/keys.h"
#include "view/viewer_window.h"

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

/// Throws WrongUsage for a shader beside lamps: shaders are RGB.
void check_shader(const ViewerSetup& setup);

/// Makes the state that the settings describe. Throws WrongUsage for invalid settings, and if the asset cannot be drawn
/// so.
ViewState first_state(const ViewScene& scene, const LightSettings& lights, const RenderSettings& look);

/// A window with an asset in it.
class Viewer : public ViewerWindow {
 public:
  /// Opens the window. Throws MachineLacks if that is impossible.
  Viewer(const ViewerSetup& setup, ViewScene scene, int software_threads);

  /// Reports what was drawn by what, and how fast.
  Json metrics() const;

 private:
  void press_key(char key) override;
  void turn_wheel(double steps) override;
  void drag_step(const ScriptStep& step) override;
  void draw_picture(const Extent& size) override;
  std::vector<PlacedPanel> panels() override;
  void reload() override;
  const char* kept_heading() const override { return "Not read again; this is the asset as it was"; }
  void drag_by(Drag what, double right, double down);
  void draw_state(const Extent& size);
  Camera camera(int width, int height) const;

  ViewerSetup setup_;
  ViewState home_, state_, drawn_;
  std::unique_ptr<AssetView> asset_;
};

}  // namespace kiln
