// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/viewer_window.h"

#include <fmt/format.h>
#include <utility>

#include "base/errors.h"
#include "base/files.h"
#include "base/interruption.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "view/state/readout.h"
#include "view/state/scene_state.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto message_time = std::chrono::seconds(6);
constexpr auto watch_interval = std::chrono::milliseconds(300);
constexpr double idle_seconds = 0.1;
constexpr auto reload_patience = std::chrono::seconds(300);

}  // namespace

ViewerWindow::ViewerWindow(ViewerWindowSetup setup)
    : window_("kiln-view: " + setup.name, setup.width, setup.height, setup.threads), setup_(std::move(setup)) {}

void ViewerWindow::run() {
  advanced_at_ = Clock::now();
  while (!window_.is_closing() && !is_closing_) {
    throw_if_interrupted();
    window_.wait(has_to_draw_ || is_playing() ? 0 : idle_seconds);
    const auto now = Clock::now();
    advance(std::chrono::duration<double>(now - advanced_at_).count());
    advanced_at_ = now;
    reload_if_changed();
    if (!message_.empty() && Clock::now() > message_until_) {
      message_.clear();
      has_to_draw_ = true;
    }
    if (has_to_draw_) draw();
  }
}

void ViewerWindow::run(const std::vector<ScriptStep>& script) {
  is_scripted_ = true;
  draw();
  for (const ScriptStep& step : script) {
    throw_if_interrupted();
    window_.wait(0);
    if (window_.is_closing() || is_closing_) return;
    do_step(step);
  }
}

void ViewerWindow::do_step(const ScriptStep& step) {
  using Kind = ScriptStep::Kind;
  switch (step.kind) {
    case Kind::key:
      press_key(step.key);
      break;
    case Kind::drag:
    case Kind::move:
      drag_step(step);
      break;
    case Kind::wheel:
      turn_wheel(step.x);
      break;
    case Kind::resize:
      window_.resize_and_wait(static_cast<int>(step.x), static_cast<int>(step.y));
      break;
    case Kind::frames:
      for (int k = 0; k < static_cast<int>(step.x); ++k) {
        advance(scene_frame_seconds);
        draw();
      }
      return;
    case Kind::screenshot:
    case Kind::window:
      write_picture_file(step.file, step.kind == Kind::window);
      return;
    case Kind::reload:
      wait_for_reload();
      break;
  }
  if (!is_closing_) draw();
}

void ViewerWindow::watch(std::vector<fs::path> folders) { watch_.emplace(std::move(folders)); }

void ViewerWindow::note(const std::string& message) {
  message_ = message;
  message_until_ = Clock::now() + message_time;
  has_to_draw_ = true;
}

void ViewerWindow::take_screenshot() {
  fs::path file;
  int number = 1;
  do file = fs::path(setup_.screenshots) / fmt::format("{}_{:03}.png", setup_.name, number++);
  while (fs::exists(file));
  try {
    write_picture_file(file, false);
    note("wrote " + fs::absolute(file).lexically_normal().string());
  } catch (const BadInput& error) {
    if (is_scripted_) throw;
    note(error.what());
  }
  setup_.say(message_);
}

void ViewerWindow::write_picture_file(const fs::path& file, bool with_panels) {
  if (has_to_draw_) draw();
  OutputSet outputs(folder_of(file));
  if (with_panels) screen_.show(all_panels(), window_.content_scale());
  write_png(outputs.add(file.filename().string()), with_panels ? screen_.window() : screen_.picture());
  outputs.commit();
  screenshots_.push_back(file.string());
}

bool ViewerWindow::reload_if_changed() {
  if (!watch_ || Clock::now() - looked_at_files_ < watch_interval) return false;
  looked_at_files_ = Clock::now();
  if (!watch_->changed()) return false;
  try {
    reload();
    fault_.clear();
    note("read again, as the files changed");
  } catch (const BadInput& error) {
    fault_ = error.what();
  } catch (const MachineLacks& error) {
    fault_ = error.what();
  }
  setup_.say(fault_.empty() ? message_ : "not read again: " + fault_);
  clock_.restart();
  has_to_draw_ = true;
  return true;
}

void ViewerWindow::wait_for_reload() {
  const auto begun = Clock::now();
  while (!reload_if_changed()) {
    throw_if_interrupted();
    if (Clock::now() - begun > reload_patience)
      throw BadInput(setup_.name, "did not change while the script waited", "changed files",
                     "leave out reload, or change them");
    window_.wait(idle_seconds);
  }
}

void ViewerWindow::fit_canvas(const Extent& size, int supersample) {
  if (canvas_ && canvas_->width() == size.width && canvas_->height() == size.height) return;
  canvas_.reset();  // first, so that both need not exist at once
  canvas_ = std::make_unique<Canvas>(size.width, size.height, supersample);
  clock_.restart();
}

void ViewerWindow::draw() {
  const Extent size = window_.framebuffer();
  has_to_draw_ = false;
  if (size.width == 0 || size.height == 0) return;
  draw_picture(size);
  screen_.show(all_panels(), window_.content_scale());
  window_.swap(!is_scripted_);
}

std::vector<PlacedPanel> ViewerWindow::all_panels() {
  std::vector<PlacedPanel> shown = panels();
  if (!fault_.empty())
    shown.push_back({message_panel(kept_heading(), fault_), PlacedPanel::Corner::lower_left});
  else if (!message_.empty())
    shown.push_back({message_panel("", message_), PlacedPanel::Corner::lower_left});
  return shown;
}

}  // namespace kiln
