// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/scene_viewer.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/json.h"

namespace kiln {

namespace {

// Width beside a square that panels on both sides need; at 96 dots per inch.
constexpr double room_for_both_panels = 440;

std::string samples_text(int samples) {
  if (samples == samples_at_vertices) return "every vertex";
  return fmt::format("{} point{} an asset", samples, samples == 1 ? "" : "s");
}

}  // namespace

SceneViewer::SceneViewer(const SceneViewerSetup& setup)
    : ViewerWindow({setup.name, setup.look.width, setup.look.height, setup.screenshots, setup.say, setup.threads}),
      setup_(setup),
      drawing_(setup.make_drawing()),
      scene_(drawing_->moving()),
      duration_(duration_of(scene_.description())) {
  if (!drawing_->watched().empty()) watch(drawing_->watched());
  home_.orbit = home_orbit(camera_settings_at(film_camera(scene_, setup.look), scene_.description(), setup.time));
  home_.time = setup.time;
  home_.exposure_stops = setup.look.exposure_stops;
  state_ = home_;
  window_.listen({[this](char key) { press_key(key); },
                  [this](Drag what, double right, double down) { drag(what, right, down); },
                  [this](double steps) { turn_wheel(steps); }, [this] { has_to_draw_ = true; },
                  [this](double right, double down) { hold(right, down); }});
}

void SceneViewer::advance(double seconds) {
  if (!state_.plays) return;
  state_.time = looped(state_.time + seconds, duration_);
  has_to_draw_ = true;
}

void SceneViewer::turn_wheel(double steps) {
  zoom_orbit(state_.orbit, steps);
  has_to_draw_ = true;
}

void SceneViewer::drag_step(const ScriptStep& step) {
  const bool moves = step.kind == ScriptStep::Kind::move;
  state_.held = -1;
  if (moves) hold(step.from_x, step.from_y);
  drag(moves ? Drag::orbit : step.what, step.x, step.y);
}

void SceneViewer::press_key(char key) {
  message_.clear();
  if (key == 'r') scene_.put_back();
  const Wish wish = press_scene_key(state_, home_, duration_, key);
  has_to_draw_ = true;
  if (wish == Wish::close) is_closing_ = true;
  if (wish == Wish::screenshot) take_screenshot();
}

void SceneViewer::hold(double right, double down) {
  const Extent size = window_.framebuffer();
  if (size.width == 0 || size.height == 0) return;
  scene_.set_time(state_.time);
  const int item = item_at(scene_, camera(), right, down, size.width, size.height);
  state_.held = can_be_dragged(scene_, item) ? item : -1;
}

void SceneViewer::drag(Drag what, double right, double down) {
  const Extent size = window_.framebuffer();
  if (size.width == 0 || size.height == 0) return;
  if (what == Drag::orbit && state_.held >= 0)
    drag_item(scene_, state_.held, camera(), right, down, size.height);
  else if (what == Drag::orbit)
    turn_orbit(state_.orbit, right, down);
  else if (what == Drag::pan)
    pan_orbit(state_.orbit, shape_now(scene_), right, down, size.width, size.height);
  has_to_draw_ = true;
}

Camera SceneViewer::camera() {
  const Extent size = window_.framebuffer();
  return camera_of(state_.orbit, shape_now(scene_), size.width, size.height);
}

void SceneViewer::draw_picture(const Extent& size) {
  fit_canvas(size, drawing_->supersample());
  clock_.begin();
  scene_.set_time(state_.time);
  light_clock_.begin();
  drawing_->light();
  light_clock_.end();
  drawing_->draw(camera(), *canvas_);
  Resolve how;
  how.picture = picture_of(setup_.look);
  how.picture.exposure_stops = state_.exposure_stops;
  screen_.resolve(*canvas_, how);
  glFinish();
  clock_.end();
}

std::vector<PlacedPanel> SceneViewer::panels() {
  using Corner = PlacedPanel::Corner;
  std::vector<PlacedPanel> panels;
  const Extent window = window_.framebuffer();
  const bool is_narrow = window.width - window.height < room_for_both_panels * window_.content_scale();
  if (state_.readout && !(state_.help && is_narrow)) {
    const auto nodes = std::count_if(scene_.description().items.begin(), scene_.description().items.end(),
                                     [](const SceneItem& item) { return !item.is_composite(); });
    panels.push_back({scene_readout(state_, {setup_.name, duration_, static_cast<int>(nodes), drawing_->shadows(),
                                             samples_text(drawing_->incident_samples()), clock_.steady_milliseconds(),
                                             light_clock_.steady_milliseconds()}),
                      Corner::upper_left});
  }
  if (state_.help) panels.push_back({scene_help_panel(), Corner::upper_right});
  return panels;
}

Json SceneViewer::metrics() const {
  const Extent size = window_.framebuffer();
  return {{"renderer", window_.renderer()},
          {"width", size.width},
          {"height", size.height},
          {"time", state_.time},
          {"frames", clock_.frames()},
          {"frame_milliseconds", clock_.mean_milliseconds()},
          {"light_milliseconds", light_clock_.mean_milliseconds()},
          {"shadows", drawing_->shadow_record()},
          {"screenshots", screenshots_}};
}

}  // namespace kiln
