// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/scene_viewer.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/files.h"
#include "base/interruption.h"
#include "base/json.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "view/state/readout.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr double pause_seconds = 0.1;  // while nothing happens

// Width beside a square that panels on both sides need; at 96 dots per inch.
constexpr double room_for_both_panels = 440;

std::string method_name(const FilmSettings& film) {
  const std::string name(shadow_method_names[static_cast<std::size_t>(film.shadows)]);
  return film.shadow_backend == ShadowBackend::gpu ? name + ", by maps" : name;
}

std::string samples_text(int samples) {
  if (samples == samples_at_vertices) return "every vertex";
  return fmt::format("{} point{} an asset", samples, samples == 1 ? "" : "s");
}

}  // namespace

SceneViewer::SceneViewer(const SceneViewerSetup& setup, const Film& film)
    : setup_(setup),
      window_("kiln-view: " + setup.name, setup.look.width, setup.look.height, setup.threads),
      scene_(film.description, film.asset_pointers(),
             {shadow_settings_of(setup.film, setup.threads), film_samples_of(setup.look, setup.film, film.description),
              shadow_engine_of(setup.film)}),
      samples_(film_samples_of(setup.look, setup.film, film.description)),
      assets_(scene_, setup.look, samples_),
      duration_(duration_of(film.description)) {
  home_.orbit = home_orbit(camera_settings_at(film_camera(scene_, setup.look), film.description, setup.film.time));
  home_.time = setup.film.time;
  home_.exposure_stops = setup.look.exposure_stops;
  state_ = home_;
  window_.listen({[this](char key) { press_key(key); },
                  [this](Drag what, double right, double down) { drag(what, right, down); },
                  [this](double steps) {
                    zoom_orbit(state_.orbit, steps);
                    has_to_draw_ = true;
                  },
                  [this] { has_to_draw_ = true; }, [this](double right, double down) { hold(right, down); }});
}

void SceneViewer::run() {
  drawn_at_ = Clock::now();
  while (!window_.is_closing() && !is_closing_) {
    throw_if_interrupted();
    window_.wait(has_to_draw_ || state_.plays ? 0 : pause_seconds);
    const auto now = Clock::now();
    if (state_.plays) {
      state_.time = looped(state_.time + std::chrono::duration<double>(now - drawn_at_).count(), duration_);
      has_to_draw_ = true;
    }
    drawn_at_ = now;
    if (has_to_draw_) draw();
  }
}

void SceneViewer::run(const std::vector<ScriptStep>& script) {
  is_scripted_ = true;
  draw();
  for (const ScriptStep& step : script) {
    throw_if_interrupted();
    window_.wait(0);
    if (window_.is_closing() || is_closing_) return;
    do_step(step);
  }
}

void SceneViewer::do_step(const ScriptStep& step) {
  using Kind = ScriptStep::Kind;
  switch (step.kind) {
    case Kind::key:
      press_key(step.key);
      break;
    case Kind::drag:
      state_.held = -1;
      drag(step.what, step.x, step.y);
      break;
    case Kind::move:
      hold(step.from_x, step.from_y);
      drag(Drag::orbit, step.x, step.y);
      break;
    case Kind::wheel:
      zoom_orbit(state_.orbit, step.x);
      break;
    case Kind::resize:
      window_.resize_and_wait(static_cast<int>(step.x), static_cast<int>(step.y));
      break;
    case Kind::frames:
      for (int k = 0; k < static_cast<int>(step.x); ++k) {
        if (state_.plays) state_.time = looped(state_.time + scene_frame_seconds, duration_);
        draw();
      }
      return;
    case Kind::screenshot:
    case Kind::window:
      write_picture_file(step.file, step.kind == Kind::window);
      return;
    case Kind::reload:
      break;  // no word of a scene's scripts
  }
  if (!is_closing_) draw();
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

void SceneViewer::take_screenshot() {
  fs::path file;
  int number = 1;
  do file = fs::path(setup_.screenshots) / fmt::format("{}_{:03}.png", setup_.name, number++);
  while (fs::exists(file));
  try {
    write_picture_file(file, false);
    message_ = "wrote " + fs::absolute(file).lexically_normal().string();
  } catch (const BadInput& error) {
    if (is_scripted_) throw;
    message_ = error.what();
  }
  setup_.say(message_);
}

void SceneViewer::write_picture_file(const fs::path& file, bool with_panels) {
  if (has_to_draw_) draw();
  OutputSet outputs(folder_of(file));
  if (with_panels) screen_.show(panels(), window_.content_scale());
  write_png(outputs.add(file.filename().string()), with_panels ? screen_.window() : screen_.picture());
  outputs.commit();
  screenshots_.push_back(file.string());
}

Camera SceneViewer::camera() {
  const Extent size = window_.framebuffer();
  return camera_of(state_.orbit, shape_now(scene_), size.width, size.height);
}

void SceneViewer::draw() {
  const Extent size = window_.framebuffer();
  has_to_draw_ = false;
  if (size.width == 0 || size.height == 0) return;
  if (!canvas_ || canvas_->width() != size.width || canvas_->height() != size.height) {
    canvas_.reset();  // first, so that both need not exist at once
    canvas_ = std::make_unique<Canvas>(size.width, size.height, setup_.look.supersample);
    clock_.restart();
  }
  clock_.begin();
  scene_.set_time(state_.time);
  light_clock_.begin();
  const std::vector<SceneAsset> drawn = assets_.now(look_of(setup_.look));
  light_clock_.end();
  const Camera from = camera();
  draw_scene(drawn, from.clip_from_object().cast<double>(), from.position.cast<double>(), canvas_->picture(),
             setup_.look.shading == Shading::deferred ? &canvas_->appearance() : nullptr);
  Resolve how;
  how.picture = picture_of(setup_.look);
  how.picture.exposure_stops = state_.exposure_stops;
  screen_.resolve(*canvas_, how);
  glFinish();
  clock_.end();
  screen_.show(panels(), window_.content_scale());
  window_.swap(!is_scripted_);
}

std::vector<PlacedPanel> SceneViewer::panels() {
  using Corner = PlacedPanel::Corner;
  std::vector<PlacedPanel> panels;
  const Extent window = window_.framebuffer();
  const bool is_narrow = window.width - window.height < room_for_both_panels * window_.content_scale();
  if (state_.readout && !(state_.help && is_narrow)) {
    const auto nodes = std::count_if(scene_.description().items.begin(), scene_.description().items.end(),
                                     [](const SceneItem& item) { return item.asset >= 0; });
    panels.push_back({scene_readout(state_, {setup_.name, duration_, static_cast<int>(nodes), method_name(setup_.film),
                                             samples_text(samples_), clock_.steady_milliseconds(),
                                             light_clock_.steady_milliseconds()}),
                      Corner::upper_left});
  }
  if (state_.help) panels.push_back({scene_help_panel(), Corner::upper_right});
  if (!message_.empty()) panels.push_back({message_panel("", message_), Corner::lower_left});
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
          {"shadows", shadow_record(setup_.film, scene_.shadow_engine())},
          {"screenshots", screenshots_}};
}

}  // namespace kiln
