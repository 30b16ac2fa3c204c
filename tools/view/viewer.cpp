// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/viewer.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

#include "base/errors.h"
#include "base/extent.h"
#include "base/files.h"
#include "base/json.h"
#include "gpu/program.h"
#include "view/state/readout.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int frames_to_measure = 8;
// Width left for panels on both sides of an asset, which is about as wide as the window is high; at 96 dots per inch.
constexpr double room_for_panel_pixels = 440;

std::vector<fs::path> watched(const ViewerSetup& setup) {
  std::vector<fs::path> paths;
  for (const fs::path& folder : {setup.folders.plain, setup.folders.compressed})
    if (!folder.empty()) paths.push_back(folder);
  if (!setup.shader.empty()) paths.push_back(folder_of(setup.shader));
  return paths;
}

/// Tests whether frames of two states take comparable times.
bool same_kind(const ViewState& a, const ViewState& b) {
  return a.technique == b.technique && a.shading == b.shading && a.show == b.show && a.mesh == b.mesh &&
         a.light.preset == b.light.preset && a.bands == b.bands;
}

}  // namespace

void check_shader(const ViewerSetup& setup) {
  if (!setup.shader.empty() && are_spectral(setup.lights, setup.lamps))
    throw WrongUsage("shader: found one by lamps; expected it without lamps, since shaders are RGB");
}

OptionSet viewer_options(ViewerSetup& setup) {
  OptionSet options;
  options.text("screenshots", setup.screenshots, "The folder that screenshots go to");
  return options;
}

ViewState first_state(const ViewScene& scene, const LightSettings& lights, const RenderSettings& look) {
  if (!scene.lights.lamps.empty()) require_grey(look);
  if (look.technique == TechniqueChoice::all)
    throw WrongUsage("technique: found all; expected one, as kiln-view shows them one after another");
  const PrtAsset& main = scene.forms.main();
  ViewState state;
  state.technique = technique_of(look, main);
  require_technique(state.technique, scene.forms.of(state.technique));
  views_of(look, main.mesh.positions);  // throws if the look is invalid
  picture_of(look);
  state.orbit = home_orbit(camera_settings_of(look));
  state.shading = look.shading;
  state.light = given_choice(scene.lights, lights.window);
  state.bands = main.bands;
  state.exposure_stops = look.exposure_stops;
  return state;
}

Viewer::Viewer(const ViewerSetup& setup, ViewScene scene, int software_threads)
    : ViewerWindow(
          {setup.folders.name, setup.look.width, setup.look.height, setup.screenshots, setup.say, software_threads}),
      setup_(setup),
      home_(first_state(scene, setup.lights, setup.look)),
      state_(home_),
      asset_(std::make_unique<AssetView>(std::move(scene), setup.look, state_)) {
  watch(watched(setup));
  if (!setup.shader.empty()) asset_->set_shader(setup.shader);
  window_.listen({[this](char key) { press_key(key); },
                  [this](Drag what, double right, double down) { drag_by(what, right, down); },
                  [this](double steps) { turn_wheel(steps); }, [this] { has_to_draw_ = true; }});
}

void Viewer::drag_by(Drag what, double right, double down) {
  const Extent size = window_.framebuffer();
  drag(state_, what, right, down, asset_->shape(), std::max(1, size.width), std::max(1, size.height));
  has_to_draw_ = true;
}

void Viewer::drag_step(const ScriptStep& step) { drag_by(step.what, step.x, step.y); }

void Viewer::turn_wheel(double steps) {
  zoom_orbit(state_.orbit, steps);
  has_to_draw_ = true;
}

void Viewer::press_key(char key) {
  const KeyResult result = press(state_, asset_->limits(), home_, key);
  has_to_draw_ = true;
  message_.clear();
  if (!result.message.empty()) note(result.message);
  if (result.wish == Wish::close) is_closing_ = true;
  if (result.wish == Wish::screenshot) take_screenshot();
}

