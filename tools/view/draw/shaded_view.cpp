// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/draw/shaded_view.h"

namespace kiln {

namespace {

ShadedScene scene_of(const PrtAsset& asset, const std::string& shader) {
  ShadedScene scene;
  scene.meshes = {{&asset.mesh, &asset, has_shadable_planes(asset)}};
  scene.materials = {{shader}};
  scene.nodes = {{}};
  return scene;
}

}  // namespace

ShadedView::ShadedView(const PrtAsset& asset, const std::filesystem::path& shader)
    : renderer_(scene_of(asset, shader.stem().string()), {read_shader(shader)}, {.samples = 1}) {}

void ShadedView::draw(const SceneLights& lights, const Camera& camera, const Frame& frame, double seconds) {
  if (!frame_ || frame_->width() != frame.width() || frame_->height() != frame.height()) {
    frame_.reset();  // first, so that both need not exist at once
    frame_.emplace(renderer_.make_frame(frame.width(), frame.height()));
  }
  renderer_.set_lights(lights);
  renderer_.draw(camera, *frame_, seconds, drawn_++);
  glCopyImageSubData(frame_->picture().name(), GL_TEXTURE_2D, 0, 0, 0, 0, frame.color().name(), GL_TEXTURE_2D, 0, 0, 0,
                     0, frame.width(), frame.height(), 1);
}

}  // namespace kiln