void Viewer::reload() {
  ViewScene scene = load_view_scene(setup_.folders, setup_.lights, setup_.lamps);
  const bool had_all_bands = state_.bands == asset_->limits().bands;
  auto asset = std::make_unique<AssetView>(std::move(scene), setup_.look, state_);
  if (!setup_.shader.empty()) asset->set_shader(setup_.shader);
  asset_ = std::move(asset);
  home_.bands = asset_->limits().bands;
  if (had_all_bands) state_.bands = home_.bands;
  limit(state_, asset_->limits());
  limit(home_, asset_->limits());
}

Camera Viewer::camera(int width, int height) const { return camera_of(state_.orbit, asset_->shape(), width, height); }

void Viewer::draw_picture(const Extent& size) {
  try {
    draw_state(size);
  } catch (const BadInput& error) {  // a file that is read only when needed is damaged
    if (state_.technique == home_.technique && state_.show == Show::picture && !state_.mesh) throw;
    state_.technique = home_.technique;
    state_.show = Show::picture;
    state_.mesh = false;
    note(error.what());
    draw_state(size);
    has_to_draw_ = false;
  }
  // Draws a few more frames, so that there is a time to show.
  if (!is_scripted_ && clock_.measured() < frames_to_measure) has_to_draw_ = true;
}

void Viewer::draw_state(const Extent& size) {
  fit_canvas(size, setup_.look.supersample);
  if (!same_kind(state_, drawn_)) clock_.restart();
  drawn_ = state_;
  clock_.begin();
  asset_->draw(state_, camera(size.width, size.height), *canvas_);
  Resolve how;
  how.show = state_.show;
  how.edges = state_.mesh;
  how.picture = picture_of(setup_.look);
  how.picture.exposure_stops = state_.exposure_stops;
  if (state_.show == Show::difference) {
    how.gain = static_cast<float>(state_.difference_gain);
    how.weights = {0.2126f, 0.7152f, 0.0722f};  // luminance of Rec. 709's primaries
  } else if (state_.show == Show::coefficient) {
    const auto [lowest, highest] = asset_->coefficient_range(state_.coefficient, state_.technique);
    how.gain = static_cast<float>(1 / std::max({std::abs(lowest), std::abs(highest), 1e-30}));
    // Two of three channels are dark: only one is shown.
    how.weights.fill(asset_->limits().channels == 1 ? 1.f / 3 : 1.f);
  }
  screen_.resolve(*canvas_, how);
  glFinish();
  clock_.end();
}

std::vector<PlacedPanel> Viewer::panels() {
  using Corner = PlacedPanel::Corner;
  std::vector<PlacedPanel> panels;
  const double scale = window_.content_scale();
  const Extent window = window_.framebuffer();
  const bool is_narrow = window.width - window.height < room_for_panel_pixels * scale;
  if (state_.readout && !(state_.help && is_narrow)) {
    const std::string by = setup_.shader.empty() ? "" : ", by " + setup_.shader.filename().string();
    ViewFacts facts{setup_.folders.name + by, clock_.steady_milliseconds(), asset_->gpu_bytes(state_), 0, 0};
    if (state_.show == Show::coefficient)
      std::tie(facts.coefficient_lowest, facts.coefficient_highest) =
          asset_->coefficient_range(state_.coefficient, state_.technique);
    Panel panel =
        readout(state_, asset_->limits(), asset_->scene().forms.of(state_.technique), asset_->scene().lights, facts);
    if (is_narrow) panel = strip_of(panel, window.width - 2 * panel_margin(scale), scale);
    panels.push_back({std::move(panel), Corner::upper_left});
  }
  if (state_.help) panels.push_back({help_panel(), Corner::upper_right});
  return panels;
}

Json Viewer::metrics() const {
  const Extent size = window_.framebuffer();
  return {{"renderer", window_.renderer()}, {"width", size.width},
          {"height", size.height},          {"technique", technique_name(state_.technique)},
          {"frames", clock_.frames()},      {"frame_milliseconds", clock_.mean_milliseconds()},
          {"screenshots", screenshots_}};
}

}  // namespace kiln
